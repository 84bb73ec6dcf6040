"""A look back at the thing, on a way round that has taken it out of the picture.

What is not seen for a while is known ever worse, and seen again from quite another side it looks otherwise.
"""

import math

import numpy as np

from tapreach.geometry.planar_motion import PlanarStep, wrapped
from tapreach.tasks.candidate_moves import Grid
from tapreach.tasks.clear_moves import ClearMoves
from tapreach.tasks.fetch.approach import Leg
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
    point, here = run.thing().point_in_world, run.here
    off = point[:2] - [here.x, here.y]
    turn = wrapped(math.atan2(off[1], off[0]) - here.heading)
    if unseen_way < UNSEEN_WAY or float(np.hypot(*off)) < _NEAREST or abs(turn) > _MOST_TURN:
        return None
    around = (*run.others, *run.around.in_world())
    room = ClearMoves(around, [point], here, run.context.description)
    is_clear = room.of(Grid(np.array([turn]), np.array([0.0])))
    return Leg(PlanarStep(turn, 0.0), 1.0, sees_thing=True) if is_clear.all() else None
