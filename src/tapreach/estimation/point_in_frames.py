"""From bearing and inverse depth to uncertain points in world and base (docs/estimation.md, 10)."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from tapreach.estimation.observation import Observation
from tapreach.estimation.view_model import ViewModel
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pose import right_jacobians, skew


@dataclass(frozen=True)
class UncertainPoint:
    """A point (3,) [m] and its covariance (3, 3) [m²], first order."""

    point: FloatArray
    covariance: FloatArray


def point_in_world(
    model: ViewModel, first: Observation, x: FloatArray, covariance: FloatArray
) -> UncertainPoint:
    """Return the target in the frame of the poses given, held fixed by the first of them."""
    errors = model.errors.by_normal[0]
    shift, turn = np.split(errors @ x[3:], 2)
    forth = Rotation.from_rotvec(turn).as_matrix()
    bearing = np.array([x[0], x[1], 1.0])
    homogeneous = forth @ bearing + x[2] * shift
    by_x = np.empty((3, model.unknowns))
    by_x[:, :2], by_x[:, 2] = forth[:, :2], shift
    by_x[:, 3:] = x[2] * errors[:3] - forth @ skew(bearing) @ right_jacobians(turn[None])[0] @ errors[3:]
    point, by_x = _dehomogenised(homogeneous, by_x, float(x[2]))
    rotation = first.world_from_camera.rotation.as_matrix()
    moved = rotation @ by_x
    return UncertainPoint(
        np.asarray(first.world_from_camera.apply(point)), np.asarray(moved @ covariance @ moved.T)
    )


def point_in_last_base(
    model: ViewModel, last: Observation, x: FloatArray, covariance: FloatArray
) -> UncertainPoint:
    """Return the target as seen from where the base is at the last observation, which is what to drive by."""
    prediction = model.predict(x)
    point, by_x = _dehomogenised(prediction.points[-1], prediction.by_unknowns[-1], float(x[2]))
    # The mount's own error moves the camera on the base once more.
    by_x[:, 3:] += model.errors.by_mount[:3] - skew(point) @ model.errors.by_mount[3:]
    rotation = last.base_from_camera.rotation.as_matrix()
    moved = rotation @ by_x
    shift, turn = np.split(model.errors.by_mount @ x[3:], 2)
    on_mount = Rotation.from_rotvec(turn).apply(point) + shift
    return UncertainPoint(
        np.asarray(last.base_from_camera.apply(on_mount)), np.asarray(moved @ covariance @ moved.T)
    )


def _dehomogenised(
    homogeneous: FloatArray, by_x: FloatArray, inverse_depth: float
) -> tuple[FloatArray, FloatArray]:
    point = homogeneous / inverse_depth
    by_point = by_x / inverse_depth
    by_point[:, 2] -= point / inverse_depth
    return point, by_point
