"""A pinhole camera with lens distortion: points to pixels, and pixels to directions."""

import math
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray, finite, finite_array, positive
from tapreach.geometry.lens import (
    NO_DISTORTION,
    Distortion,
    distort,
    distortion_jacobian,
    undistort,
    unfolded_radius,
)
from tapreach.geometry.pixel import ImageSize


@dataclass(frozen=True)
class Projection:
    """Where points fall in the picture.

    pixels: (n, 2) as (u, v) [px]; always finite. A row that is not valid holds the principal point.
    is_valid: (n,) bool, in front of the camera and inside the part of the lens model that is one to one.
    is_inside: (n,) bool, valid and on the picture.
    """

    pixels: FloatArray
    is_valid: npt.NDArray[np.bool_]
    is_inside: npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Camera:
    """Intrinsics [px] and lens (k1, k2, p1, p2, k3) of OpenCV's model, for pictures of `size`.

    Raises InputError for numbers that are not finite and focal lengths that are not above zero.
    """

    size: ImageSize
    fx: float
    fy: float
    cx: float
    cy: float
    distortion: Distortion = NO_DISTORTION
    _unfolded_radius: float = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        for name in ("fx", "fy"):
            object.__setattr__(self, name, positive(f"camera {name}", getattr(self, name)))
        for name in ("cx", "cy"):
            object.__setattr__(self, name, finite(f"camera {name}", getattr(self, name)))
        k1, k2, p1, p2, k3 = (float(k) for k in finite_array("camera distortion", self.distortion, (5,)))
        object.__setattr__(self, "distortion", (k1, k2, p1, p2, k3))
        object.__setattr__(self, "_unfolded_radius", unfolded_radius(self.distortion))

    @classmethod
    def from_fov(cls, size: ImageSize, horizontal_fov: float) -> "Camera":
        """Return a camera without distortion, square pixels, axis in the middle; fov [rad] in (0, pi)."""
        if not 0.0 < finite("horizontal_fov", horizontal_fov) < math.pi:
            raise InputError(f"horizontal_fov is {horizontal_fov} rad; it must lie between 0 and pi")
        focal = size.width / 2.0 / math.tan(horizontal_fov / 2.0)
        return cls(size, focal, focal, (size.width - 1) / 2.0, (size.height - 1) / 2.0)

    def scaled(self, size: ImageSize) -> "Camera":
        """Return the same camera for its pictures resized to `size`; pixel centres map to pixel centres."""
        across, down = size.width / self.size.width, size.height / self.size.height
        return Camera(
            size,
            self.fx * across,
            self.fy * down,
            (self.cx + 0.5) * across - 0.5,
            (self.cy + 0.5) * down - 0.5,
            self.distortion,
        )

    def matrix(self) -> FloatArray:
        """Return the intrinsic matrix K, (3, 3)."""
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])

    def project(self, points_in_camera: npt.ArrayLike) -> Projection:
        """Return where points (n, 3) [m] in the camera frame fall in the picture."""
        points = finite_array("points_in_camera", points_in_camera, (None, 3))
        normalised, is_valid = self._normalise(points)
        pixels = self._to_pixels(distort(normalised, self.distortion))
        return Projection(pixels, is_valid, is_valid & self._is_on_picture(pixels))

    def project_with_jacobian(self, points_in_camera: npt.ArrayLike) -> tuple[Projection, FloatArray]:
        """Return the projection of points (n, 3) and d pixel / d point (n, 2, 3) [px/m].

        The derivative is zero in rows that are not valid.
        """
        points = finite_array("points_in_camera", points_in_camera, (None, 3))
        normalised, is_valid = self._normalise(points)
        projection = self.project(points)
        depth = np.where(is_valid, points[:, 2], 1.0)
        by_point = np.zeros((len(points), 2, 3))
        by_point[:, 0, 0] = by_point[:, 1, 1] = 1.0 / depth
        by_point[:, :, 2] = -normalised / depth[:, None]
        focal = np.array([self.fx, self.fy])[None, :, None]
        jacobian = focal * (distortion_jacobian(normalised, self.distortion) @ by_point)
        jacobian[~is_valid] = 0.0
        return projection, jacobian

    def normalise(self, pixels: npt.ArrayLike) -> FloatArray:
        """Return (x/z, y/z) (n, 2) of the rays through `pixels` (n, 2), lens distortion removed.

        Raises InputError for a pixel that the lens model cannot have imaged.
        """
        given = finite_array("pixels", pixels, (None, 2))
        distorted = np.asarray((given - [self.cx, self.cy]) / [self.fx, self.fy])
        if self.distortion == NO_DISTORTION:
            return distorted
        ideal, found = undistort(distorted, self.distortion)
        if not np.all(found):
            u, v = given[int(np.argmin(found))]
            raise InputError(
                f"pixel ({u:.1f}, {v:.1f}) has no ray under the lens model {self.distortion}; "
                f"it must lie in the part of the picture that the calibration covers"
            )
        return ideal

    def unproject(self, pixels: npt.ArrayLike) -> FloatArray:
        """Return unit directions (n, 3) through `pixels` (n, 2), camera frame; raises as `normalise`."""
        ideal = self.normalise(pixels)
        directions = np.concatenate([ideal, np.ones((len(ideal), 1))], axis=1)
        return np.asarray(directions / np.linalg.norm(directions, axis=1, keepdims=True))

    def _normalise(self, points: FloatArray) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
        depth = points[:, 2]
        # Testing against the length keeps x/z finite for points beside the camera.
        in_front = depth > 1e-9 * np.linalg.norm(points, axis=1)
        normalised = points[:, :2] / np.where(in_front, depth, 1.0)[:, None]
        is_valid = in_front & (np.linalg.norm(normalised, axis=1) < self._unfolded_radius)
        return np.where(is_valid[:, None], normalised, 0.0), is_valid

    def _to_pixels(self, distorted: FloatArray) -> FloatArray:
        return np.asarray(distorted * [self.fx, self.fy] + np.array([self.cx, self.cy]))

    def _is_on_picture(self, pixels: FloatArray) -> npt.NDArray[np.bool_]:
        last = np.array([self.size.width, self.size.height]) - 0.5
        return np.asarray(np.all((pixels >= -0.5) & (pixels <= last), axis=1))
