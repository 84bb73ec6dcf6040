"""Why no way leads to a thing, in words a person can act on."""

import math

import numpy as np

from tapreach.tasks.fetch.approach import NoWay
from tapreach.tasks.fetch.final_leg import Blocked, Goal
from tapreach.tasks.fetch.obstacle import Obstacle

GOAL_NAME = "the thing itself"
_BACK_STEP = 0.05


def stuck(touched: Obstacle) -> NoWay:
    """Return what is to be said where the robot touches something already."""
    if touched.name == GOAL_NAME:
        return NoWay("it is under the robot or touches it", "drive back until it is well in the picture")
    return NoWay(f"{named(touched)} touches the robot", "drive clear of it first")


def refusal(blocked: Blocked, goal: Goal) -> NoWay:
    """Return what is to be said where the straight way is blocked so, and no other way was found."""
    distance = float(np.hypot(*goal.middle))
    if blocked.of == "side":
        return NoWay("no way to another side of it is free", "")
    if blocked.by is None:
        back = f"{100.0 * _BACK_STEP * math.ceil(max(blocked.missing, 0.01) / _BACK_STEP):.0f} cm"
        return NoWay(f"too near to be seen and gripped: {distance:.2f} m", f"drive back by {back}")
    name = named(blocked.by)
    if blocked.of == "turn":
        return NoWay(f"no room to turn towards it: {name} is too near", "drive clear of it first")
    if blocked.of == "claw":
        beside = np.linalg.norm(blocked.by.centre - goal.middle) - blocked.by.radius - goal.size.width / 2.0
        words = (
            f"{name} stands {1000.0 * max(float(beside), 0.0):.0f} mm beside it: no room for the open claw"
        )
        return NoWay(words, f"take {blocked.by.name} away first")
    return NoWay(f"stands behind {name}, and no way round it is free", f"take {blocked.by.name} away first")


def named(obstacle: Obstacle) -> str:
    """Return such as 'the box at 0.8 m'; `obstacle` as seen from the base."""
    return f"{obstacle.name} at {float(np.hypot(*obstacle.centre)):.1f} m"
