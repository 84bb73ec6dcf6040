"""In which poses to look at the claw: those the camera sees, chosen for what they tell together."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from tapreach.estimation.claw_sight import ArmNoise, SightModel
from tapreach.geometry.arm_clearance import BodyBox, Capsule, arm_capsules, clearance
from tapreach.geometry.arm_kinematics import ArmJoints
from tapreach.geometry.finite import FloatArray
from tapreach.robot.config import RobotDescription
from tapreach.tasks.fetch.claw_outline import NO_ERRORS, FingerEnd, finger_ends
from tapreach.tasks.fetch.line_of_sight import is_hidden

WIDE_SHARE, NARROW_SHARE = 0.9, 0.45
"""Of the widest opening: what the claw is opened to and closed to while it is looked at. Four fingers equally
far apart could be taken for each other.
"""
FARTHEST_AHEAD, FARTHEST_LEFT = 0.22, 0.09
_AHEAD = np.arange(0.16, FARTHEST_AHEAD + 0.01, 0.02)
_LEFT = np.arange(-FARTHEST_LEFT, FARTHEST_LEFT + 0.001, 0.03)
_UP = np.array([0.05, 0.06, 0.07, 0.085])
"""Where the tips may be: ahead and to the left of the camera, above the floor [m]. Servos that are off by 4
degrees bring them 2 cm lower.
"""
_MARGIN = 0.18
"""From the edge of the picture, as a share of its height: servos 4 degrees off move the claw by so much."""
_LEAST_LOOKING_DOWN = 0.3
"""Sine of the angle at which the fingers are looked at from above; flatter, the hand hides them."""
_LEAST_CLEARANCE = 0.02
_SIGMA_PX = 1.0


@dataclass(frozen=True, eq=False)
class LookingPose:
    """Joints that bring the tips to tip (3,) in the base frame [m]."""

    tip: FloatArray
    joints: ArmJoints


@dataclass(frozen=True, eq=False)
class _Candidate:
    pose: LookingPose
    information: FloatArray
    tip_by_unknowns: FloatArray


def looking_poses(description: RobotDescription, noise: ArmNoise, count: int = 4) -> tuple[LookingPose, ...]:
    """Return up to `count` poses, the highest first; none when the camera sees the claw nowhere.

    Each next one lowers most what is left of the variance of the tips' place in the camera's frame.
    """
    found = [each for tip in _tips(description) if (each := _candidate(tip, description, noise)) is not None]
    information = np.diag(noise.prior() ** -2.0)
    targets = np.array([each.tip_by_unknowns for each in found])
    chosen: list[LookingPose] = []
    for _ in range(min(count, len(found))):
        left = [_variance(information + each.information, targets) for each in found]
        best = found.pop(int(np.argmin(left)))
        information = information + best.information
        chosen.append(best.pose)
    return tuple(sorted(chosen, key=lambda pose: -float(pose.tip[2])))


def openings(description: RobotDescription) -> tuple[float, float]:
    """Return the wide and the narrow opening of the claw [m] between which it is seen to move."""
    widest = description.arm.claw_max
    return WIDE_SHARE * widest, NARROW_SHARE * widest


def _tips(description: RobotDescription) -> list[FloatArray]:
    mount = description.camera.mount
    return [
        np.array([mount.forward + ahead, mount.left + left, up])
        for ahead, left, up in product(_AHEAD, _LEFT, _UP)
    ]


def _candidate(tip: FloatArray, description: RobotDescription, noise: ArmNoise) -> _Candidate | None:
    arm = description.arm.kinematics()
    joints = arm.inverse(tip).joints
    if joints is None:
        return None
    shape, (wide, narrow) = description.arm.shape(), openings(description)
    capsules = arm_capsules(arm.skeleton(joints), wide, shape)
    if clearance(capsules, _boxes(description)).distance < _LEAST_CLEARANCE:
        return None
    model = SightModel(arm, description.camera.mount.base_from_camera())
    ends = [
        end
        for end in finger_ends(shape, wide, narrow).values()
        if _is_seen(end, model, joints, description, capsules)
    ]
    if len(ends) < 3:
        return None
    information = _information(ends, model, joints, description, noise)
    by_unknowns = model.by_unknowns(NO_ERRORS, joints, np.zeros((1, 3)), np.zeros(1))[0]
    return _Candidate(LookingPose(tip, joints), information, by_unknowns)


def _boxes(description: RobotDescription) -> list[BodyBox]:
    return [body.box() for body in description.body]


def _is_seen(
    end: FingerEnd,
    model: SightModel,
    joints: ArmJoints,
    description: RobotDescription,
    capsules: Sequence[Capsule],
) -> bool:
    """Tell whether the end falls into the picture, is looked at from above and not hidden by the arm."""
    camera = description.camera.model()
    in_camera = model.in_camera(NO_ERRORS, joints, end.mark[None], np.zeros(1))
    seen = camera.project(in_camera)
    margin = _MARGIN * camera.size.height
    last = np.array([camera.size.width, camera.size.height]) - 1.0 - margin
    if not seen.is_valid[0] or np.any(seen.pixels[0] < margin) or np.any(seen.pixels[0] > last):
        return False
    eye = np.asarray(model.base_from_camera.translation)
    place = np.asarray(model.base_from_camera.apply(in_camera[0]))
    way = place - eye
    if -way[2] < _LEAST_LOOKING_DOWN * float(np.linalg.norm(way)):
        return False
    return not is_hidden(eye, place[None], [each for each in capsules if each.name == "arm"])[0]


def _information(
    ends: Sequence[FingerEnd],
    model: SightModel,
    joints: ArmJoints,
    description: RobotDescription,
    noise: ArmNoise,
) -> FloatArray:
    """Return what a look at these ends tells of the unknowns, (10, 10)."""
    marks, by_opening = np.array([end.mark for end in ends]), np.array([end.by_opening for end in ends])
    in_camera = model.in_camera(NO_ERRORS, joints, marks, by_opening)
    by_point = description.camera.model().project_with_jacobian(in_camera)[1]
    rows = (by_point @ model.by_unknowns(NO_ERRORS, joints, marks, by_opening)).reshape(2 * len(ends), -1)
    by_play = noise.play * rows[:, :3]
    return np.asarray(rows.T @ np.linalg.solve(_SIGMA_PX**2 * np.eye(len(rows)) + by_play @ by_play.T, rows))


def _variance(information: FloatArray, targets: FloatArray) -> float:
    """Return the mean variance of the tips' place, by targets (n, 3, 10) [m²]."""
    covariance = np.linalg.inv(information)
    return float(np.mean(np.sum((targets @ covariance) * targets, axis=(1, 2))))
