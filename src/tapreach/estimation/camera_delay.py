"""How much later a camera's pictures are than their time stamps say, from a turn to and fro.

The azimuth of each place that stands still follows the base's heading: -gain · heading(t - delay) + offset +
drift · t. Each place has a gain, offset and drift of its own: the camera stands ahead of the axis of turning,
so that near things move more; wheels slip. The delay is common to all. For a given delay the rest is linear,
so that the squares are minimised over the delay alone (variable projection).

Source: Golub and Pereyra 1973, "The differentiation of pseudo-inverses and nonlinear least squares problems
whose variables separate".
"""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize_scalar

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray, finite_array

EARLIEST, LATEST = -0.1, 0.4
"""Where the delay is sought [s]."""
_STEP = 0.005
_FEWEST_PLACES, _FEWEST_PICTURES = 15, 12
_LEAST_TURN = math.radians(4.0)
_LEAST_SHARE = 0.5
_GAINS = 0.6, 3.0
"""What stands still turns by the base's turn, more when it is near; the robot's own arm does not turn."""
_MOST_NOISE = 3.0
"""A place is another thing when it fits worse than most by more than this factor."""
_MOST_MISFIT = 0.06
"""Rms of what remains for all places in common, as a share of the heading's own."""
_MOST_SIGMA = 0.006
_FLOOR = 0.0015
"""The body follows its wheels by about so much later [s]: tyres give, gears have play."""
_UNKNOWNS = 4


@dataclass(frozen=True, slots=True)
class CameraDelay:
    """delay [s]: a picture was taken so much before its time stamp; negative: after it. sigma [s]: of it.

    scatter [s]: how far single pictures are off, one sigma, beyond what they all share.
    """

    delay: float
    sigma: float
    scatter: float = 0.0


@dataclass(frozen=True, slots=True)
class NoDelay:
    """It cannot be told, and why."""

    reason: str


@dataclass(frozen=True, eq=False)
class TurnRecord:
    """A turn to and fro, by camera and wheels.

    times (n,) [s]: of the pictures by their stamps. azimuths (n, m) [rad]: of m places in the frame of the
    base, left positive. heading_times (k,) [s], headings (k,) [rad]: of the base by the wheels, from before
    the first picture on; outside of them it stands still. Raises InputError for shapes that do not match.
    """

    times: FloatArray
    azimuths: FloatArray
    heading_times: FloatArray
    headings: FloatArray

    def __post_init__(self) -> None:
        finite_array("azimuths", self.azimuths, (len(self.times), None))
        finite_array("headings", self.headings, (len(self.heading_times),))
        if len(self.heading_times) < 2 or np.any(np.diff(self.heading_times) <= 0.0):
            raise InputError("heading_times must be two or more, and rise")

    def headings_at(self, delay: float) -> FloatArray:
        """Return the heading (n,) [rad] when each picture was taken, if it was so late."""
        return np.interp(self.times - delay, self.heading_times, self.headings)

    def basis(self, delay: float) -> FloatArray:
        """Return (n, 3): heading, one, and time from -1/2 to 1/2, of each picture."""
        span = self.times[-1] - self.times[0]
        linear = (self.times - self.times[0]) / span - 0.5
        return np.stack([self.headings_at(delay), np.ones_like(linear), linear], axis=1)


def estimate_camera_delay(record: TurnRecord) -> CameraDelay | NoDelay:
    """Return the delay, or why it cannot be told: too little seen, hardly turned, or no agreement."""
    pictures, places = record.azimuths.shape
    if pictures < _FEWEST_PICTURES:
        return NoDelay(f"only {pictures} pictures; {_FEWEST_PICTURES} are needed")
    if places < _FEWEST_PLACES:
        return NoDelay(f"only {places} places were seen in all pictures; {_FEWEST_PLACES} are needed")
    turned = float(np.ptp(record.headings_at(0.0)))
    if turned < _LEAST_TURN:
        return NoDelay(f"the base turned by {math.degrees(turned):.1f}° only")
    return _fitted(record)


def _fitted(record: TurnRecord) -> CameraDelay | NoDelay:
    delays = np.arange(EARLIEST, LATEST + _STEP / 2.0, _STEP)
    typical = [float(np.median(_misfits(record, delay))) for delay in delays]
    is_still = _stands_still(record, float(delays[int(np.argmin(typical))]))
    if is_still.sum() < max(_FEWEST_PLACES, _LEAST_SHARE * len(is_still)):
        share = 100.0 * float(is_still.mean())
        return NoDelay(f"what the camera sees does not turn as the wheels do: {share:.0f} % of it does")
    still = TurnRecord(record.times, record.azimuths[:, is_still], record.heading_times, record.headings)
    coarse = [float(np.sum(_misfits(still, delay))) for delay in delays]
    best = int(np.argmin(coarse))
    if best in (0, len(delays) - 1):
        return NoDelay(f"pictures and wheels do not fit within {EARLIEST:g} to {LATEST:g} s of each other")
    found = minimize_scalar(
        lambda delay: float(np.sum(_misfits(still, delay))),
        bounds=(delays[best - 1], delays[best + 1]),
        method="bounded",
        options={"xatol": 1e-5},
    )
    return _judged(still, float(found.x))


def _misfits(record: TurnRecord, delay: float) -> FloatArray:
    """Return the mean squares (m,) [rad²] that the best gain, offset and drift of each place leave."""
    return np.asarray(np.mean(_remaining(record, delay)[0] ** 2, axis=0))


def _remaining(record: TurnRecord, delay: float) -> tuple[FloatArray, FloatArray]:
    """Return what remains (n, m) [rad], and each place's gain (m,)."""
    basis = record.basis(delay)
    factors = np.linalg.lstsq(basis, record.azimuths, rcond=None)[0]
    return record.azimuths - basis @ factors, -factors[0]


def _stands_still(record: TurnRecord, delay: float) -> npt.NDArray[np.bool_]:
    """Tell which places (m,) move as what stands still must."""
    remains, gains = _remaining(record, delay)
    is_turning = (gains > _GAINS[0]) & (gains < _GAINS[1])
    if not np.any(is_turning):
        return is_turning
    noise = np.sqrt(np.mean(remains**2, axis=0))
    return np.asarray(is_turning & (noise < _MOST_NOISE * np.median(noise[is_turning])))


def _judged(record: TurnRecord, delay: float) -> CameraDelay | NoDelay:
    remains, gains = _remaining(record, delay)
    common = np.mean(remains / gains, axis=1)
    rate = (record.headings_at(delay - _STEP) - record.headings_at(delay + _STEP)) / (2.0 * _STEP)
    misfit = float(np.std(common) / np.std(record.headings_at(delay)))
    if misfit > _MOST_MISFIT:
        return NoDelay(f"the picture does not follow the wheels: {100.0 * misfit:.0f} % of the turn differ")
    sigma = _sigma_of_delay(record.basis(delay), common, rate)
    if sigma > _MOST_SIGMA:
        return NoDelay(f"it is seen to {1000.0 * sigma:.0f} ms only")
    return CameraDelay(delay, sigma, _scatter(common, rate))


def _sigma_of_delay(basis: FloatArray, common: FloatArray, rate: FloatArray) -> float:
    """Return one sigma [s], from what remains (n,) [rad] in common to all places."""
    seen = rate - basis @ np.linalg.lstsq(basis, rate, rcond=None)[0]
    variance = float(common @ common) / max(1, len(common) - _UNKNOWNS)
    # Neighbouring pictures err alike: fewer of them are independent than there are.
    alike = float(np.clip(common[1:] @ common[:-1] / max(float(common @ common), 1e-30), 0.0, 0.9))
    shown = max(float(seen @ seen), 1e-12)
    return math.hypot(math.sqrt(variance * (1.0 + alike) / (1.0 - alike) / shown), _FLOOR)


def _scatter(common: FloatArray, rate: FloatArray) -> float:
    """Return how far single pictures are off [s]: what remains more while it turns than at rest."""
    is_turning = np.abs(rate) > 0.5 * np.max(np.abs(rate))
    at_rest = float(np.mean(common[~is_turning] ** 2)) if not np.all(is_turning) else 0.0
    excess = float(np.mean(common[is_turning] ** 2)) - at_rest
    return math.sqrt(max(0.0, excess) / float(np.mean(rate[is_turning] ** 2)))
