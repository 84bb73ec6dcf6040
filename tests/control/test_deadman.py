"""The last command never stands."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.control.deadman import TIMEOUT_NS, Deadman, Wish
from tapreach.robot.clock import MS, ManualClock
from tapreach.robot.messages import Twist

FORWARD = Wish(Twist(0.2, 0.0), 1)


@pytest.fixture
def deadman(clock: ManualClock) -> Deadman:
    return Deadman(clock)


def test_nobody_is_alive_at_the_start(deadman):
    assert not deadman.is_alive
    assert deadman.wish is None


def test_wish_stands_just_under_the_timeout_and_falls_at_it(deadman, clock):
    deadman.hold(FORWARD)
    clock.turn(TIMEOUT_NS - 1)
    assert deadman.wish == FORWARD
    clock.turn(1)
    assert deadman.wish is None
    assert not deadman.is_alive


def test_timeout_is_two_hundred_milliseconds():
    assert TIMEOUT_NS == 200 * MS


def test_heartbeats_alone_keep_the_operator_alive_but_not_the_wish(deadman, clock):
    deadman.hold(FORWARD)
    for _ in range(5):
        clock.turn(50 * MS)
        deadman.heard()
    assert deadman.is_alive
    assert deadman.wish is None


def test_heartbeat_after_silence_does_not_bring_the_wish_back(deadman, clock):
    deadman.hold(FORWARD)
    clock.turn(TIMEOUT_NS)
    deadman.heard()
    assert deadman.is_alive
    assert deadman.wish is None


def test_release_drops_the_wish_and_keeps_the_operator(deadman):
    deadman.hold(FORWARD)
    deadman.release()
    assert deadman.wish is None
    assert deadman.is_alive


def test_gone_drops_both(deadman):
    deadman.hold(FORWARD)
    deadman.gone()
    assert deadman.wish is None
    assert not deadman.is_alive


def test_fresh_drive_message_after_silence_is_taken(deadman, clock):
    deadman.hold(FORWARD)
    clock.turn(TIMEOUT_NS)
    assert deadman.wish is None
    deadman.hold(FORWARD)
    assert deadman.wish == FORWARD


@given(
    st.lists(
        st.tuples(st.sampled_from(["hold", "heard", "release", "gone"]), st.integers(0, 300)), max_size=40
    )
)
def test_wish_stands_only_within_the_timeout_of_a_drive_message_not_ended_since(events):
    clock = ManualClock()
    deadman = Deadman(clock)
    held_ns = None
    for what, pause_ms in events:
        if what == "hold":
            deadman.hold(FORWARD)
            held_ns = clock.now_ns()
        else:
            getattr(deadman, what)()
            held_ns = held_ns if what == "heard" else None
        clock.turn(pause_ms * MS)
        expected = held_ns is not None and clock.now_ns() - held_ns < TIMEOUT_NS
        assert (deadman.wish is not None) == expected
