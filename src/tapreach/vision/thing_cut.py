"""Cuts a thing out of a raster: parallax first, then its colours, small outlines before large ones.

Two things at the same distance side by side look like one wide thing. The smallest outline is taken that
something else bounds on both sides.
"""

from dataclasses import dataclass

import cv2
import numpy as np

from tapreach.vision.image_io import Color
from tapreach.vision.thing_colour import colour_evidence
from tapreach.vision.thing_outline import Outline, best_outline
from tapreach.vision.thing_parallax import Cells, Mask, Parallax

HALF_WIDTHS = (0.045, 0.09, 0.19)
"""Half widths tried in turn [m]: what a small claw can grip, then larger things."""
_COLOUR_WEIGHT = 0.7
_EDGE = 100.0
"""Change over a cell, times four, that counts as an edge [grey levels, roots of brightness]."""
_ON_THING = 0.3
_AROUND = 0.05
"""The thing's surroundings, whose colours are not its own, reach so far [m]."""
_REACH = 0.02
"""Farther than this from what the parallax shows [m] colours make nothing part of the thing: a plain wall may
have the same colour, and shows no parallax.
"""
BOUND = 0.6
"""Share of the rows that something else must bound on each side."""
_BESIDE = 0.006
"""Strip beside the outline that is looked at [m]."""
_SOMETHING_ELSE = -0.1
_FOOT = 0.012
"""Near the floor nothing tells the floor from the thing [m]."""


@dataclass(frozen=True)
class CutOut:
    """An outline; of its left and right side the share of rows bounded by something else, and by the end of
    the picture. is_cut_above: it reaches up to the end of the picture.
    """

    outline: Outline
    bounded: tuple[float, float]
    cut_off: tuple[float, float]
    is_cut_above: bool

    @property
    def is_bounded(self) -> bool:
        """True when something else is seen on both sides."""
        return min(self.bounded) >= BOUND


def cut_out(
    picture: Color, is_seen: Mask, parallax: Parallax, place: tuple[int, int], last_row: int, cell: float
) -> CutOut:
    """Return what is cut out around `place` (row, column) of a raster with cells of `cell` [m]."""
    edges = _edges(picture, is_seen)
    evidence = parallax.evidence
    for half_width in HALF_WIDTHS:
        most = min(int(half_width / cell), picture.shape[1] // 2)
        first = best_outline(evidence, edges * (evidence > _ON_THING), place, most, last_row)
        evidence = _with_colour(picture, is_seen, parallax, first, cell)
        outline = best_outline(evidence, edges * (evidence > _ON_THING), place, most, last_row)
        found = _judged(outline, evidence, is_seen, cell)
        if found.is_bounded:
            break
    return found


def _edges(picture: Color, is_seen: Mask) -> Cells:
    """Return how much each cell is an upright edge, 0 to 1."""
    change = np.abs(cv2.Sobel(picture, cv2.CV_32F, 1, 0, ksize=3)).max(axis=2)
    return np.asarray(np.clip(change / _EDGE, 0.0, 1.0) * is_seen, np.float32)


def _with_colour(picture: Color, is_seen: Mask, parallax: Parallax, outline: Outline, cell: float) -> Cells:
    mask = outline.mask(picture.shape)
    evidence = parallax.without(mask)
    inside, clear, near = _resized(mask, -2), ~_resized(mask, 4), _resized(mask, round(_AROUND / cell))
    outside = is_seen & ((clear & near) | (evidence < -2.0))
    colour = colour_evidence(picture, inside, outside)
    is_beyond = ~_resized(mask, round(_REACH / cell))
    colour[is_beyond] = np.minimum(colour[is_beyond], 0.0)
    return np.asarray((evidence + _COLOUR_WEIGHT * colour) * is_seen, np.float32)


def _resized(mask: Mask, cells: int) -> Mask:
    kernel = np.ones((2 * abs(cells) + 1, 2 * abs(cells) + 1), np.uint8)
    change = cv2.dilate if cells > 0 else cv2.erode
    return np.asarray(change(mask.astype(np.uint8), kernel) > 0)


def _judged(outline: Outline, evidence: Cells, is_seen: Mask, cell: float) -> CutOut:
    rows = np.arange(outline.top, max(outline.top + 1, outline.bottom - round(_FOOT / cell)))
    half_widths = outline.half_widths[: len(rows)]
    steps = np.arange(2, 2 + max(2, round(_BESIDE / cell)))
    bounded, cut_off = [], []
    for side in (-1, 1):
        columns = outline.axis + side * (half_widths[:, None] + steps[None, :])
        is_there = (columns >= 0) & (columns < evidence.shape[1])
        columns = np.clip(columns, 0, evidence.shape[1] - 1)
        is_seen_there = is_there & is_seen[rows[:, None], columns]
        beside = np.where(is_seen_there, evidence[rows[:, None], columns], 0.0).mean(axis=1)
        bounded.append(float(np.mean(beside < _SOMETHING_ELSE)))
        cut_off.append(float(np.mean(~is_seen_there.any(axis=1))))
    return CutOut(
        outline, (bounded[0], bounded[1]), (cut_off[0], cut_off[1]), _is_cut_above(outline, is_seen)
    )


def _is_cut_above(outline: Outline, is_seen: Mask) -> bool:
    above, half_width = max(outline.top - 2, 0), outline.half_widths[0]
    columns = slice(max(outline.axis - half_width, 0), outline.axis + half_width + 1)
    return not bool(is_seen[above, columns].any())
