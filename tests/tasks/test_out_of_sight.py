"""A robot that turns away from what it has located, on wheels that turn it farther than they say."""

import asyncio

import numpy as np

from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.scene import load_scene
from tapreach.geometry.planar_motion import PlanarStep
from tapreach.tasks.follower import Follower
from tapreach.tasks.locating import Locating
from tapreach.tasks.present_base import PresentPoint, at_present
from tapreach.tasks.target import TargetSource
from tapreach.tasks.target_report import TargetReport
from tapreach.tasks.task import Tap, TaskContext, TaskState
from tasks.rig import OPERATOR, Doing, running_rig, sim_robot
from tasks.test_locate import in_odometry, tap_on

FAULTS = SimFaults(track_error=-0.09)
AWAY = PlanarStep(-0.9, 0.1), PlanarStep(-0.5, 0.1)


async def _lose(context: TaskContext, tap: Tap) -> tuple[PresentPoint, PresentPoint]:
    """Locate it, turn away until it is out of the picture, and return where it is by wheels, and bridged."""
    report = TargetReport(1, TargetSource.LOCATE, tap, context.description)
    locating = Locating(context, Follower(context, tap, 1), report, 0.02)
    await locating.run()
    for step in AWAY:
        await locating.drive(context.pilot.move(step))
    assert locating.follower.loss and locating.estimate is not None
    here = context.poses.newest()[1]
    by_wheels = at_present(locating.estimate, here, context.description)
    bridged = at_present(locating.estimate, here, context.description, locating.way_since_seen)
    assert by_wheels is not None and bridged is not None
    return by_wheels, bridged


def test_what_is_out_of_sight_is_known_as_far_as_the_background_shows_the_way() -> None:
    async def test() -> None:
        async with running_rig(sim_robot(load_scene("room"), faults=FAULTS)) as rig:
            await rig.advance(0.3)
            tap, point = await tap_on(rig, "red can")
            found: list[tuple[PresentPoint, PresentPoint]] = []

            async def lose(context: TaskContext) -> None:
                found.append(await _lose(context, tap))

            rig.runner.start(Doing(lose), OPERATOR)
            assert (await rig.finish()).state is TaskState.DONE
            ((by_wheels, bridged),) = found
            truth = await in_odometry(rig, point)
            off = [
                float(np.linalg.norm(each.point_in_world[:2] - truth[:2])) for each in (by_wheels, bridged)
            ]
            assert off[0] > 0.05
            assert off[1] < 0.5 * off[0]
            error = (bridged.point_in_world - truth)[:2]
            assert error @ np.linalg.solve(bridged.cov_in_world[:2, :2], error) < 13.8
            shown = rig.targets[-1]
            assert not shown.is_following and shown.point_in_world is not None
            np.testing.assert_allclose(shown.point_in_world, bridged.point_in_world, atol=0.01)

    asyncio.run(test())
