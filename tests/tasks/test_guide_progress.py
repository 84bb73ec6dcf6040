"""The step logic of the guides: what each step offers, where taps lead, what typed values change."""

import math

import pytest

from tapreach.errors import InputError
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.tasks.guide_progress import GuideProgress, is_turn_then_advance
from tapreach.tasks.guide_steps import ROTATION_CENTRE, TWO_TAP
from tapreach.tasks.sighting import Sighting

START = PlanarPose()
FIRST = PlanarPose(1.0, 2.0, 0.4)


def sighting(pose: PlanarPose = START, u: float = 320.0) -> Sighting:
    return Sighting(1, 1, Pixel(u, 240.0), 1.0, 1.0, pose)


def at_second_tap(first: PlanarPose = FIRST) -> GuideProgress:
    progress = GuideProgress(TWO_TAP).acted("next").acted("next").tapped(sighting(first))
    return progress.acted("next").acted("next")


def test_two_tap_walks_through_six_steps() -> None:
    progress = GuideProgress(TWO_TAP)
    offered = [progress.acts]
    for _ in range(2):
        progress = progress.acted("next")
        offered.append(progress.acts)
    assert progress.step.key == "first"
    progress = progress.tapped(sighting())
    assert progress.step.key == "turn", "a needed tap leads on by itself"
    offered.append(progress.acts)
    assert offered == [("pose", "next"), ("next", "back"), ("back",), ("turn", "next", "back")]
    progress = progress.acted("next").acted("next")
    assert (progress.step.key, progress.is_complete) == ("second", False)
    assert progress.tapped(sighting()).is_complete


def test_centring_is_offered_after_a_rough_tap() -> None:
    progress = GuideProgress(TWO_TAP).acted("next")
    assert "centre" not in progress.acts
    assert "centre" in progress.tapped(sighting(u=400.0)).acts


def test_needed_tap_cannot_be_skipped() -> None:
    progress = GuideProgress(TWO_TAP).acted("next").acted("next")
    with pytest.raises(InputError, match="'next' is not on offer"):
        progress.acted("next")


def test_tap_in_a_step_without_one_is_refused() -> None:
    with pytest.raises(InputError, match="takes no tap"):
        GuideProgress(TWO_TAP).tapped(sighting())


def test_back_forgets_what_was_tapped_there() -> None:
    progress = at_second_tap().tapped(sighting())
    assert progress.is_complete
    progress = progress.acted("back")
    assert (progress.step.key, progress.is_complete) == ("second", False)
    for _ in range(3):
        progress = progress.acted("back")
    assert (progress.step.key, progress.taps) == ("first", {})


def test_values_are_read_from_odometry_and_typed_over_it() -> None:
    first = FIRST
    here = first.after(PlanarStep(0.2, 0.17))
    progress = at_second_tap(first)
    assert progress.theta(here) == pytest.approx(0.2)
    assert progress.distance(here) == pytest.approx(0.17)
    typed = progress.with_value("theta_deg", 12.0).with_value("distance", 0.2)
    assert typed.theta(here) == pytest.approx(math.radians(12.0))
    assert typed.distance(here) == 0.2
    assert typed.with_value("theta_deg", None).theta(here) == pytest.approx(0.2)


def test_values_are_unknown_before_the_first_tap() -> None:
    progress = GuideProgress(TWO_TAP)
    assert progress.theta(PlanarPose()) is None
    assert progress.distance(PlanarPose()) is None


@pytest.mark.parametrize(("name", "value"), [("theta_deg", math.nan), ("distance", math.inf), ("d", 1.0)])
def test_bad_value_is_refused(name: str, value: float) -> None:
    with pytest.raises(InputError):
        GuideProgress(TWO_TAP).with_value(name, value)


@pytest.mark.parametrize(
    ("way", "is_the_papers"),
    [
        (PlanarStep(0.2, 0.3).to_pose(), True),
        (PlanarStep(0.2, 0.0).to_pose(), True),
        (PlanarPose().after_arc(0.3, 0.5), False),
        (PlanarPose(0.3, 0.0, 0.5), False),
    ],
    ids=["turn then advance", "turn only", "arc", "advance then turn"],
)
def test_the_papers_way_is_told_from_others(way: PlanarPose, is_the_papers: bool) -> None:
    assert is_turn_then_advance(way) is is_the_papers


def test_rotation_centre_needs_four_taps() -> None:
    assert [step.key for step in ROTATION_CENTRE if step.needs_tap] == [
        "near",
        "far",
        "near_again",
        "far_again",
    ]
