"""Turn and advance on a simulated base whose motors answer late and whose encoders count in steps."""

import math
from itertools import pairwise

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tapreach.control.motion import Motion, Progress, Senses
from tapreach.control.relative_move import Advance, Turn, advance_profile, turn_profile
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.clock import MS, SECOND
from tapreach.robot.config import BaseSection
from tapreach.robot.messages import STILL, Odometry, Twist

BASE = BaseSection(wheel_radius=0.033, track_width=0.17, ticks_per_turn=1440)
PERIOD = 0.02


class LaggingBase:
    """Speeds follow the command with a first-order lag; odometry is made of whole encoder ticks."""

    def __init__(self, lag: float, base: BaseSection = BASE, gain: float = 1.0) -> None:
        self.metres_per_tick = 2.0 * math.pi * base.wheel_radius / base.ticks_per_turn
        self.track = base.track_width
        self.follow = 1.0 - math.exp(-PERIOD / lag)
        self.gain = gain
        self.speeds = [0.0, 0.0]
        self.way = [0.0, 0.0]
        self.ticks = [0, 0]
        self.pose = PlanarPose(0.3, -0.2, 0.7)
        self.now_ns = SECOND

    def run(self, twist: Twist) -> Odometry:
        wanted = (
            twist.linear - twist.angular * self.track / 2,
            twist.linear + twist.angular * self.track / 2,
        )
        moved = [0, 0]
        for side in (0, 1):
            self.speeds[side] += self.follow * (self.gain * wanted[side] - self.speeds[side])
            self.way[side] += self.speeds[side] * PERIOD
            ticks = math.floor(self.way[side] / self.metres_per_tick)
            moved[side] = ticks - self.ticks[side]
            self.ticks[side] = ticks
        left, right = (count * self.metres_per_tick for count in moved)
        self.pose = self.pose.after_arc((left + right) / 2, (right - left) / self.track)
        self.now_ns += round(PERIOD * SECOND)
        return Odometry(self.now_ns, self.pose, STILL, 0.0)


def carried_out(motion: Motion, base: LaggingBase, longest_s: float = 60.0) -> tuple[Odometry, list[Twist]]:
    reading = base.run(STILL)
    twists = []
    while motion.progress is Progress.MOVING:
        assert base.now_ns < longest_s * SECOND, "the motion does not end"
        twists.append(motion.step(Senses(reading), base.now_ns))
        reading = base.run(twists[-1])
    return reading, twists


lags = st.floats(0.01, 0.15)


@settings(deadline=None, max_examples=60)
@given(angle=st.floats(-4.0, 4.0), lag=lags)
@example(angle=0.0, lag=0.1)
@example(angle=0.001, lag=0.1)
def test_turn_ends_near_enough_to_the_angle(angle, lag):
    base = LaggingBase(lag)
    start = base.pose.heading
    reading, twists = carried_out(Turn(angle, BASE), base)
    assert abs(reading.world_from_base.heading - start - angle) <= 2.01 * turn_profile(BASE).tolerance
    assert all(twist.linear == 0.0 for twist in twists)
    assert twists[-1] == STILL


@settings(deadline=None, max_examples=60)
@given(distance=st.floats(-1.0, 1.0), lag=lags)
@example(distance=0.0, lag=0.1)
def test_advance_ends_near_enough_to_the_distance(distance, lag):
    base = LaggingBase(lag)
    start = base.pose
    reading, twists = carried_out(Advance(distance, BASE), base)
    way = start.between(reading.world_from_base)
    assert abs(way.x - distance) <= 2.01 * advance_profile(BASE).tolerance
    assert twists[-1] == STILL


@settings(deadline=None, max_examples=30)
@given(distance=st.floats(-1.0, 1.0), lag=lags)
def test_advance_speeds_up_gently_and_stays_below_its_speed(distance, lag):
    profile = advance_profile(BASE)
    _, twists = carried_out(Advance(distance, BASE), LaggingBase(lag))
    speeds = [0.0, *(abs(twist.linear) for twist in twists)]
    assert max(speeds) <= profile.speed + 1e-12
    rises = [after - before for before, after in pairwise(speeds)]
    assert max(rises) <= profile.acceleration * PERIOD + 1e-12


@settings(deadline=None, max_examples=60)
@given(distance=st.floats(0.05, 1.0), back=st.booleans(), lag=lags)
def test_advance_to_about_there_is_quicker_and_ends_within_three_centimetres(distance, back, lag):
    distance = -distance if back else distance
    exact, loose = LaggingBase(lag), LaggingBase(lag)
    start = loose.pose
    carried_out(Advance(distance, BASE), exact)
    _, twists = carried_out(Advance(distance, BASE, is_exact=False), loose)
    assert loose.now_ns < exact.now_ns - 0.25 * SECOND
    for _ in range(50):
        reading = loose.run(STILL)
    assert abs(start.between(reading.world_from_base).x - distance) <= 0.03
    assert twists[-1] == STILL


@settings(deadline=None, max_examples=60)
@given(angle=st.floats(-2.0, 2.0).filter(lambda angle: abs(angle) > 0.1), lag=lags)
def test_turn_to_about_there_ends_within_five_degrees(angle, lag):
    base = LaggingBase(lag)
    start = base.pose.heading
    carried_out(Turn(angle, BASE, is_exact=False), base)
    for _ in range(50):
        reading = base.run(STILL)
    assert abs(reading.world_from_base.heading - start - angle) <= math.radians(5.0)


def test_overshoot_of_a_lagging_base_stays_below_two_percent():
    base = LaggingBase(0.15)
    start, most = base.pose, 0.0
    motion, reading = Advance(0.5, BASE), base.run(STILL)
    while motion.progress is Progress.MOVING:
        reading = base.run(motion.step(Senses(reading), base.now_ns))
        most = max(most, start.between(reading.world_from_base).x)
    assert most < 0.51


@pytest.mark.parametrize("sticks_below", [0.005, 0.015, 0.024])
@pytest.mark.parametrize("distance", [0.22, -0.3, 0.05])
def test_wheels_that_friction_holds_close_to_the_goal_have_arrived(distance, sticks_below):
    base = LaggingBase(0.05)
    start = base.pose
    motion, reading = Advance(distance, BASE), base.run(STILL)
    while motion.progress is Progress.MOVING:
        twist = motion.step(Senses(reading), base.now_ns)
        reading = base.run(twist if abs(twist.linear) >= sticks_below else STILL)
    assert motion.progress is Progress.ARRIVED
    assert abs(start.between(reading.world_from_base).x - distance) <= 0.0101


def test_base_pushed_aside_while_advancing_is_steered_back():
    base = LaggingBase(0.05)
    start = base.pose
    motion, reading = Advance(0.5, BASE), base.run(STILL)
    for step in range(2000):
        if motion.progress is not Progress.MOVING:
            break
        if step == 40:
            base.pose = base.pose.compose(PlanarPose(0.0, 0.0, 0.05))
        reading = base.run(motion.step(Senses(reading), base.now_ns))
    assert motion.progress is Progress.ARRIVED
    assert abs(start.between(reading.world_from_base).heading) < 0.01


@pytest.mark.parametrize("motion", [Turn(0.5, BASE), Advance(-0.2, BASE)])
def test_wheels_that_do_not_turn_are_given_up_after_a_second_with_a_reason(motion):
    base = LaggingBase(0.1, gain=0.0)
    began_ns = base.now_ns
    carried_out(motion, base)
    assert motion.progress is Progress.GIVEN_UP
    assert 1.0 <= (base.now_ns - began_ns) / SECOND < 1.2
    assert "0.0° of 28.6°" in motion.reason or "0.000 m of -0.200 m" in motion.reason
    assert motion.step(Senses(base.run(STILL)), base.now_ns + MS).is_zero


def test_nothing_moves_before_the_first_odometry():
    assert Turn(1.0, BASE).step(Senses(), SECOND) == STILL
    assert Advance(1.0, BASE).step(Senses(), SECOND) == STILL
