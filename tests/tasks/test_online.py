"""What is shown of a target while the robot moves: with every frame, and the newest one never does harm."""

import asyncio
from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

import numpy as np

from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import load_scene
from tapreach.estimation.point_estimate import Status
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.clock import MS
from tapreach.tasks.compute import InlineCompute
from tapreach.tasks.estimating import estimate
from tapreach.tasks.locate import LocateTask
from tapreach.tasks.online import Seen, online_picture
from tapreach.tasks.optics import optics_of, points_in_camera
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.target import Target, TargetSource
from tapreach.tasks.target_report import TargetReport
from tapreach.tasks.task import Tap
from tasks.rig import OPERATOR, Rig, running_rig, sim_description, sim_robot
from tasks.test_locate import tap_on

T = TypeVar("T")
ROBOT = sim_description()
TARGET = np.array([1.4, 0.2, 0.1])
REPORT = TargetReport(1, TargetSource.LOCATE, Tap(0, 320.0, 240.0), ROBOT)


def seen_from(number: int, pose: PlanarPose, off_px: float = 0.0) -> Sighting:
    in_camera = points_in_camera(TARGET[None], pose, ROBOT.camera)
    u, v = map(float, optics_of(ROBOT.camera)[0].project(in_camera).pixels[0])
    return Sighting(number, number, Pixel(u + off_px, v), 0.4, 1.0, pose)


def drive(steps: int) -> list[Sighting]:
    poses = [PlanarPose()]
    for _ in range(steps):
        poses.append(poses[-1].after(PlanarStep(0.04, 0.06)))
    return [seen_from(number, pose) for number, pose in enumerate(poses)]


def test_newest_frame_makes_the_answer_surer() -> None:
    *before, newest = drive(6)
    now = online_picture(Seen(before, newest, "", newest.world_from_base), REPORT)
    plain = estimate(before, ROBOT, False)
    assert now.estimate is not None and now.estimate.relative_sd < plain.relative_sd
    assert now.estimate.sightings[-1].frame_id == newest.frame_id
    assert now.target.is_following and now.target.range_interval is not None


def test_newest_frame_that_does_not_fit_is_left_out_and_opens_no_way() -> None:
    before = drive(6)
    wrong = seen_from(99, before[-1].world_from_base.after(PlanarStep(0.0, 0.02)), off_px=25.0)
    opened = estimate([*before, wrong], ROBOT, False)
    now = online_picture(Seen(before, wrong, "", wrong.world_from_base), REPORT)
    plain = estimate(before, ROBOT, False)
    assert now.estimate is not None and now.estimate.status is Status.DETERMINED
    assert now.estimate.relative_sd == plain.relative_sd
    assert now.estimate.heading_from is plain.heading_from is not opened.heading_from


def test_lost_target_grows_less_sure_while_the_robot_rolls_on() -> None:
    seen = drive(6)
    widths = []
    for rolled in (0.0, 0.05, 0.1):
        here = seen[-1].world_from_base.after(PlanarStep(0.0, rolled))
        target = online_picture(Seen(seen, seen[-1], "it is hidden", here), REPORT).target
        assert not target.is_following and target.point_cov_in_world is not None
        widths.append(float(np.trace(target.point_cov_in_world)))
    assert widths[0] < widths[1] < widths[2]


def test_one_sighting_alone_is_shown_without_an_estimate() -> None:
    (first,) = drive(0)
    now = online_picture(Seen([first], first, "", first.world_from_base), REPORT)
    assert now.estimate is None and now.target.status == "following"


class _Noting(InlineCompute):
    """Notes which functions were called, and lets one be looked at."""

    def __init__(self, on_call: Callable[[str], None]) -> None:
        self._on_call = on_call

    async def call(self, function: Callable[..., T], *arguments: object) -> T:
        self._on_call(function.__name__)
        return await super().call(function, *arguments)


def test_region_on_the_page_changes_with_every_frame_of_the_move() -> None:
    async def test() -> None:
        async with running_rig(sim_robot(load_scene("room"))) as rig:
            await rig.advance(0.3)
            calls, targets = await _located(rig)
            moving = "".join("f" if call == "follow" else "p" for call in calls)
            assert "fp" * 10 in moving
            shown = [each for each in targets if each.point_cov_in_world is not None]
            regions = [tuple(np.ravel(each.point_cov_in_world).tolist()) for each in shown]
            pictures = sum(call == "online_picture" for call in calls)
            assert len(set(regions)) > 0.6 * pictures > 5
            widths = [np.trace(each.point_cov_in_world) for each in shown]
            assert widths[-1] < 0.2 * widths[0]

    asyncio.run(test())


async def _located(rig: Rig) -> tuple[list[str], list[Target]]:
    calls: list[str] = []
    noting = _Noting(lambda name: calls.append(name) if name in ("follow", "online_picture") else None)
    rig.runner._context = replace(rig.context, compute=noting)
    tap, _ = await tap_on(rig, "red can")
    rig.runner.start(LocateTask(tap, 1, accuracy=0.05), OPERATOR)
    await rig.finish()
    return calls, rig.targets


def test_machine_that_is_behind_follows_first() -> None:
    """A worker that takes longer than a frame for the following alone."""

    async def test() -> None:
        scene = load_scene("room")
        async with running_rig(lambda clock: InlineSimRobot(sim_description(30.0), scene, clock)) as rig:
            await rig.advance(0.3)
            calls: list[str] = []

            class Slow(InlineCompute):
                async def call(self, function: Callable[..., T], *arguments: object) -> T:
                    calls.append(function.__name__)
                    if function.__name__ == "follow":
                        await rig.clock.sleep_until(rig.clock.now_ns() + 40 * MS)
                    return await super().call(function, *arguments)

            rig.runner._context = replace(rig.context, compute=Slow())
            tap, _ = await tap_on(rig, "red can")
            rig.runner.start(LocateTask(tap, 1, accuracy=0.2), OPERATOR)
            await rig.finish()
            assert calls.count("follow") > 1.7 * calls.count("online_picture") > 5

    asyncio.run(test())
