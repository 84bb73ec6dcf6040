"""How the robot really turned, by what stands still in two pictures; the wheels help and are checked.

The most probable relative pose given pairs of pixels and what the wheels say (camera_step): squared Sampson
distances over their noise, plus squared unit normals of the wheels' and the mount's errors. The length of the
translation does not enter: it stays with the wheels. Things that move on their own are found by a robust loss
(Cauchy), then left out.
"""

import math
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import RigidTransform, Rotation

from tapreach.estimation.background_solver import Fit, fit_step
from tapreach.estimation.camera_step import CameraStep
from tapreach.estimation.epipolar import PointPairs, point_pairs
from tapreach.estimation.step_knowledge import (
    HEADING,
    KNOWN,
    NOTHING_SEEN,
    PITCH,
    StepKnowledge,
    loosened,
    step_knowledge,
)
from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.gaussian import chi2_limit

_FEWEST = 15
_LEAST_SHARE = 0.5
_SURE_SHARE = 0.6
_MOST_NOISE_PX = 3.0
"""What leaves more than this does not agree, it is only scattered."""
SWAY = 0.0005
"""What all pairs of two pictures have wrong in common, as a turn of the camera, one sigma [rad]. Measured in
rendered rooms; a quarter of a pixel at 640 px.
"""
_SWAY_OF_WAY = 10.0
"""The direction of travel is seen so many times worse than the turn: what of it lies in the mount's pitch is
wrong in common by as much.
"""
_POOR = 2.0
"""A turn seen with more than so many times the wheels' own error is not worth having."""
_SURPRISE = 0.9999


class BackgroundStatus(StrEnum):
    """What the background gave."""

    CORRECTED = "corrected"
    SLIPPED = "slipped"
    POOR = "poor"


@dataclass(frozen=True, eq=False)
class BackgroundRotation:
    """What two pictures say of a step.

    first_from_second, covariance (6, 6): the step of the camera with everything known, tangent order
    (translation, rotation), right perturbation; for POOR what the wheels said.
    excess_turn [rad], turn_sd: what the pictures alone say of the turn to the left, in excess of the wheels'
    (the wheels' own knowledge of the turn taken out again, so that it can be combined with odometry as an
    independent measurement); 0 and infinite for POOR. is_used: (n,) which pairs agree. noise_px: of a pixel.
    knowledge: all that the pictures alone say, of the base's way and of the camera's mount.
    """

    status: BackgroundStatus
    reason: str
    first_from_second: RigidTransform
    covariance: FloatArray
    excess_turn: float
    turn_sd: float
    is_used: npt.NDArray[np.bool_]
    noise_px: float
    knowledge: StepKnowledge = NOTHING_SEEN


def rotation_from_background(
    first_px: FloatArray, second_px: FloatArray, camera: Camera, step: CameraStep, sway: float = SWAY
) -> BackgroundRotation:
    """Return how the camera turned between two pictures, from pixels (n, 2) of the same things in both.

    SLIPPED: the pictures agree among themselves and contradict the wheels; the turn is then theirs alone, and
    the distance is not to be trusted. POOR: too few pairs, no agreement, or nothing that tells the turn
    better than twice the wheels' error. sway: one sigma [rad] of what all pairs have wrong in common. Raises
    InputError for arrays that do not match.
    """
    found = _without_sway(point_pairs(first_px, second_px, camera), step)
    return found if found.status is BackgroundStatus.POOR else _swayed(found, step, sway)


def _without_sway(pairs: PointPairs, step: CameraStep) -> BackgroundRotation:
    if len(pairs) < _FEWEST:
        return _poor(f"only {len(pairs)} places of the background were followed; {_FEWEST} are needed", step)
    fit = fit_step(pairs, step)
    if _agrees(fit, pairs) and not _is_surprising(fit):
        return _judged(fit, step)
    free = fit_step(pairs, step.with_slip())
    if _agrees(free, pairs) and free.is_used.mean() >= _SURE_SHARE and _is_surprising(fit):
        return _slipped(free, step)
    share = 100.0 * float(free.is_used.mean())
    return _poor(
        f"the background does not move as one: {share:.0f} % of it agree, to {free.noise_px:.1f} px", step
    )


def _agrees(fit: Fit, pairs: PointPairs) -> bool:
    enough = max(_FEWEST, math.ceil(_LEAST_SHARE * len(pairs)))
    return int(fit.is_used.sum()) >= enough and fit.noise_px < _MOST_NOISE_PX


def _is_surprising(fit: Fit) -> bool:
    """Tell whether the errors found are larger than the wheels' noise allows, in what the pictures know."""
    known, directions = np.linalg.eigh(np.eye(len(fit.normals)) - fit.covariance)
    is_known = known > 0.1
    if not np.any(is_known):
        return False
    found = (directions.T @ fit.normals)[is_known]
    return float(np.sum(found**2 / known[is_known])) > chi2_limit(_SURPRISE, int(is_known.sum()))


def _judged(fit: Fit, step: CameraStep) -> BackgroundRotation:
    excess, turn_sd = _turn_of_pictures(fit, step)
    if turn_sd > _POOR * step.turn_sd:
        return _poor("the background shows the turn less well than the wheels", step)
    reason = f"the turn is seen to {math.degrees(turn_sd):.2g}° by {int(fit.is_used.sum())} places"
    return _result(BackgroundStatus.CORRECTED, reason, fit, step, excess, turn_sd)


def _slipped(fit: Fit, step: CameraStep) -> BackgroundRotation:
    free = step.with_slip()
    excess, turn_sd = _turn_of_pictures(fit, free)
    if turn_sd > free.turn_sd:
        return _poor("the background contradicts the wheels, but does not show the turn", step)
    reason = f"the wheels slipped: the pictures turned {math.degrees(excess):+.2f}° beyond them"
    return _result(BackgroundStatus.SLIPPED, reason, fit, free, excess, turn_sd)


def _turn_of_pictures(fit: Fit, step: CameraStep) -> tuple[float, float]:
    """Return the turn in excess of the nominal one, and its sd, with the prior of the turn divided out."""
    by_turn = step.turn_axis @ step.by_normal[3:]
    before, after = float(by_turn @ by_turn), float(by_turn @ fit.covariance @ by_turn)
    learnt = 1.0 - after / before if before > 0.0 else 0.0
    if learnt < 1e-6:
        return 0.0, math.inf
    return float(by_turn @ fit.normals) / learnt, math.sqrt(after / learnt)


def _result(
    status: BackgroundStatus, reason: str, fit: Fit, step: CameraStep, excess: float, turn_sd: float
) -> BackgroundRotation:
    rotation, translation = step.moved(fit.normals)
    pose = RigidTransform.from_components(translation, Rotation.from_matrix(rotation))
    covariance = step.by_normal @ fit.covariance @ step.by_normal.T
    has_slipped = status is BackgroundStatus.SLIPPED
    return BackgroundRotation(
        status,
        reason,
        pose,
        covariance,
        excess,
        turn_sd,
        fit.is_used,
        fit.noise_px,
        step_knowledge(fit.normals, fit.covariance, step, has_slipped),
    )


def _swayed(found: BackgroundRotation, step: CameraStep, sway: float) -> BackgroundRotation:
    covariance = found.covariance.copy()
    covariance[3:, 3:] += sway**2 * np.outer(step.turn_axis, step.turn_axis)
    unsure = np.zeros(KNOWN)
    unsure[HEADING], unsure[PITCH] = sway, _SWAY_OF_WAY * sway
    knowledge = loosened(found.knowledge, unsure)
    turn_sd = math.hypot(found.turn_sd, sway)
    return replace(found, covariance=covariance, turn_sd=turn_sd, knowledge=knowledge)


def _poor(reason: str, step: CameraStep) -> BackgroundRotation:
    covariance = step.by_normal @ step.by_normal.T
    nothing = np.zeros(0, dtype=np.bool_)
    return BackgroundRotation(
        BackgroundStatus.POOR, reason, step.first_from_second, covariance, 0.0, math.inf, nothing, 0.0
    )
