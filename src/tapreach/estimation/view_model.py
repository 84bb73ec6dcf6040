"""How the unknowns make the pixels: prediction and analytic derivative (docs/estimation.md, 2 to 4).

The unknowns are one vector x = (a, b, rho, z): the target's bearing (a, b) = (X/Z, Y/Z) and inverse depth
rho = 1/Z in the first camera, and the independent unit normals z behind the errors of the camera poses. With
homogeneous points nothing is singular at infinity (rho = 0). Source of the parametrisation: Montiel, Civera
and Davison, "Unified inverse depth parametrization for monocular SLAM" (RSS 2006).

Everything is computed for m vectors x at once, as plain arrays: several starts, or a grid of ranges.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.linalg.lapack import dposv

from tapreach.estimation.camera_matrices import CameraMatrices, camera_matrices, homogeneous_points
from tapreach.estimation.linearised import Linearised
from tapreach.estimation.motion_prior import CameraErrors
from tapreach.estimation.observation import Observation
from tapreach.estimation.tap_noise import whitening
from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.lens import NO_DISTORTION, distortion_jacobian

_TARGET_COLUMNS = np.array([0, 1, 3])  # of a projection matrix: those of a, b and rho
_IN_FRONT = 1e-9  # least third homogeneous coordinate of a target before a camera
_SEEN = 0.01  # and least share of its distance from the axis: nearer to the camera's plane no lens sees it
# A point @ _ROOM is what it has beyond that share to the right, left, below and above; short of it slopes
# overflow.
_ROOM = np.array([[-_SEEN, _SEEN, 0.0, 0.0], [0.0, 0.0, -_SEEN, _SEEN], [1.0, 1.0, 1.0, 1.0]])
_ONTO_PLANE, _DEPTH = np.eye(2, 3), np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class ViewModel:
    """n views of one target, stacked.

    nominal (n, 3, 4): projection from the first camera's homogeneous points into each camera, poses exact.
    measured (n, 2): sighted (x/z, y/z). weights (n, 2, 2): from an error in (x/z, y/z) to pixels over sigma.
    sigmas (n,) [px]. is_used (n,): False for views that were left out; they are predicted and weigh nothing.
    correlation: of each tap's error with that of the tap before.
    """

    nominal: FloatArray
    measured: FloatArray
    weights: FloatArray
    sigmas: FloatArray
    errors: CameraErrors
    is_used: npt.NDArray[np.bool_]
    correlation: float = 0.0

    @property
    def views(self) -> int:
        """Number of views n."""
        return len(self.measured)

    @cached_property
    def used(self) -> int:
        """Number of views used."""
        return int(np.count_nonzero(self.is_used))

    @property
    def left_out(self) -> tuple[int, ...]:
        """Numbers of the views not used."""
        return tuple(np.flatnonzero(~self.is_used).tolist()) if self.used < self.views else ()

    @property
    def unknowns(self) -> int:
        """Length of x, 3 + k."""
        return 3 + int(self.errors.by_normal.shape[2])

    @cached_property
    def positions(self) -> FloatArray:
        """Position of each camera in the first (n, 3) [m]."""
        return np.asarray(-(self.nominal[:, :, :3].mT @ self.nominal[:, :, 3:])[:, :, 0])

    @cached_property
    def baseline(self) -> float:
        """The greatest distance between two of the cameras used [m]."""
        used = self.positions if self.used == self.views else self.positions[self.is_used]
        between = used[:, None, :] - used
        return math.sqrt(float(np.einsum("ijk,ijk->ij", between, between).max()))

    def on_ray(self, inverse_depths: FloatArray) -> FloatArray:
        """Return x (m, 3 + k) for targets on the ray of the first view used, and poses without errors."""
        view = int(np.argmax(self.is_used))
        direction = self.nominal[view, :, :3].T @ [*self.measured[view], 1.0]
        in_first = direction + inverse_depths[:, None] * self.positions[view]
        x = np.zeros((len(inverse_depths), self.unknowns))
        x[:, :2], x[:, 2] = in_first[:, :2], inverse_depths
        x[:, :3] /= np.maximum(in_first[:, 2:], 1e-9)
        return x

    def cameras(self, x: FloatArray) -> CameraMatrices:
        """Return the cameras that the pose errors in x (m, 3 + k) make of the nominal ones."""
        return camera_matrices(self.nominal, self.errors, x[:, 3:])

    def linearised(self, x: FloatArray) -> Linearised:
        """Return residuals over sigma at x (m, 3 + k) and their derivatives, 0 for views left out."""
        cameras = self.cameras(x)
        by_targets = cameras.matrices.take(_TARGET_COLUMNS, axis=-1)
        points = (by_targets @ x[:, None, :3, None])[..., 0] + cameras.matrices[..., 2]
        is_in_front, depths = self._in_front(points)
        projected = points[..., :2] / depths[..., None]
        weights = self._used_weights
        slopes = weights @ (_ONTO_PLANE - projected[..., None] * _DEPTH) / depths[..., None, None]
        residuals = (weights @ (projected - self.measured)[..., None])[..., 0]
        by_target = slopes @ by_targets
        by_errors = cameras.by_normals(slopes, points, x[:, :3])
        if self.errors.by_pixel is not None:
            by_picture = self.errors.by_pixel * (self.is_used / self.sigmas)[:, None, None]
            residuals += (by_picture @ x[:, None, 3:, None])[..., 0]
            by_errors += by_picture
        count, rows = len(x), 2 * self.views
        return Linearised(
            x,
            self._whitened(residuals.reshape(count, rows)),
            self._whitened(by_target.reshape(count, rows, 3)),
            self._whitened(by_errors.reshape(count, rows, -1)),
            is_in_front,
        )

    @cached_property
    def whitening(self) -> FloatArray | None:
        """W (2n, 2n) that makes the taps' errors independent; None where they are already."""
        if self.correlation == 0.0:
            return None
        return np.asarray(np.kron(whitening(self.correlation, self.is_used), np.eye(2)), dtype=np.float64)

    def _whitened(self, rows: FloatArray) -> FloatArray:
        """Return (m, 2n) or (m, 2n, c) with errors made independent."""
        if self.correlation == 0.0 or self.whitening is None:
            return rows
        return np.asarray(rows @ self.whitening.T if rows.ndim == 2 else self.whitening @ rows)

    def _in_front(self, points: FloatArray) -> tuple[npt.NDArray[np.bool_], FloatArray]:
        """Return whether all views used have the target before them (m,), and depths (m, n) to divide by.

        points (m, n, 3): homogeneous, the targets in the cameras.
        """
        room, depths = points @ _ROOM, points[..., 2]
        if room.min() > _IN_FRONT:
            return np.ones(len(points), dtype=bool), depths
        is_before = room.min(axis=-1) > _IN_FRONT
        is_in_front = np.all(is_before | ~self.is_used, axis=1)
        return is_in_front, np.where(is_before & self.is_used, depths, 1.0)

    def costs_without_pose_errors(self, starts: FloatArray) -> FloatArray:
        """Return the squared residuals over sigma (m,) of (a, b, rho) (m, 3); infinite behind a view used."""
        homogeneous = homogeneous_points(starts)
        points = (self.nominal @ homogeneous[:, None, :, None])[..., 0]
        is_in_front, depths = self._in_front(points)
        projected = points[..., :2] / depths[..., None]
        residuals = self._used_weights @ (projected - self.measured)[..., None]
        white = self._whitened(residuals.reshape(len(starts), -1))
        return np.where(is_in_front, np.sum(white * white, axis=1), np.inf)

    def residuals_px(self, x: FloatArray) -> FloatArray:
        """Return predicted minus observed (n, 2) [px] at x (3 + k,); infinite where it is behind a view."""
        points = self.cameras(x[None]).matrices[0] @ [x[0], x[1], 1.0, x[2]]
        depth = points[:, 2, None]
        projected = points[:, :2] / np.where(depth > _IN_FRONT, depth, 1.0)
        residuals = (self.weights @ (projected - self.measured)[:, :, None])[:, :, 0] * self.sigmas[:, None]
        if self.errors.by_pixel is not None:
            residuals += self.errors.by_pixel @ x[3:]
        return np.where(depth > _IN_FRONT, residuals, np.inf)

    def without(self, view: int) -> "ViewModel":
        """Return the same model with one more view left out."""
        is_used = self.is_used.copy()
        is_used[view] = False
        return replace(self, is_used=is_used)

    def depths(self, target: FloatArray) -> FloatArray:
        """Return (n,): depths of the target (a, b, rho) in the cameras, poses without errors, times rho."""
        a, b, rho = target
        return np.asarray(self.nominal[:, 2] @ np.array([a, b, 1.0, rho]))

    def triangulated(self) -> FloatArray | None:
        """Return x (3 + k,) where all lines of sight nearly meet, poses without errors; None where singular.

        Linear least squares of (x − measured · z) in pixels: exact for exact sightings. Source: Hartley and
        Zisserman, Multiple View Geometry, 12.2.
        """
        ahead = self.nominal[:, 2:]
        rows = (self._used_weights @ (self.nominal[:, :2] - self.measured[:, :, None] * ahead)).reshape(-1, 4)
        products = rows.T @ rows
        known = products.take(_TARGET_COLUMNS, axis=0)
        _, solved, failed = dposv(known.take(_TARGET_COLUMNS, axis=1), -known[:, 2])
        if failed:
            return None
        return np.concatenate([solved, np.zeros(self.unknowns - 3)])

    @cached_property
    def _used_weights(self) -> FloatArray:
        return self.weights if self.used == self.views else self.weights * self.is_used[:, None, None]


def view_model(
    observations: Sequence[Observation], errors: CameraErrors, correlation: float = 0.0
) -> ViewModel:
    """Return the stacked model of the observations, the first one as reference."""
    measured, weights, sigmas = sighted(observations)
    used = np.ones(len(observations), dtype=bool)
    ways = camera_ways(observations, np.zeros((0, 4, 4)))
    return ViewModel(ways, measured, weights, sigmas, errors, used, correlation)


def sighted(observations: Sequence[Observation]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return what was measured (n, 2), its weights (n, 2, 2) and sigmas (n,) as ViewModel keeps them."""
    sigmas = np.array([view.pixel_sigma for view in observations])
    pixels = np.array([(view.pixel.u, view.pixel.v) for view in observations])
    first = observations[0].camera
    if all(view.camera is first for view in observations):
        measured = first.normalise(pixels)
        return measured, pixel_weights(first, measured) / sigmas[:, None, None], sigmas
    measured = np.empty((len(observations), 2))
    weights = np.empty((len(observations), 2, 2))
    cameras = [view.camera for view in observations]
    for camera in set(cameras):
        rows = [i for i, each in enumerate(cameras) if each is camera or each == camera]
        measured[rows] = camera.normalise(pixels[rows])
        weights[rows] = pixel_weights(camera, measured[rows]) / sigmas[rows, None, None]
    return measured, weights, sigmas


def camera_ways(observations: Sequence[Observation], further: FloatArray) -> FloatArray:
    """Return (n + c, 3, 4): the way from points of the first camera to points of each, as given.

    further (c, 4, 4): world_from_camera of further cameras.
    """
    world_from_camera = np.array([view.base_matrix for view in observations]) @ _mounts(observations)
    if len(further):
        world_from_camera = np.concatenate([world_from_camera, further])
    rotations, positions = world_from_camera[:, :3, :3].mT, world_from_camera[:, :3, 3]
    apart = np.empty((len(positions), 3, 4))
    apart[:, :, :3], apart[:, :, 3] = world_from_camera[0, :3, :3], positions[0] - positions
    return np.asarray(rotations @ apart)


def _mounts(observations: Sequence[Observation]) -> FloatArray:
    """Return the matrix (4, 4) of the one mount that all views share, or all of them (n, 4, 4)."""
    first = observations[0]
    if all(view.base_from_camera is first.base_from_camera for view in observations):
        return first.mount_matrix
    return np.array([view.mount_matrix for view in observations])


def pixel_weights(camera: Camera, normalised: FloatArray) -> FloatArray:
    """Return d pixel / d (x/z, y/z) at (n, 2): (n, 2, 2) [px]."""
    if camera.distortion == NO_DISTORTION:
        weights = np.zeros((len(normalised), 2, 2))
        weights[:, 0, 0], weights[:, 1, 1] = camera.fx, camera.fy
        return weights
    slopes = distortion_jacobian(normalised, camera.distortion)
    return np.asarray(np.array([camera.fx, camera.fy])[:, None] * slopes)
