"""What is about to be gripped has the colours of the spot that was tapped, or is another thing."""

import asyncio

import numpy as np
import pytest

from tapreach.tasks.fetch.as_tapped import looks_as_tapped, remember_tapped
from tapreach.tasks.fetch.run import FetchRun
from tasks.fetch.looks import GREEN, MIDDLE, RED, frame, run_after_look


def later_in(run: FetchRun, colour: tuple[int, int, int]) -> FetchRun:
    """The fetch when the thing followed shows a colour where it is followed by now."""
    assert run.locating is not None
    asyncio.run(remember_tapped(run))
    last = run.locating.follower.last
    run.context.frames.add(frame(MIDDLE, colour, last.world_from_base, 9))
    object.__setattr__(last, "frame_id", 9)
    return run


@pytest.mark.parametrize(("colour", "is_alike"), [(RED, True), (GREEN, False)])
def test_thing_followed_to_the_end_is_the_one_tapped_if_it_has_its_colour(
    colour: tuple[int, int, int], is_alike: bool
) -> None:
    run = later_in(run_after_look((RED, RED, RED)), colour)
    assert asyncio.run(looks_as_tapped(run)) is is_alike


def test_colours_learned_of_another_thing_on_the_way_do_not_count() -> None:
    run = later_in(run_after_look((RED, GREEN, GREEN)), GREEN)
    assert not asyncio.run(looks_as_tapped(run))


def test_nothing_is_said_of_what_is_not_seen_or_was_never_seen_tapped() -> None:
    run = run_after_look((RED, RED, RED))
    assert asyncio.run(looks_as_tapped(run))
    later_in(run, GREEN)
    assert run.locating is not None
    run.locating.follower.loss = "it is hidden"
    assert asyncio.run(looks_as_tapped(run))


def test_spot_tapped_is_known_by_its_distance() -> None:
    run = run_after_look((RED, RED, RED))
    asyncio.run(remember_tapped(run))
    assert run.memory.tapped is not None
    first, point = run.locating.follower.sightings[0], run.locating.estimate.point_in_world  # type: ignore[union-attr]
    off = np.linalg.norm(point[:2] - [first.world_from_base.x, first.world_from_base.y])
    assert 0.5 * off < run.memory.tapped.distance < 1.5 * off
