"""Room before the robot to hold up its claw: what stands there would be hit, and turn the robot unseen."""

from collections.abc import Sequence

import numpy as np

from tapreach.robot.config import RobotDescription
from tapreach.tasks.fetch.looking_poses import FARTHEST_AHEAD, FARTHEST_LEFT
from tapreach.tasks.fetch.obstacle import Obstacle
from tapreach.tasks.fetch.run import FetchRun

CLEAR = 0.03
"""The claw stays so far from what is known to stand there [m]: servos that are off bring it 2 cm aside."""

WORTH_BACKING = 0.01
"""A shorter way back [m] is not driven."""


def lacking_room(run: FetchRun) -> float:
    """Return how far the robot should back off to look at its claw clear of what is known to stand around,
    the thing itself included [m]; 0 where there is room.
    """
    thing, description = run.thing(), run.context.description
    seen = [each.squeezed for each in run.around.obstacles(run.here, thing, description)]
    around = [Obstacle.of_thing("it", thing), *run.others, *seen]
    return way_back([each.seen_from(run.here) for each in around], description)


def way_back(around: Sequence[Obstacle], description: RobotDescription) -> float:
    """Return how far to back off from obstacles given in the base frame [m]."""
    mount, shape = description.camera.mount, description.arm.shape()
    half_claw = description.arm.claw_max / 2.0 + shape.finger_thickness
    ahead = mount.forward + FARTHEST_AHEAD + shape.finger_beyond + CLEAR
    aside = FARTHEST_LEFT + half_claw + CLEAR
    back = 0.0
    for each in around:
        for x, y in (each.start, each.end):
            is_before = x > 0.0 and abs(y - mount.left) < aside + each.radius
            back = max(back, ahead + each.radius - float(x)) if is_before else back
    return float(np.clip(back, 0.0, ahead))
