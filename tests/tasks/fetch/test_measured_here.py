"""What is known of a thing's width from one side is not taken for its width from another."""

import math
from dataclasses import replace

import pytest

from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.fetch.approaching import is_to_be_measured
from tapreach.tasks.fetch.believed_size import believed
from tapreach.tasks.fetch.run import FetchRun
from tapreach.tasks.fetch.thing import NoSize, ThingSize
from tasks.fetch.looks import HERE, RED, SPOT, run_after_look
from tasks.fetch.worlds import BODY, size_at

FROM_THE_RIGHT = PlanarPose(0.6, -0.4, math.radians(90.0))


def standing(here: PlanarPose, width: float) -> FetchRun:
    """A fetch of a thing that was measured from behind, with the base at `here` by now."""
    run = run_after_look((RED, RED, RED))
    run.size = replace(size_at(0.6, 0.03, width=width), seen_along=0.0, by_picture=True)
    run.context.poses.add(2, here)
    return run


@pytest.mark.parametrize(
    ("here", "width", "is_wanted"),
    [(HERE, 0.086, False), (FROM_THE_RIGHT, 0.086, True), (FROM_THE_RIGHT, 0.05, False)],
    ids=["from where it was measured", "too wide, from elsewhere", "narrow enough from anywhere"],
)
def test_width_that_may_be_a_diagonal_is_measured_again(
    here: PlanarPose, width: float, is_wanted: bool
) -> None:
    assert is_to_be_measured(standing(here, width)) == is_wanted


def test_what_was_never_measured_is_to_be() -> None:
    run = standing(HERE, 0.05)
    run.size = NoSize("only 2 pictures of it from this side")
    assert is_to_be_measured(run)


def test_what_was_measured_otherwise_since_is_measured_again_and_not_refused_as_too_wide() -> None:
    """Two cans side by side looked like one; from nearer only one of them was cut out."""
    run = standing(HERE, 0.13)
    assert not is_to_be_measured(run)
    run.measured(replace(size_at(0.6, 0.03, width=0.055), by_picture=True, seen_along=0.0), SPOT)
    size = run.thing().size
    assert isinstance(size, ThingSize) and size.width == 0.13 and size.is_doubted
    assert is_to_be_measured(run)
    told_twice = replace(size, told=2)
    assert isinstance(believed(told_twice, HERE, BODY), NoSize)
    assert isinstance(believed(replace(told_twice, is_doubted=False), HERE, BODY), ThingSize)
