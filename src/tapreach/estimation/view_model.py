"""How the unknowns make the pixels: prediction and analytic derivative (docs/estimation.md, 2 to 4).

The unknowns are one vector x = (a, b, rho, z): the target's bearing (a, b) = (X/Z, Y/Z) and inverse depth
rho = 1/Z in the first camera, and the independent unit normals z behind the errors of the camera poses. With
homogeneous points nothing is singular at infinity (rho = 0). Source of the parametrisation: Montiel, Civera
and Davison, "Unified inverse depth parametrization for monocular SLAM" (RSS 2006).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from tapreach.estimation.motion_prior import CameraErrors
from tapreach.estimation.observation import Observation
from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.lens import distortion_jacobian
from tapreach.geometry.pose import right_jacobians, skew


@dataclass(frozen=True)
class Prediction:
    """Homogeneous target (n, 3) in each camera, and its derivative by x (n, 3, 3 + k)."""

    points: FloatArray
    by_unknowns: FloatArray


@dataclass(frozen=True)
class ViewModel:
    """n views of one target, stacked.

    rotations (n, 3, 3), positions (n, 3): of each camera in the first. measured (n, 2): sighted (x/z, y/z).
    weights (n, 2, 2): from an error in (x/z, y/z) to pixels over sigma. sigmas (n,) [px].
    is_used (n,): False for views that were left out; they are predicted and weigh nothing.
    """

    rotations: FloatArray
    positions: FloatArray
    measured: FloatArray
    weights: FloatArray
    sigmas: FloatArray
    errors: CameraErrors
    is_used: npt.NDArray[np.bool_]

    @property
    def views(self) -> int:
        """Number of views n."""
        return len(self.measured)

    @property
    def unknowns(self) -> int:
        """Length of x, 3 + k."""
        return 3 + int(self.errors.by_normal.shape[2])

    @cached_property
    def baseline(self) -> float:
        """The greatest distance between two of the cameras used [m]."""
        used = self.positions[self.is_used]
        between = used[:, None, :] - used[None, :, :]
        return float(np.sqrt(np.max(np.sum(between * between, axis=2))))

    def at(self, inverse_depth: float) -> FloatArray:
        """Return x for a target on the ray of the first view used, and poses without errors."""
        view = int(np.argmax(self.is_used))
        in_first = self.rotations[view] @ [*self.measured[view], 1.0] + inverse_depth * self.positions[view]
        x = np.zeros(self.unknowns)
        x[:3] = [in_first[0], in_first[1], inverse_depth] / np.where(in_first[2] > 1e-9, in_first[2], 1e-9)
        return x

    def predict(self, x: FloatArray) -> Prediction:
        """Return equations (3) to (5) and their derivatives."""
        bearing, rho = np.array([x[0], x[1], 1.0]), float(x[2])
        if self.unknowns == 3:
            return self._predict_exact(bearing, rho)
        errors = self.errors.by_normal @ x[3:]
        shifts, turns = errors[:, :3], errors[:, 3:]
        forth, back = Rotation.from_rotvec(turns[0]).as_matrix(), Rotation.from_rotvec(-turns).as_matrix()
        turned = forth @ bearing
        arrived = turned + rho * shifts[0]
        into_view = np.swapaxes(self.rotations, 1, 2)
        points = back @ (into_view @ (arrived - rho * self.positions)[:, :, None] - rho * shifts[:, :, None])
        points = points[:, :, 0]
        onward = back @ into_view
        by_x = np.empty((self.views, 3, self.unknowns))
        by_x[:, :, :2] = onward @ forth[:, :2]
        offset = (shifts[0] - self.positions)[:, :, None]
        by_x[:, :, 2] = (onward @ offset - back @ shifts[:, :, None])[:, :, 0]
        slopes = right_jacobians(turns)
        by_x[:, :, 3:] = -rho * (back @ self.errors.by_normal[:, :3])
        by_x[:, :, 3:] += (skew(points) @ slopes) @ self.errors.by_normal[:, 3:]
        first = self.errors.by_normal[0]
        by_first = rho * first[:3] - forth @ skew(bearing) @ slopes[0] @ first[3:]
        by_x[:, :, 3:] += onward @ by_first
        return Prediction(points, by_x)

    def _predict_exact(self, bearing: FloatArray, rho: float) -> Prediction:
        into_view = np.swapaxes(self.rotations, 1, 2)
        points = (into_view @ (bearing - rho * self.positions)[:, :, None])[:, :, 0]
        by_x = np.empty((self.views, 3, 3))
        by_x[:, :, :2] = into_view[:, :, :2]
        by_x[:, :, 2] = -(into_view @ self.positions[:, :, None])[:, :, 0]
        return Prediction(points, by_x)

    def costs_without_pose_errors(self, starts: FloatArray) -> FloatArray:
        """Return the squared residuals over sigma (m,) of (a, b, rho) (m, 3); infinite behind a view used."""
        bearings = np.concatenate([starts[:, :2], np.ones((len(starts), 1))], axis=1)
        ways = bearings[:, None, :] - starts[:, 2, None, None] * self.positions
        points = np.einsum("nji,mnj->mni", self.rotations, ways)[:, self.is_used]
        in_front = np.all(points[:, :, 2] > 1e-9, axis=1)
        projected = points[:, :, :2] / np.where(points[:, :, 2:] > 1e-9, points[:, :, 2:], 1.0)
        errors = projected - self.measured[self.is_used]
        residuals = np.einsum("nij,mnj->mni", self.weights[self.is_used], errors)
        return np.where(in_front, np.sum(residuals**2, axis=(1, 2)), np.inf)

    def is_in_front(self, prediction: Prediction) -> bool:
        """Tell whether every view used has the target's direction in front of it."""
        return bool(np.all(prediction.points[self.is_used, 2] > 1e-9))

    def whitened(self, prediction: Prediction) -> tuple[FloatArray, FloatArray]:
        """Return residuals over sigma (n, 2) and their derivative by x (n, 2, 3 + k), 0 where left out."""
        depth = np.where(self.is_used, prediction.points[:, 2], 1.0)[:, None]
        projected = prediction.points[:, :2] / depth
        weights = self.weights * self.is_used[:, None, None]
        residuals = (weights @ (projected - self.measured)[:, :, None])[:, :, 0]
        sideways = prediction.by_unknowns[:, :2] - projected[:, :, None] * prediction.by_unknowns[:, 2:]
        return residuals, weights @ (sideways / depth[:, :, None])

    def residuals_px(self, prediction: Prediction) -> FloatArray:
        """Return predicted minus observed (n, 2) [px] of all views; infinite where it is behind one."""
        depth = prediction.points[:, 2, None]
        projected = prediction.points[:, :2] / np.where(depth > 1e-9, depth, 1.0)
        residuals = (self.weights @ (projected - self.measured)[:, :, None])[:, :, 0]
        return np.where(depth > 1e-9, residuals * self.sigmas[:, None], np.inf)

    def without(self, view: int) -> "ViewModel":
        """Return the same model with one more view left out."""
        is_used = self.is_used.copy()
        is_used[view] = False
        return replace(self, is_used=is_used)


def view_model(observations: Sequence[Observation], errors: CameraErrors) -> ViewModel:
    """Return the stacked model of the observations, the first one as reference."""
    first_from_world = observations[0].world_from_camera.inv()
    poses = [first_from_world * view.world_from_camera for view in observations]
    sigmas = np.array([view.pixel_sigma for view in observations])
    measured = np.empty((len(observations), 2))
    weights = np.empty((len(observations), 2, 2))
    for camera in {view.camera for view in observations}:
        rows = [i for i, view in enumerate(observations) if view.camera == camera]
        measured[rows] = camera.normalise([observations[i].pixel.to_array() for i in rows])
        weights[rows] = pixel_weights(camera, measured[rows]) / sigmas[rows, None, None]
    return ViewModel(
        np.stack([pose.rotation.as_matrix() for pose in poses]),
        np.stack([np.asarray(pose.translation) for pose in poses]),
        measured,
        weights,
        sigmas,
        errors,
        np.ones(len(observations), dtype=bool),
    )


def pixel_weights(camera: Camera, normalised: FloatArray) -> FloatArray:
    """Return d pixel / d (x/z, y/z) at (n, 2): (n, 2, 2) [px]."""
    slopes = distortion_jacobian(normalised, camera.distortion)
    return np.asarray(np.array([camera.fx, camera.fy])[:, None] * slopes)
