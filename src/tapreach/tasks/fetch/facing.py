"""A turn on the spot towards the thing, where what is known to stand around leaves room for it."""

import math

import numpy as np

from tapreach.geometry.planar_motion import wrapped
from tapreach.tasks.candidate_moves import Grid
from tapreach.tasks.clear_moves import ClearMoves
from tapreach.tasks.fetch.run import FetchRun


def turn_to_face(run: FetchRun) -> float | None:
    """Return by how much the base turns to have the thing straight ahead [rad]; None for no room."""
    point, here = run.thing().point_in_world, run.here
    turn = wrapped(math.atan2(point[1] - here.y, point[0] - here.x) - here.heading)
    around = (*run.others, *run.around.in_world())
    room = ClearMoves(around, [point], here, run.context.description)
    return turn if room.of(Grid(np.array([turn]), np.array([0.0]))).all() else None
