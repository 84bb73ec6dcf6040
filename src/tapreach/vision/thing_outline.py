"""The best upright, symmetric outline around a place: dynamic programming over half widths, row by row.

Tins, bottles, cups and balls are symmetric about an upright axis, packets nearly. An outline has one axis for
all rows and a half width in each; it is worth the evidence inside it and the edges it runs along, less the
changes of its width.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tapreach.vision.thing_parallax import Cells, Mask

_AREA_COST = 0.15
"""Cells of which nothing is known are not worth having."""
_EDGE_GAIN = 6.0
_CHANGE_COST = 6.0
"""Of one cell's change of the half width from row to row."""
_IMPOSSIBLE = np.float32(-1e6)


@dataclass(frozen=True)
class Outline:
    """Rows `top` to `bottom`, in each the columns `axis` ± half width (rows,) [cells]."""

    axis: int
    top: int
    half_widths: NDArray[np.intp]

    @property
    def bottom(self) -> int:
        """The lowest row."""
        return self.top + len(self.half_widths) - 1

    def mask(self, shape: tuple[int, ...]) -> Mask:
        """Return the cells inside, of a raster of `shape` (rows, columns)."""
        filled = np.zeros(shape[:2], bool)
        offset = np.abs(np.arange(shape[1]) - self.axis)
        filled[self.top : self.bottom + 1] = offset[None, :] <= self.half_widths[:, None]
        return filled


def best_outline(evidence: Cells, edges: Cells, place: tuple[int, int], most: int, last_row: int) -> Outline:
    """Return the best outline around `place` (row, column), whose half width nowhere exceeds `most` cells.

    evidence, edges (0 to 1): (rows, columns). last_row: below it the outline does not reach.
    """
    search = _Search(evidence, edges, place[1], most)
    down = search.run(range(0, place[0] + 1))
    up = search.run(range(max(last_row, place[0]), place[0] - 1, -1))
    total = down[-1] + up[-1] - search.worth(place[0])
    total[np.abs(search.axes - place[1])[:, None] > search.half_widths[None, :]] = _IMPOSSIBLE
    axis, widest = np.unravel_index(int(np.argmax(total)), total.shape)
    above, below = (search.traced(best, int(axis), int(widest)) for best in (down, up))
    half_widths = search.half_widths[np.array(above[::-1] + below[1:])]
    return Outline(int(search.axes[axis]), place[0] - len(above) + 1, half_widths)


class _Search:
    """Everything indexed [axis, half width]."""

    def __init__(self, evidence: Cells, edges: Cells, column: int, most: int) -> None:
        columns = evidence.shape[1]
        self.half_widths = np.arange(1, most + 1)
        self.axes = np.arange(max(0, column - most), min(columns, column + most + 1))
        self._costs = (_CHANGE_COST * np.arange(most)).astype(np.float32)
        left, right = (self.axes[:, None] + side * self.half_widths[None, :] for side in (-1, 1))
        self._is_outside = (left < 0) | (right >= columns)
        self._left, self._right = np.clip(left, 0, columns - 1), np.clip(right, 0, columns - 1)
        zero = np.zeros((len(evidence), 1), np.float32)
        self._sums = np.concatenate([zero, np.cumsum(evidence - np.float32(_AREA_COST), axis=1)], axis=1)
        self._edges = np.float32(_EDGE_GAIN) * edges

    def worth(self, row: int) -> Cells:
        """Return what one row is worth."""
        sums, edges = self._sums[row], self._edges[row]
        worth = sums[self._right + 1] - sums[self._left] + edges[self._left] + edges[self._right]
        worth[self._is_outside] = _IMPOSSIBLE
        return np.asarray(worth, np.float32)

    def run(self, rows: range) -> list[Cells]:
        """Return the best worth of an outline that begins anywhere and ends in each of `rows`."""
        best: list[Cells] = []
        for row in rows:
            worth = self.worth(row)
            best.append(worth + np.maximum(self._relaxed(best[-1]), 0.0) if best else worth)
        return best

    def traced(self, best: list[Cells], axis: int, width: int) -> list[int]:
        """Return the half widths' numbers from the last row of `best` back to where the outline begins."""
        traced = [width]
        for row in reversed(best[:-1]):
            before = row[axis] - self._costs[np.abs(np.arange(len(self._costs)) - traced[-1])]
            width = int(np.argmax(before))
            if before[width] <= 0.0:
                break
            traced.append(width)
        return traced

    def _relaxed(self, best: Cells) -> Cells:
        """Return the most over all half widths before, less the cost of the change: two sweeps."""
        wider = np.maximum.accumulate(best + self._costs, axis=1) - self._costs
        narrower = np.maximum.accumulate((best - self._costs)[:, ::-1], axis=1)[:, ::-1] + self._costs
        return np.asarray(np.maximum(wider, narrower), np.float32)
