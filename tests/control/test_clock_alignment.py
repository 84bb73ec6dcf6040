"""The age of messages on links that are fast, slow, clogged or drifting."""

from hypothesis import given
from hypothesis import strategies as st

from tapreach.control.clock_alignment import ClockAlignment
from tapreach.robot.clock import MS, SECOND

OFFSET_NS = 123_456 * SECOND
delays_ms = st.lists(st.integers(1, 2000), min_size=1, max_size=50)


def ages_ms(delays: list[int], drift: float = 0.0, period_ms: int = 50) -> list[float]:
    """Ages as seen by the receiver of messages sent every `period_ms` with these delays."""
    alignment = ClockAlignment()
    ages = []
    for index, delay_ms in enumerate(delays):
        sent_ns = index * period_ms * MS
        client_ms = sent_ns * (1.0 + drift) / MS
        ages.append(alignment.age_ns(client_ms, OFFSET_NS + sent_ns + delay_ms * MS) / MS)
    return ages


def test_first_message_counts_as_fresh():
    assert ages_ms([300]) == [0.0]


def test_age_is_the_delay_above_the_fastest_message():
    ages = ages_ms([10, 10, 310, 12])
    assert abs(ages[2] - 300.0) < 0.1
    assert abs(ages[3] - 2.0) < 0.1


@given(delays_ms)
def test_age_is_never_negative_nor_above_the_spread_of_delays(delays):
    assert all(0.0 <= age <= max(delays) - min(delays) + 0.01 for age in ages_ms(delays))


def test_clogged_link_stays_clogged_for_minutes():
    # 20 Hz for five minutes, a second late from the third message on: never taken for normal.
    ages = ages_ms([10, 10] + [1010] * 6000)
    assert min(ages[2:]) > 900.0


def test_clocks_that_drift_apart_by_50_ppm_are_followed_for_an_hour():
    for drift in (5e-5, -5e-5):
        assert max(ages_ms([10] * 3600, drift, period_ms=1000)) < 1.0


def test_client_clock_may_start_anywhere():
    alignment = ClockAlignment()
    assert alignment.age_ns(-1e12, OFFSET_NS) == 0
    assert abs(alignment.age_ns(-1e12 + 50, OFFSET_NS + 300 * MS) - 250 * MS) < MS
