"""What cannot stand before the thing, since the thing is seen past it down to the floor."""

import numpy as np

from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.fetch.obstacle import Obstacle
from tapreach.tasks.fetch.thing import SAME_SIDE, Thing, ThingSize

_LOW = 0.04
"""Nothing that stands is lower than this [m]: over what is, the thing's foot may be seen."""


def is_seen_past(obstacle: Obstacle, here: PlanarPose, thing: Thing, description: RobotDescription) -> bool:
    """Tell whether an obstacle would stand before the thing's foot, which was seen from about this side.

    What is found there is the floor's gleam or the thing's shadow.
    """
    size = thing.size
    if not isinstance(size, ThingSize) or size.foot > 0.0:
        return False
    if size.aside_of_looks(size.sight_from(here)) > SAME_SIDE:
        return False
    mount = description.camera.mount
    camera = here.compose(PlanarPose(mount.forward, mount.left, 0.0))
    way = size.axis_in_world[:2] - [camera.x, camera.y]
    to_front = float(np.hypot(*way)) - size.width / 2.0
    ahead = way / max(float(np.hypot(*way)), 1e-9)
    off = obstacle.centre - [camera.x, camera.y]
    along, aside = float(off @ ahead), float(ahead[0] * off[1] - ahead[1] * off[0])
    is_before = 0.0 < along < to_front and abs(aside) < size.width / 2.0
    return is_before and mount.up * (1.0 - along / to_front) < _LOW
