"""Default deny: nothing moves unless everything allows it, and never faster than it may."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.control.deadman import Wish
from tapreach.control.gate import (
    FROZEN_NS,
    STALE_NS,
    Circumstances,
    Gate,
    command_refusal,
    picture_refusal,
    refusal,
)
from tapreach.control.speed_limit import SpeedLimits, limited, ramped
from tapreach.robot.clock import MS, SECOND
from tapreach.robot.messages import STILL, Health, LinkStatus, Twist

NOW_NS = 100 * SECOND
LIMITS = SpeedLimits(linear=0.35, angular=1.5, linear_acceleration=0.8, angular_acceleration=4.0)
GOOD = Circumstances(NOW_NS, Health(LinkStatus.RUNNING), "", has_lease=True, operator_is_alive=True)
FORWARD = Wish(Twist(0.2, 0.0), NOW_NS - 30 * MS)

numbers = st.floats(-1e6, 1e6)
twists = st.builds(Twist, numbers, numbers)
small_twists = st.builds(Twist, st.floats(-0.35, 0.35), st.floats(-1.5, 1.5))
pictures = st.none() | st.integers(NOW_NS - 2 * SECOND, NOW_NS)
wishes = st.none() | st.builds(Wish, twists, pictures)
circumstances = st.builds(
    Circumstances,
    now_ns=st.just(NOW_NS),
    health=st.builds(Health, st.sampled_from(LinkStatus), st.sampled_from(["", "cable out"])),
    emergency_stop=st.sampled_from(["", "pressed by Anna"]),
    has_lease=st.booleans(),
    operator_is_alive=st.booleans(),
)
durations = st.floats(0.0, 0.06)


def is_within(twist: Twist, limits: SpeedLimits) -> bool:
    return abs(twist.linear) <= limits.linear and abs(twist.angular) <= limits.angular


def test_everything_right_moves():
    decision = Gate(LIMITS).operator(FORWARD, GOOD, 0.02)
    assert decision.twist == Twist(pytest.approx(0.016), 0.0)
    assert decision.reason == "speeding up"


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"has_lease": False}, "lease"),
        ({"operator_is_alive": False}, "not heard for 200 ms"),
        ({"emergency_stop": "pressed by Anna at 10:00:00 UTC"}, "emergency stop pressed by Anna"),
        ({"health": Health(LinkStatus.LOST, "cable out")}, "robot lost: cable out"),
        ({"health": Health(LinkStatus.STARTING)}, "robot starting"),
    ],
)
def test_each_missing_condition_stops_operator_and_task_and_says_why(change, reason):
    circumstances = replace(GOOD, **change)
    for decision in (
        Gate(LIMITS).operator(FORWARD, circumstances, 0.02),
        Gate(LIMITS).task(FORWARD.twist, circumstances, 0.02),
    ):
        assert decision.twist == STILL
        assert reason in decision.reason


def test_circumstances_that_nobody_filled_in_deny():
    assert refusal(Circumstances(NOW_NS, Health(LinkStatus.RUNNING), "")) != ""


@pytest.mark.parametrize(("age_ns", "is_refused"), [(FROZEN_NS, False), (FROZEN_NS + 1, True)])
def test_picture_is_too_old_beyond_500_ms(age_ns, is_refused):
    decision = Gate(LIMITS).operator(replace(FORWARD, picture_captured_ns=NOW_NS - age_ns), GOOD, 0.02)
    assert decision.twist.is_zero == is_refused


def test_old_picture_is_named_with_its_age():
    assert picture_refusal(NOW_NS - 640 * MS, NOW_NS) == "picture 640 ms old (at most 500)"


def test_driving_without_a_picture_is_refused():
    decision = Gate(LIMITS).operator(replace(FORWARD, picture_captured_ns=None), GOOD, 0.02)
    assert decision.twist == STILL
    assert decision.reason == "no picture on the screen"


@pytest.mark.parametrize(("age_ns", "is_refused"), [(0, False), (STALE_NS, False), (STALE_NS + 1, True)])
def test_command_is_too_old_beyond_200_ms(age_ns, is_refused):
    assert bool(command_refusal(age_ns)) == is_refused


@given(st.lists(st.tuples(wishes, circumstances, durations), max_size=20))
def test_never_moves_without_every_permission_nor_over_the_limits(steps):
    gate = Gate(LIMITS)
    for wish, now, duration in steps:
        twist = gate.operator(wish, now, duration).twist
        assert is_within(twist, LIMITS)
        allowed = (
            wish is not None
            and now.has_lease
            and now.operator_is_alive
            and not now.emergency_stop
            and now.health.is_running
            and wish.picture_captured_ns is not None
            and now.now_ns - wish.picture_captured_ns <= FROZEN_NS
        )
        assert allowed or twist.is_zero


@given(st.lists(st.tuples(twists, circumstances, durations), max_size=20))
def test_task_never_moves_without_permission_nor_over_the_limits(steps):
    gate = Gate(LIMITS)
    for wanted, now, duration in steps:
        twist = gate.task(wanted, now, duration).twist
        assert is_within(twist, LIMITS)
        assert not refusal(now) or twist.is_zero


@given(st.lists(st.tuples(twists, durations), max_size=20))
def test_stop_is_zero_whatever_went_before(steps):
    gate = Gate(LIMITS)
    for wanted, duration in steps:
        gate.task(wanted, GOOD, duration)
        assert gate.stop("stopped").twist == STILL
        # and speeding up begins anew
        assert abs(gate.task(wanted, GOOD, 0.02).twist.linear) <= 0.8 * 0.02 + 1e-12


@given(small_twists, small_twists, durations)
def test_ramp_limits_speeding_up_and_nothing_else(previous, wanted, duration):
    twist = ramped(previous, wanted, duration, LIMITS)
    assert abs(twist.linear) <= max(abs(previous.linear), LIMITS.linear_acceleration * duration) + (
        LIMITS.linear_acceleration * duration
    )
    assert abs(twist.linear) <= abs(wanted.linear)
    assert abs(twist.angular) <= abs(wanted.angular)
    assert twist.linear * wanted.linear >= 0.0


@given(twists)
def test_limited_twist_keeps_the_bend_of_the_path(wanted):
    slower = limited(wanted, LIMITS)
    assert is_within(slower, LIMITS)
    assert slower.linear * wanted.angular == pytest.approx(slower.angular * wanted.linear, rel=1e-9, abs=1e-6)


def test_twist_within_the_limits_is_left_alone():
    assert limited(Twist(0.3, -1.4), LIMITS) == Twist(0.3, -1.4)


def test_full_speed_takes_as_long_as_the_acceleration_says():
    gate, steps = Gate(LIMITS), 0
    while gate.task(Twist(0.32, 0.0), GOOD, 0.02).twist.linear < 0.32:
        steps += 1
    assert steps == pytest.approx(0.32 / 0.8 / 0.02, abs=1)
