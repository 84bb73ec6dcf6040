"""How well pairs of pixels fit a relative pose of two cameras, with the analytic derivative.

Source: Hartley and Zisserman, Multiple View Geometry, 11.4.3 (Sampson distance). Perturbation of a pose
first_from_second = (R, t): (nu, omega) makes it (R exp(omega), t + R nu).
"""

from dataclasses import dataclass

import numpy as np

from tapreach.errors import InputError
from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pose import skew


@dataclass(frozen=True, eq=False)
class PointPairs:
    """n things seen twice: (x/z, y/z, 1) (n, 3) in the first and in the second camera; focal (2,) [px]."""

    first: FloatArray
    second: FloatArray
    focal: FloatArray

    def __len__(self) -> int:
        return len(self.first)

    def only(self, rows: np.ndarray) -> "PointPairs":
        """Return the pairs of some rows."""
        return PointPairs(self.first[rows], self.second[rows], self.focal)


def point_pairs(first_px: FloatArray, second_px: FloatArray, camera: Camera) -> PointPairs:
    """Return pairs of pixels (n, 2) of one camera with the lens taken out.

    Raises InputError for arrays that do not match, and pixels that the lens cannot have imaged.
    """
    if np.shape(first_px) != np.shape(second_px):
        raise InputError(
            f"pixels have shapes {np.shape(first_px)} and {np.shape(second_px)}; both must be (n, 2)"
        )
    first, second = camera.normalise(first_px), camera.normalise(second_px)
    ones = np.ones((len(first), 1))
    return PointPairs(
        np.concatenate([first, ones], axis=1),
        np.concatenate([second, ones], axis=1),
        np.array([camera.fx, camera.fy]),
    )


def sampson_distances(pairs: PointPairs, rotation: FloatArray, translation: FloatArray) -> FloatArray:
    """Return how far pairs are from their epipolar lines (n, 1) [px] (docs/estimation.md, 11).

    The length of the translation does not matter, only its direction; it must not be zero.
    """
    in_first, in_second = _epipolar_lines(pairs, rotation, translation)
    gap = np.sum(pairs.first * in_first, axis=1)
    return np.asarray(gap / _lengths(_slopes(pairs, in_first, in_second)))[:, None]


def sampson(
    pairs: PointPairs, rotation: FloatArray, translation: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return `sampson_distances` (n, 1) [px] and their derivative by (nu, omega) (n, 1, 6)."""
    turned = pairs.second @ rotation.T
    in_first, in_second = _epipolar_lines(pairs, rotation, translation)
    gap = np.sum(pairs.first * in_first, axis=1)
    slopes = _slopes(pairs, in_first, in_second)
    length = _lengths(slopes)
    by_pose = _gap_by_pose(pairs, rotation, turned, in_second)
    slopes_by_pose = _slopes_by_pose(pairs, rotation, translation, turned, in_second)
    length_by_pose = (slopes[:, None, :] @ slopes_by_pose)[:, 0] / length[:, None]
    jacobian = by_pose / length[:, None] - (gap / length**2)[:, None] * length_by_pose
    return (gap / length)[:, None], jacobian[:, None, :]


def _epipolar_lines(
    pairs: PointPairs, rotation: FloatArray, translation: FloatArray
) -> tuple[FloatArray, FloatArray]:
    cross = skew(translation)
    return pairs.second @ (cross @ rotation).T, pairs.first @ (cross @ rotation)


def _slopes(pairs: PointPairs, in_first: FloatArray, in_second: FloatArray) -> FloatArray:
    """Return (n, 4): how fast the gap grows with the pixels of both pictures."""
    return np.concatenate([in_first[:, :2], in_second[:, :2]], axis=1) / np.tile(pairs.focal, 2)


def _lengths(slopes: FloatArray) -> FloatArray:
    return np.asarray(np.maximum(np.linalg.norm(slopes, axis=1), 1e-30))


def _gap_by_pose(
    pairs: PointPairs, rotation: FloatArray, turned: FloatArray, in_second: FloatArray
) -> FloatArray:
    by_shift = np.cross(turned, pairs.first) @ rotation
    return np.concatenate([by_shift, np.cross(pairs.second, in_second)], axis=1)


def _slopes_by_pose(
    pairs: PointPairs,
    rotation: FloatArray,
    translation: FloatArray,
    turned: FloatArray,
    in_second: FloatArray,
) -> FloatArray:
    """Return d (first two coordinates of both epipolar lines, over the focal lengths) (n, 4, 6)."""
    first = np.concatenate(
        [-skew(turned) @ rotation, -skew(translation) @ rotation @ skew(pairs.second)], axis=2
    )
    second = np.concatenate([rotation.T @ skew(pairs.first) @ rotation, skew(in_second)], axis=2)
    both = np.concatenate([first[:, :2], second[:, :2]], axis=1)
    return np.asarray(both / np.tile(pairs.focal, 2)[:, None])


def turn_alone(pairs: PointPairs, rotation: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return how far pairs are from where a camera that only turned would see them (n, 2) [px, of one
    picture], and d / d (nu, omega) (n, 2, 6).
    """
    turned = pairs.second @ rotation.T
    depth = np.maximum(turned[:, 2:], 1e-6)
    seen = turned[:, :2] / depth
    # Both pictures have noise: the difference of two pixels is wider than one by the root of 2.
    scale = pairs.focal / np.sqrt(2.0)
    by_turn = -rotation @ skew(pairs.second)
    sideways = (by_turn[:, :2] - seen[:, :, None] * by_turn[:, 2:]) / depth[:, :, None]
    jacobian = np.concatenate([np.zeros_like(sideways), sideways * scale[:, None]], axis=2)
    return (seen - pairs.first[:, :2]) * scale, jacobian
