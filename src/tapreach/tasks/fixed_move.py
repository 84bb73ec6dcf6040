"""The paper's move between the first and the second view: always 12 degrees and 20 cm."""

from math import radians

from tapreach.geometry.planar_motion import PlanarStep
from tapreach.robot.config import RobotDescription
from tapreach.tasks.sighting import Sighting

TURN, ADVANCE = radians(12.0), 0.20
_STAYS_WITHIN = 0.9
"""A turn to the left shall not bring the target beyond this share of the picture's width."""


def fixed_step(first: Sighting, description: RobotDescription) -> PlanarStep:
    """Return the turn [rad] and the advance [m] after what was seen in `first`.

    Left as in the paper; right where a turn to the left would take the target out of the picture.
    """
    camera = description.camera.model()
    is_inside = first.pixel.u + TURN * camera.fx < _STAYS_WITHIN * camera.size.width
    return PlanarStep(TURN if is_inside else -TURN, ADVANCE)
