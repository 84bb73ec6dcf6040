"""How long turns and advances take, by the speeds at which control makes them."""

import numpy as np

from tapreach.control.relative_move import advance_profile, turn_profile
from tapreach.control.slide import SlideProfile
from tapreach.geometry.planar_motion import PlanarStep
from tapreach.robot.clock import SECOND
from tapreach.robot.config import BaseSection

_PARTS = 80


def slide_seconds(way: float, profile: SlideProfile) -> float:
    """Return how long `control.slide` takes for a way of one coordinate [m or rad], at rest before and after.

    It speeds up evenly and lands with a speed in proportion to what remains: the integral of 1 / speed.
    """
    whole = abs(way) - profile.tolerance
    if whole <= 0.0:
        return 0.0
    # Parts that grow from the start on: 1 / speed is without bound at rest, its integral is not.
    edges = whole * np.linspace(0.0, 1.0, _PARTS + 1) ** 2
    done, lengths = (edges[1:] + edges[:-1]) / 2.0, np.diff(edges)
    remaining = abs(way) - done
    landing = np.minimum(np.sqrt(2.0 * profile.acceleration * remaining), profile.landing_rate * remaining)
    wanted = np.minimum(profile.speed, np.maximum(landing, profile.creep))
    speeds = np.minimum(wanted, np.sqrt(2.0 * profile.acceleration * done))
    return float(np.sum(lengths / speeds)) + profile.settle_ns / SECOND


def step_seconds(step: PlanarStep, base: BaseSection) -> float:
    """Return how long this base takes for a turn on the spot and the advance after it."""
    turned = slide_seconds(step.turn, turn_profile(base))
    return turned + slide_seconds(step.advance, advance_profile(base))
