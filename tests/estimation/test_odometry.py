"""Encoder counts to poses."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.errors import InputError
from tapreach.estimation.odometry import WheelOdometry
from tapreach.geometry.planar_motion import PlanarPose

RADIUS, TRACK, TICKS = 0.033, 0.17, 1440
METRES_PER_TICK = 2 * math.pi * RADIUS / TICKS


def odometry():
    wheels = WheelOdometry(RADIUS, TRACK, TICKS)
    wheels.update(1000, -500, 0)
    return wheels


def test_first_counts_are_where_it_starts():
    assert odometry().reading.pose == PlanarPose()


def test_equal_counts_drive_straight_ahead():
    reading = odometry().update(1000 + 1440, -500 + 1440, 2_000_000_000)
    assert reading.pose.x == pytest.approx(2 * math.pi * RADIUS)
    assert (reading.pose.y, reading.pose.heading) == (0.0, 0.0)
    assert reading.speed == pytest.approx(math.pi * RADIUS)


def test_right_wheel_ahead_turns_left_about_the_left_wheel():
    ticks = 2000
    reading = odometry().update(1000, -500 + ticks, 10**9)
    turn = ticks * METRES_PER_TICK / TRACK
    assert reading.turn_rate == pytest.approx(turn)
    assert reading.pose.heading == pytest.approx(turn)
    # The left wheel stands at (0, track/2); the base swings round it.
    assert reading.pose.x == pytest.approx(TRACK / 2 * math.sin(turn))
    assert reading.pose.y == pytest.approx(TRACK / 2 * (1 - math.cos(turn)))


@given(st.lists(st.tuples(st.integers(-300, 300), st.integers(-300, 300)), max_size=20))
def test_driving_back_over_the_same_counts_returns(moves):
    wheels, left, right, now = odometry(), 1000, -500, 0
    for a, b in moves + [(-a, -b) for a, b in reversed(moves)]:
        left, right, now = left + a, right + b, now + 20_000_000
        wheels.update(left, right, now)
    pose = wheels.reading.pose
    assert (pose.x, pose.y, pose.heading) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


def test_counter_that_wraps_at_32_bits_drives_on():
    wheels = WheelOdometry(RADIUS, TRACK, TICKS)
    wheels.update(2**31 - 10, 2**31 - 10, 0)
    reading = wheels.update(-(2**31) + 10, -(2**31) + 10, 10**9)
    assert reading.pose.x == pytest.approx(20 * METRES_PER_TICK)


def test_time_running_backwards_is_refused_and_changes_nothing():
    wheels = odometry()
    before = wheels.update(1100, -400, 10**9)
    with pytest.raises(InputError, match="before the last reading at 1000000000"):
        wheels.update(1200, -300, 10**9 - 1)
    assert wheels.reading == before


def test_wheels_that_move_in_no_time_are_refused():
    wheels = odometry()
    with pytest.raises(InputError, match="captured_ns 0"):
        wheels.update(1001, -500, 0)


@pytest.mark.parametrize("name", ["wheel_radius", "track_width", "ticks_per_turn"])
@pytest.mark.parametrize("bad", [0.0, -1.0, math.nan])
def test_size_that_cannot_be_is_refused_by_name(name, bad):
    sizes = {"wheel_radius": RADIUS, "track_width": TRACK, "ticks_per_turn": TICKS, name: bad}
    with pytest.raises(InputError, match=name):
        WheelOdometry(**sizes)
