"""The delay of a camera from a turn to and fro: found to well below a frame, with a region that holds, or not
told.
"""

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from tapreach.errors import InputError
from tapreach.estimation.camera_delay import CameraDelay, NoDelay, TurnRecord, estimate_camera_delay
from tapreach.geometry.finite import FloatArray

TICK = radians(0.05)
NOISE = radians(0.03)


def heading_at(times: FloatArray, turn: float = radians(6.0)) -> FloatArray:
    """To the left, to the right and back within 1.5 s, at rest before and after."""
    share = np.clip((times - 0.4) / 1.5, 0.0, 1.0)
    return turn * np.sin(2.0 * np.pi * share) * np.sin(np.pi * share)


def turn_record(
    delay: float,
    rng: np.random.Generator,
    places: int = 60,
    rate_hz: float = 30.0,
    dropped: float = 0.05,
    turn: float = radians(6.0),
) -> TurnRecord:
    """A turn by wheels that count in ticks, and by a camera that loses pictures; nearer things turn more."""
    stamps = np.arange(0.45, 2.3, 1.0 / rate_hz) + rng.uniform(0.0, 0.03)
    stamps = stamps[rng.random(len(stamps)) >= dropped]
    seen = -heading_at(stamps - delay, turn)[:, None] * rng.uniform(1.0, 1.4, places)
    seen += rng.uniform(-0.5, 0.5, places) + NOISE * rng.standard_normal(seen.shape)
    seen += 0.2 * NOISE * rng.standard_normal((len(stamps), 1))
    wheels = np.arange(0.0, 2.4, 0.02)
    return TurnRecord(stamps, seen, wheels, TICK * np.round(1.02 * heading_at(wheels, turn) / TICK))


@pytest.mark.parametrize("delay", [-0.02, 0.0, 0.04, 0.0837, 0.15, 0.25])
@pytest.mark.parametrize("rate_hz", [15.0, 30.0])
def test_delay_is_found_to_a_millisecond_whatever_it_is(delay: float, rate_hz: float) -> None:
    found = estimate_camera_delay(turn_record(delay, np.random.default_rng(), rate_hz=rate_hz))
    assert isinstance(found, CameraDelay)
    assert found.delay == pytest.approx(delay, abs=0.0025)


def test_delay_lies_within_two_sigma_nearly_always() -> None:
    rng = np.random.default_rng()
    outside = 0
    for _ in range(60):
        delay = float(rng.uniform(0.0, 0.2))
        found = estimate_camera_delay(turn_record(delay, rng, rate_hz=float(rng.choice([15.0, 30.0]))))
        assert isinstance(found, CameraDelay)
        outside += abs(found.delay - delay) > 2.0 * found.sigma
    assert outside <= 8


def test_scatter_of_single_stamps_is_told_beside_the_delay() -> None:
    rng = np.random.default_rng()
    record = turn_record(0.08, rng, places=100)
    late = replace(record, times=record.times + 0.008 * rng.standard_normal(len(record.times)))
    found = estimate_camera_delay(late)
    assert isinstance(found, CameraDelay)
    assert 0.003 < found.scatter < 0.016
    steady = estimate_camera_delay(record)
    assert isinstance(steady, CameraDelay) and steady.scatter < 0.003


def test_a_third_that_moves_on_its_own_and_an_arm_in_the_picture_do_no_harm() -> None:
    rng = np.random.default_rng()
    record = turn_record(0.08, rng, places=90)
    azimuths = record.azimuths.copy()
    azimuths[:, :15] = azimuths[0, :15] + NOISE * rng.standard_normal((len(azimuths), 15))
    azimuths[:, 15:30] += 0.2 * np.cumsum(0.1 * rng.standard_normal((len(azimuths), 15)), axis=0)
    found = estimate_camera_delay(replace(record, azimuths=azimuths))
    assert isinstance(found, CameraDelay)
    assert found.delay == pytest.approx(0.08, abs=0.003)


def test_what_moves_otherwise_is_not_taken_for_a_delay() -> None:
    rng = np.random.default_rng()
    record = turn_record(0.08, rng)
    walks = np.cumsum(0.01 * rng.standard_normal(record.azimuths.shape), axis=0)
    for azimuths in (walks, -record.azimuths, 0.0 * record.azimuths + NOISE * walks):
        found = estimate_camera_delay(replace(record, azimuths=azimuths))
        assert isinstance(found, NoDelay)
        assert "does not turn as the wheels do" in found.reason


def test_a_common_sway_is_seen_as_no_agreement() -> None:
    rng = np.random.default_rng()
    record = turn_record(0.08, rng)
    sway = radians(1.5) * np.sin(9.0 * record.times + rng.uniform(0.0, 6.0))
    found = estimate_camera_delay(replace(record, azimuths=record.azimuths + sway[:, None]))
    assert isinstance(found, NoDelay)


def test_too_little_is_said_to_be_too_little() -> None:
    rng = np.random.default_rng()
    few = turn_record(0.08, rng, places=8)
    assert estimate_camera_delay(few) == NoDelay("only 8 places were seen in all pictures; 15 are needed")
    hardly = estimate_camera_delay(turn_record(0.08, rng, turn=radians(1.0)))
    assert isinstance(hardly, NoDelay) and "the base turned by" in hardly.reason
    slow = estimate_camera_delay(turn_record(0.08, rng, rate_hz=5.0))
    assert isinstance(slow, NoDelay) and "pictures; 12 are needed" in slow.reason


def test_delay_beyond_the_search_is_not_told() -> None:
    assert isinstance(estimate_camera_delay(turn_record(0.6, np.random.default_rng())), NoDelay)


def test_record_with_headings_out_of_order_is_refused() -> None:
    record = turn_record(0.0, np.random.default_rng())
    with pytest.raises(InputError, match="rise"):
        replace(record, heading_times=record.heading_times[::-1])
