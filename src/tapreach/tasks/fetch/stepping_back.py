"""A step back from what is not seen any more, to look for it with more of the room in the picture.

From near, a small error of its place is a large one in the picture, and it is seen from so high that little
looks as before. The robot has just come from behind, where it was seen.
"""

import math

from tapreach.geometry.planar_motion import PlanarStep
from tapreach.tasks.fetch.facing import turn_to_face
from tapreach.tasks.fetch.looking_again import tap_again
from tapreach.tasks.fetch.run import FetchRun
from tapreach.tasks.free_way import way_behind
from tapreach.tasks.task import Tap

BACK = 0.2
"""So far it backs off [m], over floor that it came by."""
LEAST_BACK, _LEAST_TURN = 0.04, math.radians(5.0)


async def found_from_farther(run: FetchRun) -> Tap | None:
    """Back off, turn to where the thing should be, and return a tap on it; None where it is not seen then
    either, or where there is no room for any of it. Raises MotionInterrupted, LinkLost.
    """
    back = min(BACK, way_behind(run.context.poses))
    is_back = back >= LEAST_BACK
    if is_back:
        await run.context.pilot.advance(-back)
    turn = turn_to_face(run) or 0.0
    is_turned = abs(turn) >= _LEAST_TURN
    if is_turned:
        await run.context.pilot.move(PlanarStep(turn, 0.0))
    return await tap_again(run) if is_back or is_turned else None
