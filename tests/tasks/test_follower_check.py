"""A check that throws sightings away keeps the way they were seen on: the background saw that."""

import asyncio
from typing import Any

import numpy as np

from tapreach.estimation.step_knowledge import NOTHING_SEEN
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.depth_check import Checked
from tapreach.tasks.follower import Follower
from tapreach.tasks.sighting import Passed, SeenWay, Sighting
from tapreach.tasks.task import Tap

KEY, AFTER = 3, 9


def sighting(number: int, way: SeenWay | None = None) -> Sighting:
    pose = PlanarPose(0.05 * number, 0.0, 0.01 * number)
    return Sighting(number, number, Pixel(300.0, 200.0), 0.4, 1.0, pose, way, number == KEY)


def way_from(frame_id: int) -> SeenWay:
    return SeenWay(frame_id, NOTHING_SEEN, "")


class Computes:
    """Answers every question with what is believed of the sightings."""

    def __init__(self, believed: list[Sighting]) -> None:
        self.believed = believed

    async def call(self, *_: Any) -> Checked:
        return Checked(tuple(self.believed))


class Context:
    def __init__(self, believed: list[Sighting]) -> None:
        self.compute = Computes(believed)


def followed_and_checked(believed: slice, newest: int = AFTER) -> Follower:
    seen = [sighting(0), sighting(1), sighting(KEY, way_from(0)), sighting(5, way_from(KEY)), sighting(6)]
    seen.append(sighting(7, way_from(KEY)))
    follower = Follower(Context(seen[believed]), Tap(0, 300.0, 200.0), 1)  # type: ignore[arg-type]
    follower.sightings, follower.frame_id = list(seen), newest
    asyncio.run(follower.check())
    return follower


def test_way_past_the_last_sighting_believed_is_known_by_the_background() -> None:
    follower = followed_and_checked(slice(0, 2))
    way = follower.way_since(1)
    assert [each.frame_id for each in way] == [1, KEY, 5, 7]
    assert all(isinstance(each, Passed) for each in way[1:])
    assert way[1].is_key and [each.way.since_id for each in way[1:]] == [0, KEY, KEY]  # type: ignore[union-attr]
    np.testing.assert_allclose([each.world_from_base.x for each in way], [0.05, 0.15, 0.25, 0.35])


def test_where_the_newest_frame_is_believed_nothing_was_passed() -> None:
    follower = followed_and_checked(slice(0, 6), newest=7)
    assert [each.frame_id for each in follower.way_since(7)] == [KEY, 5, 6, 7]
    assert not any(isinstance(each, Passed) for each in follower.way_since(7))
