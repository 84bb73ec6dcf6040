"""The paper's own procedure on the same tap: 12 degrees, 20 cm, and its formula; beside it our estimator."""

import math
from dataclasses import dataclass

from tapreach.estimation.two_tap import two_tap_from_pixels
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.config import RobotDescription
from tapreach.tasks.estimating import estimate
from tapreach.tasks.fixed_move import fixed_step
from tapreach.tasks.follower import Follower, TargetLost, thinned
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.task import Tap, TaskContext


@dataclass
class FixedMove:
    """A task: turn by 12 degrees and drive 20 cm; the tapped place is followed, which stands for the second
    tap.

    sightings: the tapped frame and the last stop. The estimate rests on these, and on the frames from which
    the background was seen.
    """

    tap: Tap
    kind = "fixed move"

    def __post_init__(self) -> None:
        self.sightings: list[Sighting] = []

    async def run(self, context: TaskContext) -> str:
        """See Task. Raises TargetLost when it is not seen at the end."""
        follower = Follower(context, self.tap, key=1)
        try:
            first = await follower.open()
            await follower.catch_up()
            arm = context.description.arm.standard.pose()
            await follower.during(context.pilot.move_arm(arm), _nothing)
            step = fixed_step(first, context.description)
            await follower.during(context.pilot.turn(step.turn), _nothing)
            await follower.during(context.pilot.advance(step.advance), _nothing)
            last = await follower.look()
            if last is None:
                raise TargetLost(f"lost the tapped place: {follower.loss}")
            self.sightings = [first, last]
            views = thinned(self.sightings, follower.sightings, math.inf, math.inf)
            await context.compute.call(estimate, views, context.description, False)
        finally:
            await follower.close()
        return "done"


async def _nothing() -> None:
    pass


def paper_range(first: Sighting, last: Sighting, description: RobotDescription) -> float | None:
    """Return the distance by the paper's formula (eq. 7) from the camera [m]; None where it has none."""
    way = first.world_from_base.between(last.world_from_base)
    step = PlanarStep(way.heading, _advanced(way))
    found = two_tap_from_pixels(description.camera.model(), first.pixel, last.pixel, step)
    position = found.position
    return None if position is None else float((position.in_first**2).sum() ** 0.5)


def _advanced(way: PlanarPose) -> float:
    return float((way.x**2 + way.y**2) ** 0.5)
