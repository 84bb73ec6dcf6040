"""How well pairs of pixels fit a relative pose of two cameras, with the analytic derivative.

Source: Hartley and Zisserman, Multiple View Geometry, 11.4.3 (Sampson distance). Perturbation of a pose
first_from_second = (R, t): (nu, omega) makes it (R exp(omega), t + R nu).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tapreach.errors import InputError
from tapreach.estimation.small_rotations import cross_matrices
from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pose import skew

_GENERATORS = cross_matrices(np.eye(3))
"""(3, 3, 3): d exp(omega) / d omega at 0."""


@dataclass(frozen=True, eq=False)
class PointPairs:
    """n things seen twice: (x/z, y/z, 1) (n, 3) in the first and in the second camera; focal (2,) [px]."""

    first: FloatArray
    second: FloatArray
    focal: FloatArray

    def __len__(self) -> int:
        return len(self.first)

    @cached_property
    def by_essential(self) -> FloatArray:
        """(5 n, 9): what makes of the nine elements of an essential matrix E the gap xᵀ E y of every pair,
        then the four slopes of (8) by the pixels [1/px].
        """
        first, second = self.first, self.second
        rows = np.zeros((5, len(first), 3, 3))
        rows[0] = first[:, :, None] * second[:, None, :]
        rows[1, :, 0], rows[2, :, 1] = second / self.focal[0], second / self.focal[1]
        rows[3, :, :, 0], rows[4, :, :, 1] = first / self.focal[0], first / self.focal[1]
        return rows.reshape(-1, 9)

    def gaps_and_slopes(self, essentials: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return gaps (n, m) and slopes (4, n, m) for matrices (m, 3, 3); linear in them."""
        found = (self.by_essential @ essentials.reshape(-1, 9).T).reshape(5, len(self), -1)
        return found[0], found[1:]


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


def sampson_distances(pairs: PointPairs, rotations: FloatArray, translations: FloatArray) -> FloatArray:
    """Return how far pairs are from their epipolar lines (n, m) [px] (docs/estimation.md, 11).

    For m poses: rotations (m, 3, 3), translations (m, 3). The length of a translation does not matter, only
    its direction; it must not be zero.
    """
    gaps, slopes = pairs.gaps_and_slopes(cross_matrices(translations) @ rotations)
    return np.asarray(gaps / _lengths(slopes))


def sampson(
    pairs: PointPairs, rotation: FloatArray, translation: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return `sampson_distances` (n, 1) [px] of one pose and their derivative by (nu, omega) (n, 1, 6)."""
    essential = cross_matrices(translation) @ rotation
    by_pose = np.concatenate([rotation @ _GENERATORS, essential @ _GENERATORS])
    gaps, slopes = pairs.gaps_and_slopes(np.concatenate([essential[None], by_pose]))
    length = _lengths(slopes[:, :, :1])
    distance = gaps[:, :1] / length
    length_by_pose = np.sum(slopes[:, :, :1] * slopes[:, :, 1:], axis=0) / length
    jacobian = (gaps[:, 1:] - distance * length_by_pose) / length
    return distance, jacobian[:, None, :]


def _lengths(slopes: FloatArray) -> FloatArray:
    return np.asarray(np.maximum(np.sqrt(np.sum(slopes**2, axis=0)), 1e-30))


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
