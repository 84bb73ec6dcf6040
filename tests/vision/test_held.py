"""The width of the claw's end from what changed across it, and how sure that is."""

import numpy as np
import pytest

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray
from tapreach.vision.claw_motion import Change
from tapreach.vision.held import AcrossClaw, claw_width, shares_changed

ASIDE = np.arange(-0.05, 0.05, 0.0015)
CLOSED, LEAST, WIDEST = 0.007, 0.013, 0.043


def across(is_hidden: np.ndarray | None = None) -> AcrossClaw:
    """The middle at u = 320, 2.5 px a millimetre, looked at in three rows."""
    u = 320.0 - 2500.0 * ASIDE
    pixels = np.stack([np.stack([u, np.full(len(u), 200.0 + row)], axis=1) for row in (0, 4, 8)], axis=1)
    if is_hidden is not None:
        pixels[is_hidden] = np.nan
    return AcrossClaw(ASIDE, pixels)


def changed(half: float, rng: np.random.Generator, noise: float = 0.05) -> Change:
    change = (rng.random((480, 640)) < noise) * 60.0
    reach = round(2500.0 * half)
    change[150:260, 320 - reach : 320 + reach] = 50.0
    return np.asarray(change, np.float32)


@pytest.mark.parametrize("half", [0.016, 0.026, 0.039])
def test_fingers_apart_are_something_held(half: float) -> None:
    rng = np.random.default_rng(4)
    looks = [(changed(half, rng), across()) for _ in range(2)]
    width = claw_width(looks, CLOSED, LEAST, WIDEST)
    assert width.log_odds > 7.0
    assert width.half_width == pytest.approx(half, abs=0.003)


def test_fingers_that_met_are_nothing_held() -> None:
    rng = np.random.default_rng(5)
    width = claw_width([(changed(CLOSED, rng), across()) for _ in range(2)], CLOSED, LEAST, WIDEST)
    assert width.log_odds < -7.0


def test_nothing_seen_tells_nothing() -> None:
    hidden = np.ones(len(ASIDE), dtype=bool)
    width = claw_width([(changed(0.03, np.random.default_rng(6)), across(hidden))], CLOSED, LEAST, WIDEST)
    assert width.log_odds == pytest.approx(0.0, abs=1e-9)


def test_one_side_is_enough() -> None:
    hidden: FloatArray | np.ndarray = ASIDE < 0.0
    width = claw_width([(changed(0.03, np.random.default_rng(7)), across(hidden))], CLOSED, LEAST, WIDEST)
    assert width.log_odds > 4.0


def test_what_moved_besides_is_told_by_how_little_any_width_explains() -> None:
    rng = np.random.default_rng(8)
    clear = claw_width([(changed(0.03, rng), across())], CLOSED, LEAST, WIDEST)
    disturbed = changed(0.008, rng)
    disturbed[150:260, 190:280] = 50.0
    assert clear.disagreement < 0.12
    assert claw_width([(disturbed, across())], CLOSED, LEAST, WIDEST).disagreement > 0.2


def test_place_beyond_the_picture_is_not_seen() -> None:
    places = AcrossClaw(np.array([0.0, 0.01]), np.array([[[10.0, 10.0]], [[-5.0, 10.0]]]))
    shares = shares_changed(np.zeros((48, 64), np.float32), places)
    assert shares[0] == 0.0
    assert np.isnan(shares[1])


def test_pixels_for_another_number_of_places_are_refused() -> None:
    with pytest.raises(InputError, match="shape"):
        AcrossClaw(ASIDE, np.zeros((3, 2, 2)))
