"""Turn by an angle, advance by a distance: on odometry, with ramps, to a stop."""

import math
from dataclasses import replace

from tapreach.control.motion import Progress, Senses
from tapreach.control.slide import Slide, SlideProfile
from tapreach.robot.config import BaseSection
from tapreach.robot.messages import STILL, Odometry, Twist

GENTLE = 0.5
"""Share of the base's speed and acceleration that tasks use: gentle driving slips less."""
STEERING_RATE = 2.0
"""Turn rate per heading error while advancing [1/s]."""


NEAR_ENOUGH, NEAR_ENOUGH_TURN = 0.002, math.radians(0.5)
"""What is not worth creeping for [m], [rad]: what counts is what odometry says was done."""
CREEP, CREEP_TURN = 0.02, 0.1
"""Least speeds [m/s], [rad/s]: slower, geared hobby motors stick."""
ABOUT, ABOUT_TURN = 0.012, math.radians(2.0)
"""Near enough [m], [rad] where it matters little where a move ends."""
BRISK = 6.0
"""Speed per remaining way [1/s] of such a move: it need not land softly."""


def advance_profile(base: BaseSection) -> SlideProfile:
    """Return how this base advances; it comes no nearer than one tick."""
    tick = 2.0 * math.pi * base.wheel_radius / base.ticks_per_turn
    speed, acceleration = GENTLE * base.max_linear, GENTLE * base.max_linear_acceleration
    return SlideProfile(speed, acceleration, max(NEAR_ENOUGH, tick), min(CREEP, speed))


def turn_profile(base: BaseSection) -> SlideProfile:
    """Return how this base turns on the spot; it comes no nearer than one tick of both wheels."""
    tick = 4.0 * math.pi * base.wheel_radius / base.ticks_per_turn / base.track_width
    speed, acceleration = GENTLE * base.max_angular, GENTLE * base.max_angular_acceleration
    return SlideProfile(speed, acceleration, max(NEAR_ENOUGH_TURN, tick), min(CREEP_TURN, speed))


def about(profile: SlideProfile, near_enough: float) -> SlideProfile:
    """Return the profile of a move that may end `near_enough` from its goal, and not at rest."""
    tolerance = max(profile.tolerance, near_enough)
    return replace(profile, tolerance=tolerance, landing_rate=BRISK, settle_ns=0)


def slowed(base: BaseSection, share: float) -> BaseSection:
    """Return the base as it drives near things: this share of its speeds, accelerations as they are."""
    return base.model_copy(
        update={"max_linear": share * base.max_linear, "max_angular": share * base.max_angular}
    )


class Turn:
    """Turn on the spot by `angle` [rad, left positive] from where the first odometry finds the base.

    is_exact: come to rest near the angle; otherwise end when it is about reached.
    """

    moves_arm = False

    def __init__(self, angle: float, base: BaseSection, is_exact: bool = True) -> None:
        self._angle = angle
        profile = turn_profile(base)
        self._slide = Slide(angle, profile if is_exact else about(profile, ABOUT_TURN))
        self._start: Odometry | None = None
        self._turned = 0.0

    @property
    def progress(self) -> Progress:
        """See Motion."""
        return self._slide.progress

    @property
    def reason(self) -> str:
        """See Motion."""
        if self.progress is not Progress.GIVEN_UP:
            return ""
        done, wanted = math.degrees(self._turned), math.degrees(self._angle)
        return f"the wheels do not turn the base: {done:.1f}° of {wanted:.1f}° done"

    def step(self, senses: Senses, now_ns: int) -> Twist:
        """See Motion."""
        if senses.odometry is None:
            return STILL
        self._start = self._start or senses.odometry
        self._turned = senses.odometry.world_from_base.heading - self._start.world_from_base.heading
        return Twist(0.0, self._slide.step(self._turned, now_ns))


class Advance:
    """Drive straight by `distance` [m, negative is back] along the heading of the first odometry.

    is_exact: come to rest near the distance; otherwise end when it is about reached.
    """

    moves_arm = False

    def __init__(self, distance: float, base: BaseSection, is_exact: bool = True) -> None:
        self._distance = distance
        profile = advance_profile(base)
        self._slide = Slide(distance, profile if is_exact else about(profile, ABOUT))
        self._start: Odometry | None = None
        self._driven = 0.0

    @property
    def progress(self) -> Progress:
        """See Motion."""
        return self._slide.progress

    @property
    def reason(self) -> str:
        """See Motion."""
        if self.progress is not Progress.GIVEN_UP:
            return ""
        return f"the wheels do not move the base: {self._driven:.3f} m of {self._distance:.3f} m done"

    def step(self, senses: Senses, now_ns: int) -> Twist:
        """See Motion."""
        if senses.odometry is None:
            return STILL
        self._start = self._start or senses.odometry
        way = self._start.world_from_base.between(senses.odometry.world_from_base)
        self._driven = way.x
        linear = self._slide.step(way.x, now_ns)
        return Twist(linear, -STEERING_RATE * way.heading if linear else 0.0)
