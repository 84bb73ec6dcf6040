"""Steps over some places and the final leg, in the frame of the base at the start."""

from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.tasks.fetch.approach import Leg
from tapreach.tasks.fetch.final_leg import FinalLeg, Goal

HERE = PlanarPose()
Route = tuple[tuple[PlanarStep, ...], FinalLeg]


def legs_of(route: Route, goal: Goal) -> list[Leg]:
    """Return the legs up to the last look."""
    legs, pose = [], HERE
    for step in (*route[0], route[1].first):
        turned = pose.after(PlanarStep(step.turn, 0.0))
        pose = pose.after(step)
        legs.append(Leg(step, 1.0, goal.sees((turned, pose))))
    return legs
