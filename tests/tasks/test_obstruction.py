"""A robot that something blocks: the wheels turn, the picture does not move; it is noticed and said."""

import asyncio
from dataclasses import replace

import numpy as np

from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import Scene, load_scene
from tapreach.estimation.step_knowledge import NOTHING_SEEN
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.messages import Frame
from tapreach.tasks.background_watch import BackgroundWatch
from tapreach.tasks.frame_pose import pose_at
from tapreach.tasks.locate_end import End, closing_reason
from tapreach.tasks.locate_watch import BLOCKED, SLIPPING, MoveWatch
from tapreach.tasks.sighting import SeenWay, Sighting, ray_of
from tapreach.tasks.task import TaskContext
from tapreach.vision.image_io import Gray, decode_gray
from tasks.rig import OPERATOR, Rig, running_rig, sim_description, sim_robot

ROBOT = sim_description()


class _Drive:
    """A task that drives straight ahead."""

    kind = "drive"

    def __init__(self, distance: float) -> None:
        self._distance = distance

    async def run(self, context: TaskContext) -> str:
        await context.pilot.advance(self._distance)
        return "done"


def watched_drive(scene: Scene, start: PlanarPose, distance: float) -> tuple[list[SeenWay], float]:
    """The ways that the background shows of a straight drive, and how far the wheels say it went [m]."""

    async def run() -> tuple[list[SeenWay], float]:
        async with running_rig(sim_robot(scene)) as rig:
            assert isinstance(rig.robot, InlineSimRobot)
            rig.robot.place_base(start)
            await rig.advance(0.5)
            return await _watched(rig, distance)

    return asyncio.run(run())


async def _watched(rig: Rig, distance: float) -> tuple[list[SeenWay], float]:
    frame = rig.frames.store.newest
    assert frame is not None
    first = pose = await pose_at(rig.context, frame.captured_ns)
    watch = BackgroundWatch(_picture(frame), frame.frame_id, pose, ROBOT)
    rig.runner.start(_Drive(distance), OPERATOR)
    ways = list[SeenWay]()
    for _ in range(40):
        await rig.advance(0.1)
        frame = rig.frames.store.newest
        assert frame is not None
        at = await pose_at(rig.context, frame.captured_ns)
        watch.follow(_picture(frame))
        if np.hypot(at.x - pose.x, at.y - pose.y) > 0.03:
            pose = at
            ways += [way for way in (watch.way_to(at),) if way is not None]
            if watch.is_thin:
                watch.renew(_picture(frame), frame.frame_id, at)
        if not rig.runner.is_running:
            break
    return ways, float(np.hypot(pose.x - first.x, pose.y - first.y))


def _picture(frame: Frame) -> Gray:
    picture = decode_gray(frame.jpeg)
    assert isinstance(picture, np.ndarray)
    return picture


def test_push_against_a_wall_is_noticed_while_it_happens() -> None:
    scene = load_scene("room")
    before_the_wall = PlanarPose(scene.room.x[1] - 0.5, -1.0, 0.0)
    ways, driven = watched_drive(scene, before_the_wall, 0.5)
    assert driven > 0.15, "the wheels go on turning"
    assert not ways[0].stands_still, "it comes to the wall first"
    alarms = [way for way in ways if way.stands_still]
    assert alarms and all(way.knowledge.has_slipped for way in alarms)


def test_free_drive_raises_no_alarm() -> None:
    ways, driven = watched_drive(load_scene("room"), PlanarPose(-0.3, 0.0, 0.0), 0.5)
    assert driven > 0.4 and len(ways) > 8
    assert not any(way.stands_still for way in ways)


def sightings(*ways: SeenWay | None) -> list[Sighting]:
    return [
        Sighting(i, i, Pixel(320.0, 240.0), 0.5, 1.0, PlanarPose(0.03 * i), way=way)
        for i, way in enumerate(ways)
    ]


def reason(*ways: SeenWay | None) -> str:
    seen = sightings(None, *ways)
    return MoveWatch(ROBOT, 0.01, ray_of(seen[0], ROBOT), 1.0, True).reason_to_stop(seen, None, 0)


SOUND = SeenWay(0, NOTHING_SEEN)
SLIPPED = SeenWay(0, replace(NOTHING_SEEN, has_slipped=True))


def test_move_ends_where_the_picture_stands_still_or_slips_twice_in_a_row() -> None:
    assert reason(SOUND, replace(SLIPPED, stands_still=True)) == BLOCKED
    assert reason(SOUND, SLIPPED, None, SLIPPED) == SLIPPING
    assert reason(SOUND, SLIPPED) == reason(SLIPPED, SOUND) == reason(SOUND) == ""
    assert reason(SLIPPED, SLIPPED, *[None] * 20) == "", "an old one says nothing of this move"


def test_obstruction_is_what_locating_says_at_its_end() -> None:
    said = closing_reason(0.03, End.OBSTRUCTED, 0.01, 0.3, "", BLOCKED)
    assert said == f"range known to 3 %; {BLOCKED}"
