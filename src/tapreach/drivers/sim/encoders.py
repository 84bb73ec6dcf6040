"""Wheel encoders: whole ticks, and slip as far as it is not left to the contact with the floor."""

import math

import numpy as np

from tapreach.drivers.sim.faults import SimFaults


class Encoders:
    """Counts the ticks of both wheels. Faults make them count what did not move the robot."""

    def __init__(self, ticks_per_turn: float, wheel_radius: float, faults: SimFaults, seed: int) -> None:
        self._ticks_per_turn = faults.encoder_ticks_per_turn or ticks_per_turn
        self._radius = wheel_radius
        self._gain = np.array([1.0 + faults.wheel_left_error, 1.0 + faults.wheel_right_error]) / (
            1 - faults.slip
        )
        self._noise = faults.slip_noise
        self._rng = np.random.default_rng([seed, 1])
        self._true_angle = np.zeros(2)
        self._angle = np.zeros(2)

    def read(self, left_angle: float, right_angle: float) -> tuple[int, int]:
        """Take the true wheel angles [rad] and return the ticks counted so far, (left, right)."""
        angle = np.array([left_angle, right_angle])
        moved = angle - self._true_angle
        self._true_angle = angle
        self._angle += moved * self._gain
        if self._noise:
            # Variance grows with the way rolled, so the result does not depend on how often it is read.
            spread = self._noise * np.sqrt(np.abs(moved) / self._radius)
            self._angle += spread * self._rng.standard_normal(2)
        ticks = np.floor(self._angle * self._ticks_per_turn / (2 * math.pi))
        return int(ticks[0]), int(ticks[1])
