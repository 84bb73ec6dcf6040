"""The preview: verdict, reason, what would help, and what is to be drawn."""

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest

from tapreach.errors import InputError
from tapreach.estimation.footprint import SeenWidth
from tapreach.geometry.planar_motion import PlanarPose, wrapped
from tapreach.tasks.fetch.believed_size import supposed_size
from tapreach.tasks.fetch.obstacle import Obstacle
from tapreach.tasks.fetch.preview import OTHER_SIDES, preview
from tapreach.tasks.fetch.reach import Verdict
from tapreach.tasks.fetch.stand import ROTATIONS
from tapreach.tasks.fetch.thing import NoSize, Thing, ThingSize
from tasks.fetch.worlds import ROBOT, obstacle_at, thing_at

HERE = PlanarPose(0.4, -0.3, 0.7)


def ahead(distance: float, left: float = 0.0, **size: float) -> Thing:
    there = HERE.compose(PlanarPose(distance, left))
    return thing_at(there.x, there.y, **size)


def test_thing_that_can_be_fetched_is_shown_with_its_way_and_grasp():
    thing = ahead(1.5, 0.2)
    found = preview(thing, [], HERE, ROBOT)
    assert found.verdict is Verdict.YES
    assert found.path[0] == HERE
    assert 5.0 < found.driving_seconds < 20.0
    assert found.grasp is not None
    assert isinstance(thing.size, ThingSize)
    np.testing.assert_allclose(found.grasp.tip[:2], thing.size.axis_in_world[:2], atol=1e-9)
    assert "its weight is not known" in found.reason


def test_fingers_stand_on_both_sides_of_the_thing():
    thing = ahead(1.2, width=0.04)
    grasp = preview(thing, [], HERE, ROBOT).grasp
    assert grasp is not None
    left, right = grasp.fingers
    np.testing.assert_allclose(np.linalg.norm(left - right, axis=1), grasp.opening)
    np.testing.assert_allclose((left + right).mean(axis=0) / 2.0, grasp.tip, atol=1e-9)
    pointing = left[1] - left[0]
    np.testing.assert_allclose(np.cross(pointing, grasp.tip - grasp.tip_before), 0.0, atol=1e-9)
    assert np.dot(pointing, grasp.tip - grasp.tip_before) > 0.0


@pytest.mark.parametrize(
    ("size", "reason"),
    [
        ({"width": 0.2}, "127 mm too wide for the claw"),
        ({"foot": 0.9}, "too high: the claw reaches"),
        ({"height": 0.005, "height_sd": 0.001}, "too flat"),
    ],
)
def test_what_cannot_be_gripped_has_no_way(size, reason):
    found = preview(ahead(1.5, **size), [], HERE, ROBOT)
    assert found.verdict is Verdict.NO
    assert reason in found.reason
    assert found.path == ()
    assert found.driving_seconds == 0.0


def test_thing_that_is_hemmed_in_is_refused_with_what_hems_it_in():
    ring = [
        HERE.compose(PlanarPose(1.5 + 0.3 * math.cos(a), 0.3 * math.sin(a))) for a in np.arange(8) * 0.785
    ]
    boxes = [obstacle_at(f"box {i}", pose.x, pose.y, 0.1) for i, pose in enumerate(ring)]
    found = preview(ahead(1.5), boxes, HERE, ROBOT)
    assert found.verdict is Verdict.NO
    assert "stands behind box" in found.reason


def test_thing_too_wide_over_its_corner_is_looked_at_from_another_side():
    found = preview(ahead(1.5, width=0.085), [], HERE, ROBOT)
    assert found.verdict is Verdict.UNSURE
    assert "from another side" in found.advice
    assert found.approach is not None
    assert abs(found.approach.side) >= math.radians(30.0)


def test_thing_that_no_other_side_makes_likelier_to_fit_is_tried_from_here_if_it_may_fit():
    """Seen from everywhere a round thing is as wide as from here."""
    barely, too_wide = (seen_from_all_sides(width) for width in (0.075, 0.09))
    found = preview(barely, [], HERE, ROBOT, is_last_look=True)
    assert found.verdict is Verdict.YES and not found.from_another_side
    refused = preview(too_wide, [], HERE, ROBOT, is_last_look=True)
    assert refused.verdict is Verdict.NO and "too wide" in refused.reason


def seen_from_all_sides(width):
    thing = ahead(1.0, width=width, width_sd=0.004)
    looks = tuple(SeenWidth(HERE.heading + aside, width, 0.004) for aside in np.arange(0.0, math.pi, 0.5))
    return replace(thing, size=replace(thing.size, seen=looks))


def test_box_seen_from_two_sides_is_gripped_across_its_narrow_one():
    """Too wide over its corner, and narrow from 40° to the left: that side is driven to, not the other."""
    corner, side = HERE.heading, HERE.heading - math.radians(40.0)
    looks = (SeenWidth(corner, 0.08, 0.003), SeenWidth(side, 0.055, 0.003))
    thing = ahead(1.5, width=0.08, width_sd=0.003)
    found = preview(replace(thing, size=replace(thing.size, seen=looks)), [], HERE, ROBOT)
    assert found.approach is not None and found.from_another_side
    claw = found.approach.stand.heading + found.approach.stance.rotation
    assert abs(wrapped(2.0 * (claw - side))) / 2.0 < math.radians(25.0)


def test_box_at_the_last_look_is_judged_across_the_claw_and_not_where_it_was_measured():
    """Measured 80 mm wide over its corner, then 55 mm from here; the newest believed is still the first."""
    thing = ahead(0.45, width=0.08, width_sd=0.003)
    seen_along = HERE.heading + math.radians(45.0)
    looks = (SeenWidth(seen_along, 0.08, 0.003), SeenWidth(HERE.heading, 0.055, 0.003))
    known = replace(thing.size, seen_along=seen_along, seen=looks)
    assert preview(replace(thing, size=known), [], HERE, ROBOT, is_last_look=True).verdict is Verdict.YES


def test_box_that_looks_too_wide_from_far_is_driven_aside_once_that_was_told_twice():
    """From far another side is hardly a way round; by one look alone what stands behind may be part of it."""
    thing = ahead(1.5, width=0.085, width_sd=0.004)
    once, twice = (preview(by_picture(thing, told), [], HERE, ROBOT) for told in (1, 2))
    assert once.is_supposed and not once.from_another_side
    assert twice.from_another_side and twice.verdict is Verdict.UNSURE


def test_other_sides_are_not_sought_for_ever():
    thing = ahead(1.5, width=0.082, width_sd=0.003)
    seeking, tired = (preview(thing, [], HERE, ROBOT, other_sides=n) for n in (OTHER_SIDES, OTHER_SIDES + 1))
    assert seeking.from_another_side and not tired.from_another_side


def test_outline_too_wide_is_looked_at_from_near_before_it_is_believed():
    """A crate that stands close behind a cup passes for part of it from far away; a drawn box is believed."""
    far, near = (ahead(distance, width=0.2) for distance in (1.5, 0.6))
    found = [preview(by_picture(thing), [], HERE, ROBOT) for thing in (far, near)]
    assert [each.verdict for each in found] == [Verdict.UNSURE, Verdict.NO]
    assert preview(by_picture(near, told=1), [], HERE, ROBOT).verdict is Verdict.UNSURE
    assert "200 mm wide" in found[0].reason and found[0].approach is not None
    assert preview(far, [], HERE, ROBOT).verdict is Verdict.NO
    assert preview(by_picture(far), [], HERE, ROBOT, is_last_look=True).verdict is Verdict.NO


def test_narrow_thing_that_seems_to_have_no_upper_end_is_looked_at_from_near_before_it_is_refused():
    """As a cup before the leg of a table."""
    thing = by_picture(thing_at(0.8, 0.0, width=0.05, height=0.34), told=3)
    endless = replace(thing, size=replace(thing.size, goes_on_above=True))
    assert preview(endless, [], HERE, ROBOT).verdict is Verdict.UNSURE
    assert preview(endless, [], HERE, ROBOT, is_last_look=True).verdict is Verdict.NO
    wide = replace(endless, size=replace(endless.size, width=0.2))
    assert preview(wide, [], HERE, ROBOT).verdict is Verdict.NO


def by_picture(thing, told=2):
    return replace(thing, size=replace(thing.size, by_picture=True, told=told))


def test_doubt_at_the_last_look_is_a_no():
    standing = ahead(0.4, -0.045, foot=0.1)
    assert preview(standing, [], HERE, ROBOT).verdict is Verdict.UNSURE
    assert preview(standing, [], HERE, ROBOT, is_last_look=True).verdict is Verdict.NO


def test_width_from_a_side_that_was_not_seen_is_a_doubt():
    box = HERE.compose(PlanarPose(0.8, 0.0))
    found = preview(ahead(1.5, width=0.06), [obstacle_at("the box", box.x, box.y, 0.2)], HERE, ROBOT)
    assert found.verdict is Verdict.UNSURE
    assert "from the side where it is gripped" in found.reason


def test_place_that_is_hardly_known_is_a_doubt():
    found = preview(ahead(1.5, place_sd=0.4), [], HERE, ROBOT)
    assert found.verdict is Verdict.UNSURE
    assert "±80 cm" in found.reason


def test_thing_of_unknown_size_is_approached_as_supposed():
    known = ahead(1.5)
    thing = Thing(known.point_in_world, known.point_cov_in_world, NoSize("it has no clear edges"))
    found = preview(thing, [], HERE, ROBOT)
    assert found.verdict is Verdict.UNSURE
    assert "it has no clear edges" in found.reason
    assert found.is_supposed
    assert found.approach is not None
    assert found.grasp is None


def test_supposed_size_stands_on_the_floor_behind_the_tapped_place():
    known = ahead(1.0)
    thing = Thing(known.point_in_world, known.point_cov_in_world, NoSize("dark"))
    size = supposed_size(thing, HERE)
    off = size.axis_in_world[:2] - thing.point_in_world[:2]
    assert np.linalg.norm(off) == pytest.approx(size.width / 2.0)
    assert math.atan2(off[1], off[0]) == pytest.approx(HERE.heading)
    assert size.foot == 0.0


def test_preview_travels_between_processes():
    found = preview(ahead(1.5, 0.2), [], HERE, ROBOT)
    there = pickle.loads(pickle.dumps(found))
    assert (there.verdict, there.reason, there.path) == (found.verdict, found.reason, found.path)


def test_place_that_is_no_number_is_refused():
    thing = ahead(1.0)
    broken = replace(thing, point_in_world=np.array([math.nan, 0.0, 0.0]))
    with pytest.raises(InputError):
        preview(broken, [], HERE, ROBOT)


@pytest.mark.parametrize("width", [0.07, 0.04])
def test_box_that_was_gripped_in_vain_over_its_corner_is_gripped_from_another_side(width: float) -> None:
    """What is narrow is not: there another side helps no more than another try."""
    thing = ahead(1.0, width=width, width_sd=0.003)
    first = preview(thing, [], HERE, ROBOT).approach
    assert first is not None
    missed = first.stand.heading + first.stance.rotation
    again = preview(thing, [], HERE, ROBOT, missed_from=(missed,)).approach
    assert again is not None
    aside = abs(wrapped(2.0 * (again.stand.heading + again.stance.rotation - missed))) / 2.0
    assert (aside >= math.radians(30.0)) == (width > 0.055)


def test_what_looks_as_wide_from_all_around_is_gripped_from_the_same_side_again() -> None:
    looks = tuple(SeenWidth(HERE.heading + aside, 0.066, 0.002) for aside in np.arange(0.0, math.pi, 0.3))
    thing = ahead(1.0, width=0.066, width_sd=0.002)
    round_thing = replace(thing, size=replace(thing.size, seen=looks))
    first = preview(round_thing, [], HERE, ROBOT)
    assert preview(round_thing, [], HERE, ROBOT, missed_from=(HERE.heading,)).path == first.path


def test_where_no_other_side_is_free_it_is_gripped_from_where_it_was() -> None:
    thing = ahead(0.6, width=0.07, width_sd=0.003)
    walls = [hem(thing, math.radians(angle)) for angle in (60, 90, 120, 180, 240, 270, 300)]
    first = preview(thing, walls, HERE, ROBOT)
    again = preview(thing, walls, HERE, ROBOT, missed_from=(HERE.heading,))
    assert first.approach is not None and again.path == first.path


def hem(thing: Thing, angle: float) -> Obstacle:
    off = 0.3 * np.array([math.cos(HERE.heading + math.pi + angle), math.sin(HERE.heading + math.pi + angle)])
    return obstacle_at("a box", *(thing.point_in_world[:2] + off))


def test_way_of_standing_at_the_last_look_is_kept_where_others_are_hardly_better() -> None:
    """Or the robot turns to and fro between two."""
    for left in np.linspace(-0.1, 0.1, 9):
        thing = ahead(0.36, float(left), width=0.05)
        approach = preview(thing, [], HERE, ROBOT).approach
        assert approach is not None
        for rotation in ROTATIONS:
            kept = preview(thing, [], HERE, ROBOT, kept=rotation).approach
            assert kept is not None
            assert kept.stance.rotation in (rotation, approach.stance.rotation)
    others = {
        preview(ahead(0.36), [], HERE, ROBOT, kept=each).approach.stance.rotation for each in ROTATIONS[:3]
    }
    assert others == set(ROTATIONS[:3])


@pytest.mark.parametrize(
    ("height", "is_drawn", "verdict"), [(0.34, False, "no"), (0.34, True, "yes"), (0.24, False, "yes")]
)
def test_leg_of_a_chair_is_no_thing_unless_somebody_has_drawn_it(
    height: float, is_drawn: bool, verdict: str
) -> None:
    thing = ahead(0.8, width=0.05, height=height)
    size = replace(thing.size, by_picture=not is_drawn)
    found = preview(replace(thing, size=size), [], HERE, ROBOT, is_last_look=True)
    assert found.verdict == verdict
    assert ("leg of a chair" in found.reason) == (verdict == "no")
