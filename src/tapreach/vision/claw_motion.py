"""Where the claw is in the picture: its fingers moved between two pictures, all else stood still.

What the claw looks like is not known and not needed. Its outline is: each finger covers the background where
it is and lets it be seen where it was, so that both places change. An outline is laid where most has changed
inside of it and least above and beside it; below there is the rest of the claw.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray, finite_array
from tapreach.vision.image_io import Color
from tapreach.vision.outline_template import OutlineTemplate, template_of

Change = NDArray[np.float32]
"""(height, width) difference of two pictures [grey levels], the larger of its three colours."""

_DARK, _BRIGHT = 24.0, 240.0
"""Grey levels between which a picture's brightness is compared with another's."""
_LEAST_LEVEL = 10.0
_NOISES = 4.0
"""What differs by so many times the usual difference has changed."""
_LEAST_INSIDE = 0.85
_LEAST_PARTS = 2
"""One part alone may be another one, or a shadow."""
_MOST_AROUND = 0.45
_LEAST_TOGETHER = 0.35
_REFINE = 14
_FAR = 40
_SIGMA = 0.9
"""Of an outline laid on a claw that was drawn by its sizes [px]; measured in rendered rooms."""


@dataclass(frozen=True, eq=False)
class ClawPart:
    """A part of the claw as it is expected in one of the two pictures.

    outline: (n, 2) corners of what is surely seen of it [px], convex. mark: (2,) the place of it that is
    asked for [px]; outline and mark are moved together. Raises InputError for fewer than 3 corners.
    """

    name: str
    outline: FloatArray
    mark: FloatArray

    def __post_init__(self) -> None:
        finite_array("outline", self.outline, (None, 2))
        finite_array("mark", self.mark, (2,))
        if len(self.outline) < 3:
            raise InputError(f"outline of the {self.name} has {len(self.outline)} corners; it needs 3")

    def moved(self, shift: FloatArray) -> "ClawPart":
        """Return the part moved by (2,) [px]."""
        return ClawPart(self.name, self.outline + shift, self.mark + shift)


@dataclass(frozen=True, eq=False)
class SeenPart:
    """Where a part is: its mark (2,) [px], one sigma of each coordinate [px], how much of its outline has
    changed and how much beside it, 0 to 1.
    """

    name: str
    mark: FloatArray
    sigma: float
    inside: float
    around: float


@dataclass(frozen=True)
class NotSeen:
    """Why the claw, or a part of it, was not found."""

    reason: str


def change_between(before: Color, after: Color) -> Change:
    """Return how far two pictures of the same size differ; one that is brighter as a whole is evened out."""
    if before.shape != after.shape:
        raise InputError(f"pictures of {before.shape} and {after.shape} cannot be compared")
    first, second = before.astype(np.float32), after.astype(np.float32)
    is_exposed = (np.minimum(first, second) > _DARK) & (np.maximum(first, second) < _BRIGHT)
    ratios = first[is_exposed] / second[is_exposed]
    gain = float(np.median(ratios)) if ratios.size else 1.0
    return np.asarray(np.abs(first - gain * second).max(axis=2), dtype=np.float32)


def seen_parts(
    change: Change, parts: Sequence[ClawPart], reach: int
) -> tuple[SeenPart | NotSeen, ...] | NotSeen:
    """Return where each part is, all of them together at most `reach` [px] from where they are expected.

    NotSeen for all when nothing there moved like them; for a part that is hidden or out of the picture alone.
    """
    level = max(_LEAST_LEVEL, _NOISES * float(np.median(change)))
    has_changed = np.minimum(change / (2.0 * level), 1.0).astype(np.float32)
    shift, score = _roughly(has_changed, parts, reach)
    if score < _LEAST_TOGETHER:
        return NotSeen("nothing moved in the picture where the claw opened and closed")
    found = tuple(_placed(change, level, part.moved(shift)) for part in parts)
    if sum(isinstance(part, SeenPart) for part in found) < min(_LEAST_PARTS, len(parts)):
        return NotSeen("what moved in the picture does not have the claw's outline")
    return found


def _roughly(has_changed: Change, parts: Sequence[ClawPart], reach: int) -> tuple[FloatArray, float]:
    """Return the common shift of the parts (2,) [px] and its score; a far search is made in half the size."""
    if reach <= _FAR:
        return _best_shift(has_changed, [template_of(part.outline) for part in parts], reach)
    height, width = has_changed.shape
    small = cv2.resize(has_changed, (width // 2, height // 2), interpolation=cv2.INTER_AREA)
    templates = [template_of(part.outline / 2.0) for part in parts]
    shift, score = _best_shift(np.asarray(small, np.float32), templates, reach // 2)
    return 2.0 * shift, score


def _placed(change: Change, level: float, part: ClawPart) -> SeenPart | NotSeen:
    template = template_of(part.outline)
    # Half of what a finger differs by marks its edge, however blurred; its own level is known only inside.
    typical = max(template.median_inside(change, _REFINE), level)
    has_changed = np.minimum(change / typical, 1.0).astype(np.float32)
    shift, _ = _best_shift(has_changed, [template], _REFINE)
    placed = part.moved(shift)
    inside, around = template_of(placed.outline).shares((change > typical / 2.0).astype(np.float32))
    if np.abs(shift).max() >= _REFINE:
        return NotSeen(f"the {part.name} was not where the others are")
    height, width = change.shape
    is_on_picture = 0.0 <= placed.mark[0] <= width - 1 and 0.0 <= placed.mark[1] <= height - 1
    if inside < _LEAST_INSIDE or not is_on_picture:
        return NotSeen(f"the {part.name} is hidden or out of the picture")
    if around > _MOST_AROUND:
        return NotSeen(f"more than the {part.name} moved")
    return SeenPart(part.name, placed.mark, _SIGMA, inside, around)


def _best_shift(
    has_changed: Change, templates: Sequence[OutlineTemplate], reach: int
) -> tuple[FloatArray, float]:
    """Return the common shift (2,) [px] of the templates, to a fraction, and its score, -1 to 1."""
    score = np.mean([template.scores(has_changed, reach) for template in templates], axis=0)
    row, column = np.unravel_index(int(np.argmax(score)), score.shape)
    down = _between(score[:, column], int(row))
    across = _between(score[row, :], int(column))
    return np.array([across - reach, down - reach]), float(score[row, column])


def _between(values: NDArray[np.float32], at: int) -> float:
    """Return where the parabola through the highest value and its neighbours is highest."""
    if not 0 < at < len(values) - 1:
        return float(at)
    before, here, after = (float(value) for value in values[at - 1 : at + 2])
    bend = before - 2.0 * here + after
    return at + (0.5 * (before - after) / bend if bend < 0.0 else 0.0)
