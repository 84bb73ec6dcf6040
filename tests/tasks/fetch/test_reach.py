"""Whether a thing can be gripped: margins by what is not known, and refusals by name."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tapreach.estimation.footprint import SeenWidth
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.fetch.arm_workspace import MARGIN, Unreachable
from tapreach.tasks.fetch.claw_room import LIFT, SPARE, Claw
from tapreach.tasks.fetch.kept_size import SizeDoubt
from tapreach.tasks.fetch.reach import CLAW_SPARE, DENIED, LEAST_ROOM, Verdict, grip_for, judge
from tapreach.tasks.fetch.thing import NoSize
from tasks.fetch.worlds import BODY, ROBOT, size_at

CLAW = BODY.claw


def fits(ahead: float, height: float, opening: float, rotation: float) -> bool:
    """As the claw has it, but for rounding: the clearance is the same over long ways."""
    pose, lifted = (
        CLAW.arm.pose_at(CLAW.tip(ahead, each, rotation), opening) for each in (height, height + LIFT)
    )
    if isinstance(pose, Unreachable) or isinstance(lifted, Unreachable):
        return False
    return CLAW.arm.clearance(pose).distance >= MARGIN + SPARE - 1e-9


@pytest.mark.parametrize(
    ("size", "verdict", "reason", "advice"),
    [
        ({"width": 0.101, "width_sd": 0.001}, "no", "28 mm too wide for the claw: it is 101 mm wide", ""),
        ({"width": 0.105, "width_sd": 0.006}, "no", "32 mm too wide for the claw: it is 105 mm wide", ""),
        ({"width": 0.102, "width_sd": 0.006}, "no", "29 mm too wide for the claw: it is 102 mm", ""),
        ({"width": 0.25, "width_sd": 0.12}, "no", "177 mm too wide for the claw: it is 250 mm wide", ""),
        ({"width": 0.085}, "unsure", "12 mm too wide for the claw as seen from here", "from another side"),
        (
            {"width": 0.06, "width_sd": 0.007},
            "unsure",
            "may be too wide: 60 mm ± 14 mm",
            "known to ±14 mm only",
        ),
        ({"width": 0.07, "width_sd": 0.0005}, "unsure", "fits the claw barely", ""),
        ({"foot": 0.4}, "no", "too high: the claw reaches 2", "bring it lower"),
        ({"foot": 0.3, "height_sd": 0.03}, "unsure", "may be too high", "known to ±60 mm only"),
        ({"foot": 0.1}, "unsure", "hangs, or stands on something", "on the floor"),
        ({"height": 0.008, "height_sd": 0.001}, "no", "too flat: its top is 8 mm above the floor", ""),
        ({"height": 0.015, "height_sd": 0.004}, "unsure", "may be too flat", "±8 mm only"),
        ({}, "yes", "gripped 50 mm above the floor", ""),
    ],
)
def test_what_can_be_gripped_is_told_by_name(size, verdict, reason, advice):
    judged = judge(size_at(1.0, 0.0, **size), CLAW)
    assert judged.verdict == verdict
    assert reason in judged.reason
    assert advice in judged.advice


@settings(max_examples=60, deadline=None)
@given(st.floats(0.02, 0.12), st.floats(0.0, 0.02), st.floats(0.03, 0.25))
def test_yes_only_with_two_sigmas_to_spare(width, width_sd, height):
    judged = judge(size_at(1.0, 0.0, width=width, width_sd=width_sd, height=height), CLAW)
    if judged.verdict is Verdict.YES:
        assert width + 2.0 * width_sd <= CLAW.opens_to - CLAW_SPARE + 1e-12
    if judged.verdict is Verdict.NO:
        assert width - 2.0 * width_sd > CLAW.opens_to


@settings(max_examples=40, deadline=None)
@given(st.floats(0.02, 0.068), st.floats(0.0, 0.02), st.floats(0.0, 0.02))
def test_knowing_the_width_better_never_makes_a_yes_a_doubt(width, more, less):
    rough = judge(size_at(1.0, 0.0, width=width, width_sd=more + less), CLAW)
    fine = judge(size_at(1.0, 0.0, width=width, width_sd=less), CLAW)
    assert not (rough.verdict is Verdict.YES and fine.verdict is not Verdict.YES)


@settings(max_examples=40, deadline=None)
@given(st.floats(0.02, 0.068), st.floats(0.03, 0.3), st.sampled_from((0.0, 0.2, -0.2, -0.4)))
def test_arm_reaches_the_grip_and_what_it_has_to_spare(width, height, rotation):
    grip = grip_for(size_at(1.0, 0.0, width=width, height=height), CLAW, rotation)
    if grip is None:
        return
    assert grip.spare >= LEAST_ROOM
    assert width < grip.opening <= CLAW.opens_to
    assert CLAW.lowest <= grip.height <= max(CLAW.lowest, height)
    assert grip.pre_grasp + CLAW.beyond + grip.half_depth < grip.ahead - grip.spare + grip.spare + 1e-9
    for ahead in (grip.pre_grasp - 0.9 * grip.spare, grip.ahead, grip.ahead + 0.9 * grip.spare):
        assert fits(ahead, round(grip.height, 3), round(grip.opening, 3), rotation)


def test_last_look_decides_by_the_width_itself():
    doubtful = size_at(1.0, 0.0, width=0.07, width_sd=0.004)
    assert judge(doubtful, CLAW).verdict is Verdict.UNSURE
    assert judge(doubtful, CLAW, is_last_look=True).verdict is Verdict.YES
    too_wide = size_at(1.0, 0.0, width=0.1, width_sd=0.004)
    assert judge(too_wide, CLAW, is_last_look=True).verdict is Verdict.NO


def test_what_may_fit_is_tried_at_the_last_look_where_no_other_side_is_sought():
    barely, hardly = (size_at(1.0, 0.0, width=width, width_sd=0.004) for width in (0.075, 0.09))
    tried, refused = (judge(each, CLAW, True, seeks_another_side=False) for each in (barely, hardly))
    assert tried.verdict is Verdict.YES and "may be too wide" in tried.reason
    assert refused.verdict is Verdict.NO
    at_least_so_wide = size_at(1.0, 0.0, width=0.16, width_sd=0.08)
    assert judge(at_least_so_wide, CLAW, True, seeks_another_side=False).verdict is Verdict.NO


@settings(max_examples=40, deadline=None)
@given(st.floats(0.02, 0.3), st.floats(0.0, 0.03), st.floats(0.0, 0.5), st.booleans())
def test_what_has_no_upper_end_is_never_gripped(width, width_sd, foot, is_last_look):
    size = size_at(1.0, 0.0, width=width, width_sd=width_sd, height=0.34, foot=foot)
    ends, goes_on = (judge(replace(size, goes_on_above=each), CLAW, is_last_look) for each in (False, True))
    assert goes_on.verdict is Verdict.NO
    assert ends.reason == goes_on.reason if ends.verdict is Verdict.NO else "on a wall" in goes_on.reason


def test_room_ends_where_the_arm_ends():
    room = CLAW.room(0.05, 0.06)
    assert room is not None
    assert CLAW.fits(room.nearest, 0.05, 0.06, 0.0)
    assert CLAW.fits(room.farthest, 0.05, 0.06, 0.0)
    assert not CLAW.fits(room.nearest - 0.001, 0.05, 0.06, 0.0)
    assert not CLAW.fits(room.farthest + 0.001, 0.05, 0.06, 0.0)


def test_room_has_no_holes():
    room = CLAW.room(0.1, 0.055)
    assert room is not None
    assert all(fits(float(way), 0.1, 0.055, 0.0) for way in np.arange(room.nearest, room.farthest, 1e-3))


def test_no_room_above_what_the_arm_reaches():
    assert CLAW.room(0.6, 0.06) is None
    assert Claw.of(ROBOT) == CLAW


def test_what_is_surely_too_wide_by_the_newest_look_is_not_tried_for_an_older_one() -> None:
    looks = (SeenWidth(0.0, 0.023, 0.002), SeenWidth(0.1, 0.11, 0.009))
    wide = replace(size_at(0.5, 0.0, 0.11, width_sd=0.009), seen=looks, seen_along=0.1)
    found = judge(wide, CLAW, is_last_look=True, seeks_another_side=False)
    assert found.verdict is Verdict.NO and "too wide" in found.reason
    assert judge(replace(wide, width=0.08), CLAW, True, False).verdict is Verdict.YES


def test_what_was_measured_once_and_has_no_sides_since_is_part_of_something_larger() -> None:
    once, twice = (replace(size_at(0.5, 0.0, 0.05), told=told, denied=DENIED) for told in (1, 2))
    found = judge(once, CLAW, is_last_look=True)
    assert found.verdict is Verdict.NO and "part of something larger" in found.reason
    for size, is_last_look in ((once, False), (twice, True), (replace(once, denied=DENIED - 1), True)):
        assert judge(size, CLAW, is_last_look).verdict is Verdict.YES


def test_no_sides_count_once_for_each_place_and_until_it_is_measured_again() -> None:
    cup, doubt = replace(size_at(0.5, 0.0), seen_along=0.0), SizeDoubt()
    flat = NoSize("it lies flat on what is behind it", denies_sides=True)
    for x, count in ((0.0, 1), (0.01, 1), (0.2, 2), (0.4, 3)):
        assert doubt.believed(flat, cup, PlanarPose(x), 0.0) is None
        assert doubt.denied == count
    doubt.believed(NoSize("only 2 pictures of it"), cup, PlanarPose(0.6), 0.0)
    assert doubt.denied == 3
    doubt.believed(cup, cup, PlanarPose(0.8), 0.0)
    assert doubt.denied == 0
