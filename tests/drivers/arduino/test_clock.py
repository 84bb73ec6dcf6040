import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.drivers.arduino.clock import WRAP_US, BoardClock
from tapreach.robot.clock import MS, SECOND

OFFSET_NS = 5_000_000_000_000


def board_us(now_ns: int) -> int:
    return (now_ns - OFFSET_NS) // 1000 % WRAP_US


def trip(clock: BoardClock, asked_ns: int, there_ns: int, back_ns: int) -> int:
    clock.take_trip(asked_ns, board_us(asked_ns + there_ns), asked_ns + there_ns + back_ns)
    return asked_ns + there_ns + back_ns


@given(st.lists(st.tuples(st.integers(0, 40), st.integers(0, 40)), min_size=1, max_size=16))
def test_alignment_is_no_worse_than_half_the_smallest_round_trip(delays_ms):
    clock, now_ns = BoardClock(), OFFSET_NS + 10 * SECOND
    for there_ms, back_ms in delays_ms:
        now_ns = trip(clock, now_ns + 50 * MS, there_ms * MS, back_ms * MS)
    best_ns = min((there + back) * MS for there, back in delays_ms)
    wrong_ns = clock.time_of_ns(board_us(now_ns), now_ns) - now_ns
    assert abs(wrong_ns) <= best_ns / 2 + 0.001 * best_ns + 2 * MS  # drift let it prefer a newer trip
    assert wrong_ns <= 0


def test_nothing_is_known_before_the_first_trip():
    clock = BoardClock()
    assert not clock.is_aligned
    assert clock.board_ms(0) is None
    assert clock.time_of_ns(5, 10) is None


def test_microseconds_that_wrap_go_on():
    clock, start_ns = BoardClock(), OFFSET_NS + (WRAP_US - 500_000) * 1000
    trip(clock, start_ns, MS, MS)
    for after_ns in range(0, 10 * SECOND, 100 * MS):
        now_ns = start_ns + after_ns + 10 * MS
        assert clock.time_of_ns(board_us(now_ns), now_ns) == pytest.approx(now_ns, abs=2000)


def test_milliseconds_times_1000_are_the_boards_count_however_often_it_wrapped():
    clock, now_ns = BoardClock(), OFFSET_NS + 7 * WRAP_US * 1000 + 123 * SECOND
    now_ns = trip(clock, now_ns, MS, MS)
    ahead_us = (clock.board_ms(now_ns) * 1000 - board_us(now_ns) + WRAP_US // 2) % WRAP_US - WRAP_US // 2
    assert -1001 <= ahead_us <= 0


def test_old_quick_trip_gives_way_to_a_fresh_one_when_the_clock_drifts():
    clock, start_ns = BoardClock(), OFFSET_NS + SECOND
    trip(clock, start_ns, MS // 2, MS // 2)
    later_ns = start_ns + 60 * SECOND
    drifted_us = board_us(later_ns) + 6_000  # 100 ppm fast
    clock.take_trip(later_ns, drifted_us, later_ns + 4 * MS)
    assert clock.time_of_ns(drifted_us, later_ns + 9 * MS) == pytest.approx(later_ns + 2 * MS, abs=2000)


def test_reboot_forgets_all():
    clock = BoardClock()
    trip(clock, OFFSET_NS + SECOND, MS, MS)
    clock.reset()
    assert not clock.is_aligned
