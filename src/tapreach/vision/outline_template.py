"""An outline as weights: what must have changed inside of it, and what must not above and beside it."""

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.geometry.finite import FloatArray

Weights = NDArray[np.float32]
_ABOVE, _BESIDE = 10, 8
"""Width of the band that must not have changed [px]."""
_BESIDE_DOWN_TO = 0.4
"""Share of the outline's height down to which there is a band beside it: farther down there is more claw."""


@dataclass(frozen=True, eq=False)
class OutlineTemplate:
    """inside, around: (h, w), each of sum 1 (all 0 where nothing is left). left, top: its place in the
    picture [px].
    """

    inside: Weights
    around: Weights
    left: int
    top: int

    def scores(self, picture: Weights, reach: int) -> Weights:
        """Return mean inside less mean around for all shifts up to `reach`, (2·reach + 1, 2·reach + 1)."""
        seen = self._part(picture, reach)
        return np.asarray(cv2.matchTemplate(seen, self.inside - self.around, cv2.TM_CCORR), np.float32)

    def shares(self, picture: Weights) -> tuple[float, float]:
        """Return the means of the picture inside and around."""
        seen = self._part(picture, 0)
        return float((seen * self.inside).sum()), float((seen * self.around).sum())

    def median_inside(self, picture: Weights, reach: int) -> float:
        """Return the median of the picture inside, for the best of the shifts up to `reach`."""
        score = self.scores(picture, reach)
        row, column = np.unravel_index(int(np.argmax(score)), score.shape)
        seen = self._part(picture, reach)[row:, column:][: self.inside.shape[0], : self.inside.shape[1]]
        values = seen[self.inside > 0.0]
        return float(np.median(values)) if values.size else 0.0

    def _part(self, picture: Weights, margin: int) -> Weights:
        """Return what lies under the template and `margin` around it; the picture goes on as at its edge."""
        height, width = self.inside.shape
        rows = np.arange(self.top - margin, self.top + height + margin)
        columns = np.arange(self.left - margin, self.left + width + margin)
        rows, columns = np.clip(rows, 0, picture.shape[0] - 1), np.clip(columns, 0, picture.shape[1] - 1)
        return np.ascontiguousarray(picture[np.ix_(rows, columns)])


def template_of(outline: FloatArray) -> OutlineTemplate:
    """Return the template of a convex outline (n, 2) [px], n > 2."""
    left, top = (math.floor(low) for low in outline.min(axis=0) - (_BESIDE + 4, _ABOVE + 4))
    width, height = (math.ceil(high) for high in outline.max(axis=0) - (left, top) + (_BESIDE + 5, 5))
    mask = np.zeros((height, width), np.uint8)
    corners = np.round((cv2.convexHull(outline.astype(np.float32))[:, 0] - (left, top)) * 16.0)
    cv2.fillConvexPoly(mask, corners.astype(np.int32), 255, cv2.LINE_AA, 4)
    inside = mask.astype(np.float32) / 255.0
    return OutlineTemplate(_normalised(inside), _normalised(_band(mask, inside)), left, top)


def _band(mask: NDArray[np.uint8], inside: Weights) -> Weights:
    up_and_aside = np.ones((_ABOVE + 1, 2 * _BESIDE + 1), np.uint8)
    reached = cv2.dilate(mask, up_and_aside, anchor=(_BESIDE, 0)).astype(np.float32) / 255.0
    band = np.maximum(reached - inside, 0.0)
    rows = np.flatnonzero(mask.any(axis=1))
    band[rows[0] + round(_BESIDE_DOWN_TO * len(rows)) :] = 0.0
    return np.asarray(band, np.float32)


def _normalised(weights: Weights) -> Weights:
    total = float(weights.sum())
    return np.asarray(weights / total if total > 0.0 else weights, np.float32)
