"""Which turn and advance tell most about a target that must stay in the picture.

Each candidate is scored by the bound on the range that one more view from its end would leave, over the
supposed distances of the target. Turns are chosen by where in the picture they put the target: sideways is
where an advance makes parallax.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from tapreach.estimation.bound import position_bound
from tapreach.estimation.observation import Observation
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import ImageSize, Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep, wrapped
from tapreach.robot.config import RobotDescription
from tapreach.tasks.estimating import mount_noise, odometry_noise
from tapreach.tasks.sighting import Sighting, observation_of

COLUMNS = (0.14, 0.22, 0.32, 0.42, 0.5, 0.58, 0.68, 0.78, 0.86)
"""Where a turn may put the target, as a share of the picture's width."""
ADVANCES = (0.05, 0.09, 0.14, 0.22, 0.32, 0.42)
MARGIN = 0.07
"""The target stays this share of the picture away from its edges."""
NEAREST = 0.25
"""The camera comes no nearer to where the target may be [m]."""
LONGEST_TURN = math.radians(40.0)
VIEW_SIGMA = 0.7
"""What a view at a stop is worth [px]."""
_PER_METRE, _PER_RADIAN = 0.3, 0.1
"""What driving and turning cost, in units of the logarithm of the range's relative error."""


@dataclass(frozen=True, slots=True)
class Choice:
    """A move and the relative error of the range it promises (one sigma, for the middle distance)."""

    step: PlanarStep
    relative_sd: float


def choose_move(
    sightings: Sequence[Sighting],
    world_from_base: PlanarPose,
    points_in_world: Sequence[FloatArray],
    most_advance: float,
    description: RobotDescription,
) -> Choice | None:
    """Return the best turn and advance from `world_from_base`; None when none keeps the target in the
    picture.

    points_in_world: where the target may be, (3,) each, the nearest first. A move that suits all of them is
    preferred; where there is none the nearest are given up one by one. most_advance [m]: what may still be
    driven.
    """
    known = [observation_of(sighting, description) for sighting in sightings]
    for given_up in range(len(points_in_world)):
        points = points_in_world[given_up:]
        choices = _scored(known, world_from_base, points, most_advance, description)
        if choices:
            return min(choices, key=lambda pair: pair[0])[1]
    return None


def _scored(
    known: Sequence[Observation],
    world_from_base: PlanarPose,
    points_in_world: Sequence[FloatArray],
    most_advance: float,
    description: RobotDescription,
) -> list[tuple[float, Choice]]:
    """Return every candidate with its score; lower is better."""
    scored = []
    for step in _candidates(world_from_base, points_in_world, most_advance, description):
        found = _relative_sds(known, world_from_base, step, points_in_world, description)
        if found and all(map(math.isfinite, found)):
            cost = _PER_METRE * step.advance + _PER_RADIAN * abs(step.turn)
            score = float(np.mean(np.log(found))) + cost
            scored.append((score, Choice(step, found[len(found) // 2])))
    return scored


def _candidates(
    world_from_base: PlanarPose,
    points_in_world: Sequence[FloatArray],
    most_advance: float,
    description: RobotDescription,
) -> Iterable[PlanarStep]:
    middle = points_in_world[len(points_in_world) // 2]
    for column in COLUMNS:
        turn = _turn_to_column(world_from_base, middle, column, description)
        if abs(turn) > LONGEST_TURN:
            continue
        for advance in ADVANCES:
            step = PlanarStep(turn, advance)
            if advance <= most_advance and all(
                _is_seen_and_clear(world_from_base, step, point, description) for point in points_in_world
            ):
                yield step


def _turn_to_column(
    world_from_base: PlanarPose, point: FloatArray, column: float, description: RobotDescription
) -> float:
    """Return the turn [rad] after which the point stands at this share of the picture's width."""
    camera = description.camera.model()
    wanted = math.atan2(camera.cx - column * camera.size.width, camera.fx)
    turn = 0.0
    # The camera stands ahead of the axis, so that the bearing from it changes a little with the turn.
    for _ in range(3):
        pose = world_from_base.after(PlanarStep(turn, 0.0))
        x, _, z = _in_camera(pose, point, description)
        turn += wrapped(math.atan2(-x, z) - wanted)
    return turn


def _is_seen_and_clear(
    world_from_base: PlanarPose, step: PlanarStep, point: FloatArray, description: RobotDescription
) -> bool:
    for advance in (0.0, step.advance):
        in_camera = _in_camera(world_from_base.after(PlanarStep(step.turn, advance)), point, description)
        projection = description.camera.model().project(in_camera[None])
        if not projection.is_inside[0] or not _is_well_inside(
            projection.pixels[0], description.camera.model().size
        ):
            return False
    return float(np.linalg.norm(in_camera)) >= NEAREST


def _is_well_inside(pixel: FloatArray, size: ImageSize) -> bool:
    u, v = pixel / (size.width, size.height)
    return bool(MARGIN <= u <= 1.0 - MARGIN and MARGIN <= v <= 1.0 - MARGIN)


def _in_camera(world_from_base: PlanarPose, point: FloatArray, description: RobotDescription) -> FloatArray:
    world_from_camera = world_from_base.to_rigid() * description.camera.mount.base_from_camera()
    return np.asarray(world_from_camera.inv().apply(point))


def _relative_sds(
    known: Sequence[Observation],
    world_from_base: PlanarPose,
    step: PlanarStep,
    points_in_world: Sequence[FloatArray],
    description: RobotDescription,
) -> list[float]:
    poses = [world_from_base.after(PlanarStep(step.turn, advance)) for advance in (0.0, step.advance)]
    found = []
    for point in points_in_world:
        views = [*known, *(_view_of(pose, point, description) for pose in poses)]
        bound = position_bound(views, point, odometry_noise(description), mount_noise(description))
        if bound is None:
            return []
        found.append(bound.relative_sd)
    return found


def _view_of(pose: PlanarPose, point: FloatArray, description: RobotDescription) -> Observation:
    pixel = description.camera.model().project(_in_camera(pose, point, description)[None]).pixels[0]
    sighting = Sighting(0, 0, Pixel(*map(float, pixel)), VIEW_SIGMA, 1.0, pose)
    return observation_of(sighting, description)
