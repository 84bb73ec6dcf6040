"""Figures of one setting with the chance in them, and whether they can be told from their limits."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tapreach.bench.accuracy_linear import Linear
from tapreach.bench.accuracy_outcomes import REGION_95, Outcomes
from tapreach.bench.figure import Band
from tapreach.geometry.finite import FloatArray

Values = FloatArray | npt.NDArray[np.bool_]
ERROR, REGION, CONSISTENCY = Band(0.0, 1.03), Band(0.94, 0.96), Band(0.95, 1.05)


@dataclass(frozen=True)
class Judged:
    """A value, its standard error, and what is wanted."""

    value: float
    chance: float
    wanted: Band

    @property
    def is_told(self) -> bool:
        """True where no limit lies within 2.5 standard errors."""
        nearest = min(abs(self.value - self.wanted.low), abs(self.value - self.wanted.high))
        return nearest >= 2.5 * self.chance

    @property
    def is_broken(self) -> bool:
        """True where the value is beyond its limits by more than chance, 3 standard errors."""
        beyond = max(self.wanted.low - self.value, self.value - self.wanted.high)
        return beyond > 3.0 * self.chance


@dataclass(frozen=True)
class CellFigures:
    """error: root mean square of the inverse depth over its bound. region: share of 95 % regions that hold
    the truth. consistency: NEES/3.
    """

    error: Judged
    region: Judged
    consistency: Judged

    @property
    def all(self) -> tuple[Judged, Judged, Judged]:
        """The three."""
        return self.error, self.region, self.consistency


def judged_cell(outcomes: Outcomes, linear_errors: FloatArray, experiment: Linear) -> CellFigures:
    """Judge m trials with the linear errors (m, 3) in the same trials.

    Where some had no answer, those with one are not drawn as they were meant to be: nothing is subtracted.
    """
    answered = outcomes.is_answered
    squared = (outcomes.errors[answered, 2] / experiment.inverse_depth_sd) ** 2
    nees = outcomes.nees[answered]
    if not np.all(answered):
        return _figures(_mean(squared), _mean(nees <= REGION_95), _mean(nees / 3.0))
    own_squared = (linear_errors[:, 2] / experiment.inverse_depth_sd) ** 2
    own_nees = np.sum((linear_errors @ experiment.information) * linear_errors, axis=1)
    return _figures(
        controlled(squared, own_squared, 1.0),
        controlled(nees <= REGION_95, own_nees <= REGION_95, 0.95),
        controlled(nees / 3.0, own_nees / 3.0, 1.0),
    )


def controlled(values: Values, controls: Values, expected: float) -> tuple[float, float]:
    """Return the mean of values (m,) and its standard error, after taking away what controls (m,), whose mean
    should be `expected`, show to be chance.

    The standard error is at least 1/m: that not one trial differs shows no more than that few do.
    """
    values, controls = (np.asarray(each, dtype=np.float64) for each in (values, controls))
    mean, chance = _mean(values - (controls - expected))
    return mean, max(chance, 1.0 / max(len(values), 1))


def _mean(values: Values) -> tuple[float, float]:
    if len(values) < 2:
        return math.nan, math.inf
    return float(np.mean(values)), float(np.std(values, ddof=1)) / math.sqrt(len(values))


def _figures(
    squared: tuple[float, float], region: tuple[float, float], nees: tuple[float, float]
) -> CellFigures:
    root = math.sqrt(max(squared[0], 1e-12))
    return CellFigures(
        Judged(root, squared[1] / (2.0 * root), ERROR), Judged(*region, REGION), Judged(*nees, CONSISTENCY)
    )
