"""Cutting a thing out by parallax and colours: rasters drawn as evidence."""

from dataclasses import dataclass

import numpy as np
import pytest

from tapreach.vision.thing_cut import cut_out
from tapreach.vision.thing_parallax import Cells, Mask

SHAPE, CELL = (150, 141), 0.003
ROWS, COLUMNS = np.indices(SHAPE)
CUP = (abs(COLUMNS - 70) <= 11) & (ROWS >= 105) & (ROWS <= 135)
WALL = ROWS < 85
"""Plain, and beyond a skirting board of which the parallax tells that it is far away."""


@dataclass(frozen=True)
class Drawn:
    """The parallax of cells that nothing hides."""

    evidence: Cells

    def without(self, outlined: Mask) -> Cells:
        return self.evidence.copy()


def picture(wall: tuple[int, int, int]) -> np.ndarray:
    rng = np.random.default_rng(5)
    drawn = np.full((*SHAPE, 3), (130, 170, 200), np.uint8)
    drawn[WALL], drawn[CUP] = wall, (205, 208, 210)
    return np.clip(drawn + rng.normal(0.0, 1.5, drawn.shape), 0, 255).astype(np.uint8)


@pytest.mark.parametrize("wall", [(205, 208, 210), (60, 90, 60)], ids=["as the cup", "other"])
def test_plain_wall_is_no_part_of_the_thing_whatever_its_colour(wall: tuple[int, int, int]) -> None:
    evidence = np.where(CUP, 2.0, np.where(WALL, 0.0, -2.0)).astype(np.float32)
    everywhere = np.ones(SHAPE, bool)
    cut = cut_out(picture(wall), everywhere, Drawn(evidence), (120, 70), 140, CELL)  # type: ignore[arg-type]
    assert cut.is_bounded
    assert cut.outline.top == pytest.approx(105, abs=2)
    assert cut.outline.half_widths.max() == pytest.approx(11, abs=2)


def test_plain_rest_of_a_thing_is_found_by_its_colour() -> None:
    """Of a cup with a printed band the band alone shows parallax."""
    band = CUP & (ROWS >= 115) & (ROWS <= 130)
    evidence = np.where(band, 2.0, np.where(CUP, 0.0, -0.3)).astype(np.float32)
    everywhere = np.ones(SHAPE, bool)
    cut = cut_out(picture((60, 90, 60)), everywhere, Drawn(evidence), (120, 70), 140, CELL)  # type: ignore[arg-type]
    assert cut.outline.top < 112 and cut.outline.bottom > 132


@pytest.mark.parametrize("edge", [0, 105, 60], ids=["no edge", "at its top", "farther up"])
def test_thing_that_reaches_the_end_of_the_picture_is_cut_above(edge: int) -> None:
    evidence = np.where(CUP, 2.0, -2.0).astype(np.float32)
    in_picture = edge <= ROWS
    cut = cut_out(picture((60, 90, 60)), in_picture, Drawn(evidence), (120, 70), 140, CELL)  # type: ignore[arg-type]
    assert cut.is_cut_above == (edge == 105)
