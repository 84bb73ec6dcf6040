"""How late a picture is by the sender's stamps."""

from tapreach.drivers.camera.lag import Lag
from tapreach.robot.clock import MS, SECOND


def test_stream_on_time_is_not_late_whatever_the_two_clocks_show():
    lag = Lag()
    assert [lag.of(at * 33 * MS, 9_000 * SECOND + at * 33 * MS) for at in range(100)] == [0] * 100


def test_pictures_that_pile_up_on_the_way_are_as_late_as_they_are():
    lag = Lag()
    lag.of(0, 0)
    late_ms = [lag.of(at * 100 * MS, at * 50 * MS) / MS for at in range(1, 11)]
    assert all(abs(late - 50 * at) < 0.5 for at, late in enumerate(late_ms, start=1))


def test_smallest_difference_counts_as_on_time_also_when_it_comes_later():
    lag = Lag()
    assert lag.of(80 * MS, 0) == 0
    assert lag.of(110 * MS, 100 * MS) == 0
    assert 69 * MS < lag.of(280 * MS, 200 * MS) <= 70 * MS


def test_clocks_that_drift_apart_make_no_lag_in_the_long_run():
    lag = Lag()
    drifted = [lag.of(at * SECOND + at * 100_000, at * SECOND) for at in range(3600)]
    assert max(drifted) < MS


def test_clock_of_the_sender_that_is_set_begins_anew():
    lag = Lag()
    lag.of(0, 0)
    assert lag.of(33 * MS, -3600 * SECOND) == 0
    assert lag.of(66 * MS, 3600 * SECOND) == 0
    assert lag.of(99 * MS, 3600 * SECOND + 33 * MS) == 0
