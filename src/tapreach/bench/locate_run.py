"""One tap from beginning to end, once for every arm, each in a world of its own that begins the same."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.bench.locate_arms import ARM_TASKS
from tapreach.bench.locate_fixed import FixedMove, paper_range
from tapreach.bench.locate_outcome import Outcome, region_distance
from tapreach.bench.locate_pictures import write_glimpse
from tapreach.bench.locate_plan import Arm, LocatePlan
from tapreach.bench.locate_stage import draw_stage
from tapreach.bench.places import SETTLED_S, surface_at
from tapreach.bench.running_robot import RunningRobot, running_robot
from tapreach.bench.stage import Stage
from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.truth import SurfacePoint, WorldTruth, ask_truth
from tapreach.errors import SetupError
from tapreach.estimation.point_estimate import PointEstimate, Status
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.gaussian import squared_mahalanobis
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.clock import SECOND, Clock, ManualClock
from tapreach.robot.config import RobotDescription
from tapreach.tasks.estimating import LocatedPoint
from tapreach.tasks.present_base import at_present
from tapreach.tasks.runner import TaskProgress
from tapreach.tasks.task import Tap, TaskState


@dataclass(frozen=True)
class Before:
    """What was true when the tapped frame was taken."""

    truth: WorldTruth
    surface: SurfacePoint
    odometry: PlanarPose
    frame_jpeg: bytes
    tapped_ns: int


async def run_tap(plan: LocatePlan, number: int, clock: Clock) -> list[Outcome]:
    """Draw the tap with this number and return its outcome in every arm; the fixed move's is followed by
    that of the paper's formula on the same pixels.

    Writes a picture of what went wrong to the plan's folder for them. Raises SetupError.
    """
    stage = await draw_stage(plan.seed, number, plan.rate_hz)
    outcomes = []
    for arm in plan.arms_of(number):
        outcomes += await _run_arm(stage, arm, clock, plan.folder)
    return outcomes


async def _run_arm(stage: Stage, arm: Arm, clock: Clock, failures: Path | None) -> list[Outcome]:
    simulated = ManualClock()
    robot = InlineSimRobot(stage.description, stage.scene, simulated, stage.faults, stage.seed, shadows=False)
    began_ns = clock.now_ns()
    async with running_robot(robot, simulated) as running:
        robot.place_base(stage.start)
        await running.advance(SETTLED_S)
        before = await _before(running, stage)
        task = ARM_TASKS[arm](Tap(running.newest_frame.frame_id, stage.pixel.u, stage.pixel.v))
        progress = await running.carry_out(task)
        outcome = await _outcome(running, stage, arm, before, progress)
        outcome = replace(outcome, wall_seconds=(clock.now_ns() - began_ns) / SECOND)
        if failures is not None and (outcome.is_wrong or not outcome.is_answered or outcome.is_far_off):
            await _picture(running, before, outcome, failures)
    if isinstance(task, FixedMove):
        return [outcome, _by_paper(outcome, task, before, stage.description)]
    return [outcome]


async def _before(running: RunningRobot, stage: Stage) -> Before:
    frame = running.newest_frame
    surface = surface_at(running.robot, stage.pixel, frame.captured_ns)
    if surface is None or surface.name != stage.thing:
        raise SetupError(f"tap {stage.number}: {stage.thing!r} does not lie under the tapped pixel any more")
    truth = await ask_truth(running.robot, frame.captured_ns)
    odometry = running.context.poses.at(frame.captured_ns)
    return Before(truth, surface, odometry, frame.jpeg, running.clock.now_ns())


async def _outcome(
    running: RunningRobot, stage: Stage, arm: Arm, before: Before, progress: TaskProgress
) -> Outcome:
    after = await ask_truth(running.robot)
    way = before.odometry.between(running.context.poses.newest()[1])
    true_way = before.truth.base_pose.between(after.base_pose)
    said, driven = float(np.hypot(way.x, way.y)), float(np.hypot(true_way.x, true_way.y))
    point = _point_now(after, before.surface)
    estimate = running.compute.estimate if progress.state is TaskState.DONE else None
    outcome = Outcome(
        tap=stage.number,
        arm=str(arm),
        scene=stage.scene_name,
        thing=stage.thing,
        distance=before.surface.distance,
        status=str(estimate.status) if estimate is not None else str(progress.state),
        note=progress.message,
        seconds=(running.clock.now_ns() - before.tapped_ns) / SECOND,
        driven=driven,
        scale=said / driven if driven > 0.02 else 1.0,
        moved=float(np.linalg.norm(point - before.surface.point_in_world)),
        views=len(running.compute.sightings),
        wall_seconds=0.0,
        track_px=await _track_px(running, point),
    )
    if estimate is None or estimate.status is not Status.DETERMINED:
        return outcome
    return _judged(outcome, estimate, running, before, after, point)


def _judged(
    outcome: Outcome,
    estimate: PointEstimate,
    running: RunningRobot,
    before: Before,
    after: WorldTruth,
    point: FloatArray,
) -> Outcome:
    assert estimate.bearing is not None and estimate.inverse_depth is not None and estimate.range is not None
    assert estimate.bearing_inverse_depth_cov is not None and estimate.range_interval_95 is not None
    in_camera = before.truth.camera_pose.inv().apply(before.surface.point_in_world)
    error, covariance = _error_in_base(estimate, running, after, point)
    bearing_depth = np.array([*estimate.bearing, estimate.inverse_depth])
    cov = estimate.bearing_inverse_depth_cov
    low, high = estimate.range_interval_95
    return replace(
        outcome,
        range_error=estimate.range / outcome.distance - 1.0,
        position_error=float(np.linalg.norm(error)) / outcome.distance,
        nees=region_distance(bearing_depth, cov, in_camera),
        nees_depth=(1.0 / float(in_camera[2]) - estimate.inverse_depth) ** 2 / float(cov[2, 2]),
        nees_position=squared_mahalanobis(error, covariance),
        holds_range=low <= outcome.distance and (high is None or outcome.distance <= high),
        relative_sd=estimate.relative_sd,
        rejected=len(estimate.rejected_views),
    )


def _error_in_base(
    estimate: PointEstimate, running: RunningRobot, after: WorldTruth, point: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the error of the point (3,) [m] where the base is now, and its covariance (3, 3) [m²]: that of
    the page, the way since the last sighting included.
    """
    assert isinstance(estimate, LocatedPoint)
    here = running.context.poses.newest()[1]
    present = at_present(estimate, here, running.robot.description)
    assert present is not None
    base_from_world = here.to_rigid().inv()
    true_in_base = RigidTransform.from_matrix(np.array(after.world_from_base)).inv().apply(point)
    turn = base_from_world.rotation.as_matrix()
    return (
        np.asarray(base_from_world.apply(present.point_in_world) - true_in_base),
        np.asarray(turn @ present.cov_in_world @ turn.T),
    )


def _point_now(truth: WorldTruth, surface: SurfacePoint) -> FloatArray:
    """Return where the tapped point of the thing is now: things can be pushed."""
    pose = RigidTransform.from_matrix(np.array(truth.object(surface.name).world_from_object))
    return np.asarray(pose.apply(surface.point_in_object))


async def _track_px(running: RunningRobot, point: FloatArray) -> float | None:
    """Return how far off the place last followed was [px]; None without one, or for a point out of sight."""
    if not running.compute.sightings:
        return None
    last = running.compute.sightings[-1]
    taken_ns = running.context.camera_delay.taken_ns(last.captured_ns)
    there = (await ask_truth(running.robot, taken_ns)).camera_pose.inv().apply(point)
    projection = running.robot.description.camera.model().project(there[None])
    if not projection.is_valid[0]:
        return None
    return float(np.linalg.norm(projection.pixels[0] - last.pixel.to_array()))


def _by_paper(outcome: Outcome, task: FixedMove, before: Before, description: RobotDescription) -> Outcome:
    """Return the outcome of the paper's formula on what the fixed move saw: a range, and no region."""
    distance = None
    if task.sightings:
        first, last = task.sightings
        distance = paper_range(first, last, description)
    error = None if distance is None else distance / before.surface.distance - 1.0
    return replace(
        outcome,
        arm="fixed move, paper's formula",
        status=outcome.status if not task.sightings else "determined" if error is not None else "no answer",
        range_error=error,
        position_error=None,
        nees=None,
        nees_depth=None,
        nees_position=None,
        holds_range=None,
        relative_sd=None,
    )


async def _picture(running: RunningRobot, before: Before, outcome: Outcome, folder: Path) -> None:
    """Write the tapped frame and the newest one, with where the thing was followed to and where it is."""
    taken_ns = running.context.camera_delay.taken_ns(running.newest_frame.captured_ns)
    truth = await ask_truth(running.robot, taken_ns)
    point = _point_now(truth, before.surface)
    camera = running.robot.description.camera.model()
    pixel = camera.project(truth.camera_pose.inv().apply(point)[None]).pixels[0]
    sightings = running.compute.sightings
    followed = sightings[-1].pixel.to_array() if sightings else None
    first = camera.project(before.truth.camera_pose.inv().apply(before.surface.point_in_world)[None]).pixels[
        0
    ]
    write_glimpse(folder, outcome, (before.frame_jpeg, first), (running.newest_frame.jpeg, pixel), followed)
