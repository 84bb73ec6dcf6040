"""Places of the claw as a camera sees them: what is unknown of arm and camera, and what follows from it."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.estimation.motion_prior import MountNoise
from tapreach.geometry.arm_kinematics import ArmJoints, ArmKinematics
from tapreach.geometry.camera import Camera
from tapreach.geometry.claw_frame import base_from_gripper
from tapreach.geometry.finite import FloatArray, finite_array, positive
from tapreach.geometry.pose import perturbed, skew

UNKNOWNS = 10
"""Zeros of A, B, C [rad]; the mount's tangent (translation [m], rotation [rad]); the claw's opening [m]."""
_STEP = 1e-6
"""Of the derivatives [rad, m]: small enough for one-sided ones."""


@dataclass(frozen=True)
class ArmNoise:
    """How far an arm may be off, one sigma each: zeros of its servos and play of their gears [rad], its
    claw's opening [m], and the mount of the camera that sees it.
    """

    zero: float
    play: float
    opening: float
    mount: MountNoise

    def __post_init__(self) -> None:
        for name in ("zero", "play", "opening"):
            positive(name, getattr(self, name))
        positive("position_sigma of the mount", self.mount.position_sigma)
        positive("angle_sigma of the mount", self.mount.angle_sigma)

    def prior(self) -> FloatArray:
        """Return one sigma of each unknown (10,): zeros, mount (translation, rotation), opening."""
        mount = [self.mount.position_sigma] * 3 + [self.mount.angle_sigma] * 3
        return np.array([self.zero] * 3 + mount + [self.opening])


@dataclass(frozen=True, eq=False)
class ClawPlace:
    """A place of the claw, seen. in_gripper (3,) [m] with the claw as it was sent; by_opening: how much of an
    error of the opening moves it to the left, −0.5 to 0.5; pixel (2,), sigma of u and of v [px].
    """

    in_gripper: FloatArray
    by_opening: float
    pixel: FloatArray
    sigma: float

    def __post_init__(self) -> None:
        finite_array("in_gripper", self.in_gripper, (3,))
        finite_array("pixel", self.pixel, (2,))
        positive("sigma", self.sigma)


@dataclass(frozen=True, eq=False)
class ClawView:
    """What was seen of the claw while the servos were sent to `sent`."""

    sent: ArmJoints
    places: tuple[ClawPlace, ...]


@dataclass(frozen=True, eq=False)
class SightModel:
    """An arm before a camera, by their files; `unknowns` (10,) say how far they are off."""

    arm: ArmKinematics
    base_from_camera: RigidTransform

    def in_camera(
        self, unknowns: FloatArray, sent: ArmJoints, points: FloatArray, by_opening: FloatArray
    ) -> FloatArray:
        """Return points (n, 3) of the claw in the camera's frame; by_opening (n,) as ClawPlace has it."""
        a, b, c = (float(angle) for angle in unknowns[:3])
        joints = ArmJoints(sent.rotation + a, sent.shoulder + b, sent.elbow + c)
        in_gripper = points + np.outer(by_opening * unknowns[9], (0.0, 1.0, 0.0))
        in_base = base_from_gripper(self.arm, joints).apply(in_gripper)
        return np.asarray(perturbed(self.base_from_camera, unknowns[3:9]).inv().apply(in_base))

    def by_unknowns(
        self, unknowns: FloatArray, sent: ArmJoints, points: FloatArray, by_opening: FloatArray
    ) -> FloatArray:
        """Return d in_camera / d unknowns, (n, 3, 10)."""
        here = self.in_camera(unknowns, sent, points, by_opening)
        result = np.zeros((len(points), 3, UNKNOWNS))
        for index in (0, 1, 2, 9):
            step = _STEP * np.eye(UNKNOWNS)[index]
            there = self.in_camera(unknowns + step, sent, points, by_opening)
            result[:, :, index] = (there - here) / _STEP
        # A motion of the camera in its own frame moves what it sees the other way.
        result[:, :, 3:6] = -np.eye(3)
        result[:, :, 6:9] = skew(here)
        return result

    def linearised(
        self, view: ClawView, unknowns: FloatArray, camera: Camera
    ) -> tuple[FloatArray, FloatArray] | None:
        """Return seen less expected (n, 2) [px] and d expected / d unknowns (n, 2, 10).

        None when a place falls behind the camera.
        """
        points = np.array([place.in_gripper for place in view.places])
        by_opening = np.array([place.by_opening for place in view.places])
        in_camera = self.in_camera(unknowns, view.sent, points, by_opening)
        projection, by_point = camera.project_with_jacobian(in_camera)
        if not projection.is_valid.all():
            return None
        seen = np.array([place.pixel for place in view.places])
        jacobian = by_point @ self.by_unknowns(unknowns, view.sent, points, by_opening)
        return seen - projection.pixels, jacobian
