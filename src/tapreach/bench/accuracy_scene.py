"""The simulated world of the accuracy bench: a camera on a base, in plain numpy, many trials at once.

It shares no code with the estimator: what it says the camera sees is computed independently.
"""

import math

import numpy as np
import numpy.typing as npt

from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import ImageSize

WIDTH, HEIGHT, FOCAL = 640, 480, 600.0
PRINCIPAL = np.array([319.5, 239.5])
LEVER = np.array([0.10, 0.0, 0.15])
"""The camera in the base [m]: 10 cm ahead of the axis it turns about."""
PITCH = math.radians(10.0)
"""Downwards."""

CAMERA = Camera(ImageSize(WIDTH, HEIGHT), FOCAL, FOCAL, float(PRINCIPAL[0]), float(PRINCIPAL[1]))


def camera_axes() -> FloatArray:
    """Return (3, 3): columns are the camera's right, down and forward in the base, pitched down."""
    c, s = math.cos(PITCH), math.sin(PITCH)
    return np.array([[0.0, -s, c], [-1.0, 0.0, 0.0], [0.0, -c, -s]])


def poses_after(turns: FloatArray, advances: FloatArray) -> FloatArray:
    """Return (m, n, 3) x, y [m], heading [rad] of a base that turns and then advances in each of n - 1 steps.

    turns, advances: (m, n - 1). The base starts at the origin.
    """
    start = np.zeros((len(turns), 1))
    headings = np.concatenate([start, np.cumsum(turns, axis=1)], axis=1)
    x = np.concatenate([start, np.cumsum(advances * np.cos(headings[:, 1:]), axis=1)], axis=1)
    y = np.concatenate([start, np.cumsum(advances * np.sin(headings[:, 1:]), axis=1)], axis=1)
    return np.stack([x, y, headings], axis=2)


def points_in_cameras(poses: FloatArray, targets: FloatArray, lever: FloatArray = LEVER) -> FloatArray:
    """Return (m, n, 3): targets (m, 3) in the world, as seen from the camera at each base pose (m, n, 3)."""
    c, s = np.cos(poses[:, :, 2]), np.sin(poses[:, :, 2])
    east, north = targets[:, None, 0] - poses[:, :, 0], targets[:, None, 1] - poses[:, :, 1]
    up = np.broadcast_to(targets[:, None, 2], c.shape)
    in_base = np.stack([c * east + s * north, c * north - s * east, up], axis=2)
    return np.asarray((in_base - lever) @ camera_axes())


def target_at(bearings: FloatArray, depths: FloatArray, lever: FloatArray = LEVER) -> FloatArray:
    """Return (m, 3) in the world: bearings (m, 2) and depths (m,) in the camera of a base at the origin."""
    in_camera = np.concatenate([bearings, np.ones((len(bearings), 1))], axis=1) * depths[:, None]
    return np.asarray(in_camera @ camera_axes().T + lever)


def project(points: FloatArray) -> FloatArray:
    """Return pixels (..., 2) of points (..., 3) in a camera; NaN for those that are not before it."""
    depth = np.where(points[..., 2:] > 1e-6, points[..., 2:], np.nan)
    return np.asarray(FOCAL * points[..., :2] / depth + PRINCIPAL)


def is_in_picture(pixels: FloatArray, margin_px: float = 0.0) -> npt.NDArray[np.bool_]:
    """Tell which pixels (..., 2) lie in the picture and off its border by the margin; NaN does not."""
    least, most = margin_px - 0.5, np.array([WIDTH, HEIGHT]) - 0.5 - margin_px
    return np.asarray(np.all((pixels >= least) & (pixels <= most), axis=-1))


def onto_picture(pixels: FloatArray) -> FloatArray:
    """Return pixels (..., 2) with those beyond the border moved onto it: nobody can tap outside."""
    return np.clip(pixels, -0.5, np.array([WIDTH, HEIGHT]) - 0.5)
