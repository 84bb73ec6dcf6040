"""Bringing one coordinate to a goal: trapezoidal speed, a soft landing, and an end."""

import math
from dataclasses import dataclass

from tapreach.control.motion import Progress
from tapreach.robot.clock import MS, SECOND

STALL_NS = 1 * SECOND
SETTLE_NS = 120 * MS
LANDING_RATE = 2.5
"""Speed per remaining way near the goal [1/s]: slow against motors that answer within 0.15 s."""
CLOSE = 5.0
"""Tolerances from the goal within which wheels that friction holds have arrived."""


@dataclass(frozen=True, slots=True)
class SlideProfile:
    """Speed and acceleration to use, what is near enough, and the least speed that overcomes friction.

    In metres or radians. landing_rate [1/s]: speed per remaining way near the goal. settle_ns: how long the
    coordinate must stay near enough; 0 ends with the speed that the landing still has.
    """

    speed: float
    acceleration: float
    tolerance: float
    creep: float
    landing_rate: float = LANDING_RATE
    settle_ns: int = SETTLE_NS


class Slide:
    """Drives a coordinate from 0 to `goal`. Feed `step` with the measured coordinate; send what it returns.

    Arrives when the coordinate stays within `tolerance` of the goal, without command, for `settle_ns`. Each
    time the goal was passed twice the tolerance grows by itself once more: a motor with play cannot hunt for
    ever.
    When the coordinate does not come nearer for 1 s although it should, that is an arrival close to the goal
    (where friction holds it; odometry knows what was really done) and a reason to give up far from it.
    """

    def __init__(self, goal: float, profile: SlideProfile) -> None:
        self._goal = goal
        self._profile = profile
        self._speed = 0.0
        self._stepped_ns: int | None = None
        self._best = math.inf
        self._best_ns = 0
        self._inside_since_ns: int | None = None
        self._passes = 0
        self._side = math.copysign(1.0, goal)
        self.progress = Progress.MOVING

    def step(self, measured: float, now_ns: int) -> float:
        """Return the speed to send now."""
        elapsed = 0.0 if self._stepped_ns is None else (now_ns - self._stepped_ns) / SECOND
        self._stepped_ns = now_ns
        remaining = self._goal - measured
        self._count_passes(remaining)
        if abs(remaining) <= self._tolerance:
            self._settle(now_ns)
            self._speed = 0.0
        else:
            self._inside_since_ns = None
            self._watch_for_stall(abs(remaining), now_ns)
            self._speed = self._next_speed(remaining, elapsed)
        return self._speed if self.progress is Progress.MOVING else 0.0

    @property
    def _tolerance(self) -> float:
        # A hair above, since ticks and goal are sums of rounded numbers.
        return self._profile.tolerance * (1.001 + self._passes // 2)

    def _count_passes(self, remaining: float) -> None:
        if abs(remaining) > self._profile.tolerance and remaining * self._side < 0.0:
            self._side = -self._side
            self._passes += 1
            self._best = math.inf

    def _settle(self, now_ns: int) -> None:
        if self._inside_since_ns is None:
            self._inside_since_ns = now_ns
        if now_ns - self._inside_since_ns >= self._profile.settle_ns:
            self.progress = Progress.ARRIVED

    def _watch_for_stall(self, distance: float, now_ns: int) -> None:
        if distance < self._best - 0.25 * self._profile.tolerance:
            self._best, self._best_ns = distance, now_ns
        elif now_ns - self._best_ns >= STALL_NS:
            is_close = distance <= CLOSE * self._tolerance
            self.progress = Progress.ARRIVED if is_close else Progress.GIVEN_UP

    def _next_speed(self, remaining: float, elapsed: float) -> float:
        profile, distance = self._profile, abs(remaining)
        landing = min(math.sqrt(2.0 * profile.acceleration * distance), profile.landing_rate * distance)
        wanted = min(profile.speed, max(landing, profile.creep))
        before = abs(self._speed) if self._speed * remaining > 0.0 else 0.0
        return math.copysign(min(wanted, before + profile.acceleration * elapsed), remaining)
