"""A look back at the thing, on a way round that has taken it out of the picture.

What is not seen for a while is known ever worse, and seen again from quite another side it looks otherwise.
"""

import math

import numpy as np

from tapreach.geometry.planar_motion import PlanarStep
from tapreach.tasks.fetch.approach import Leg
from tapreach.tasks.fetch.facing import turn_to_face
from tapreach.tasks.fetch.run import FetchRun

UNSEEN_WAY = 0.35
"""After so much of a way [m] without a sight of the thing it is looked at."""
_NEAREST = 0.35
"""What is nearer [m] is seen by the last legs anyway."""
_MOST_TURN = math.radians(120.0)


def glance(run: FetchRun, unseen_way: float) -> Leg | None:
    """Return a turn on the spot towards the thing; None where it was seen lately, is near, or where what is
    known to stand around leaves no room.

    unseen_way: driven since it was seen [m].
    """
    off = run.thing().point_in_world[:2] - [run.here.x, run.here.y]
    if unseen_way < UNSEEN_WAY or float(np.hypot(*off)) < _NEAREST:
        return None
    turn = turn_to_face(run)
    if turn is None or abs(turn) > _MOST_TURN:
        return None
    return Leg(PlanarStep(turn, 0.0), 1.0, sees_thing=True)
