"""What is too high for the claw: told from the tapped line of sight alone, before anything moves, or from the
place once it is located.
"""

import math

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.ray import Ray
from tapreach.robot.config import RobotDescription
from tapreach.tasks.candidate_moves import NEAREST
from tapreach.tasks.fetch.claw_room import Claw
from tapreach.tasks.fetch.reach import SURE, Judgement, Verdict, highest_grip

ONE_SIDED_99 = 2.33
"""Sigmas of the mount; what can be reached is taken for too high by one robot in a hundred at most."""
WORTH_SAYING = 1.0
"""A line of sight that is within reach for longer [m] tells nothing about height."""
ADVICE = "bring it lower; where it stands on the floor, tap it lower down"


def within_reach_up_to(ray: Ray, highest: float, tilt_sigma: float, height_sigma: float) -> float:
    """Return up to which distance from the camera [m] a tapped place may be no higher than `highest` [m].

    0 where it is higher at any distance; infinite where the line of sight may be level or fall. ray: in a
    frame whose z is the height above the floor. tilt_sigma [rad], height_sigma [m]: of the camera's mount.
    """
    level = math.hypot(float(ray.direction[0]), float(ray.direction[1]))
    elevation = math.atan2(float(ray.direction[2]), level) - ONE_SIDED_99 * tilt_sigma
    to_rise = highest - float(ray.origin[2]) + ONE_SIDED_99 * height_sigma
    if elevation <= 0.0:
        return math.inf
    return max(0.0, to_rise) / math.sin(elevation)


def tap_within_reach_up_to(pixel: Pixel, description: RobotDescription) -> float:
    """Return `within_reach_up_to` of a tapped pixel, for the robot's own arm [m]."""
    camera, mount = description.camera.model(), description.camera.mount
    base_from_camera = mount.base_from_camera()
    direction = base_from_camera.rotation.apply(camera.unproject([pixel.to_array()])[0])
    ray = Ray(base_from_camera.translation, direction)
    highest = highest_grip(0.0, Claw.of(description))
    tilt_sigma = math.radians(mount.angle_sigma_deg)
    return math.inf if highest is None else within_reach_up_to(ray, highest, tilt_sigma, mount.position_sigma)


def refused_by_sight(within: float, at_least: float = NEAREST) -> str:
    """Return why a tapped place that is within reach up to `within` [m], and `at_least` so far away, is not
    fetched; '' where it may be.
    """
    if within <= at_least:
        return f"too high: however near it is, the claw does not reach up to it; {ADVICE}"
    return ""


def refused_unlocated(within: float, at_least: float = NEAREST) -> str:
    """Return the same for a place of which it was tried in vain to find out how far away it is."""
    if within <= at_least or within > WORTH_SAYING:
        return refused_by_sight(within, at_least)
    words = f"too high for the claw, unless it is nearer than {within:.1f} m, which cannot be told from here"
    return f"{words}: drive back until it is well in the picture, and tap it again"


def refused_by_place(point_in_world: FloatArray, cov_in_world: FloatArray, claw: Claw) -> Judgement | None:
    """Return the refusal of a located place (3,) [m] that with two sigmas to spare is above all heights at
    which the claw can grip; None where it may be lower. It says nothing of what reaches down from there.
    """
    height, sd = float(point_in_world[2]), math.sqrt(max(0.0, float(np.asarray(cov_in_world)[2, 2])))
    highest = highest_grip(0.0, claw)
    if highest is None or height - SURE * sd <= highest:
        return None
    tapped = f"it was tapped {1000.0 * height:.0f} mm above the floor"
    words = f"too high: the claw reaches {1000.0 * highest:.0f} mm, {tapped}"
    return Judgement(Verdict.NO, words, ADVICE, None)
