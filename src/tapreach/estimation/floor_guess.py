"""Where a thing stands, from one view: its foot taken to be on the floor."""

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.estimation.view_model import pixel_weights
from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray, finite, not_negative, positive
from tapreach.geometry.pixel import Pixel, require_inside
from tapreach.geometry.pose import skew

_CLEAR_OF_HORIZON = 3.0  # sigmas of the angle below the horizon; nearer to it the range has no far end


class FloorStatus(StrEnum):
    """on_floor: a position. near_horizon: too flat a ray for one. above_horizon: the ray never lands."""

    ON_FLOOR = "on_floor"
    NEAR_HORIZON = "near_horizon"
    ABOVE_HORIZON = "above_horizon"


@dataclass(frozen=True)
class FloorGuess:
    """Where the ray through a pixel meets the floor; a guess, as the thing may be above it.

    point_in_base (3,) [m] and its covariance (3, 3) [m²], None unless on_floor. depression: angle of the ray
    below the horizon [rad]. range: from the camera [m].
    """

    status: FloorStatus
    reason: str
    depression: float
    point_in_base: FloatArray | None
    point_cov_in_base: FloatArray | None
    range: float | None


def floor_guess(
    pixel: Pixel,
    camera: Camera,
    base_from_camera: RigidTransform,
    *,
    pixel_sigma: float = 3.0,
    angle_sigma: float = math.radians(1.0),
    height_sigma: float = 0.005,
    floor_height: float = 0.0,
) -> FloorGuess:
    """Return the place on the floor plane under `pixel`.

    angle_sigma [rad]: of the mount's pitch, yaw and roll each. height_sigma [m]: of camera height and floor
    together. floor_height [m]: in the base frame. Raises InputError for a pixel outside the picture.
    """
    require_inside(pixel, camera.size)
    positive("pixel_sigma", pixel_sigma)
    not_negative("angle_sigma", angle_sigma)
    not_negative("height_sigma", height_sigma)
    normalised = camera.normalise([pixel.to_array()])
    in_camera = np.array([*normalised[0], 1.0])
    rotation = base_from_camera.rotation.as_matrix()
    direction = rotation @ in_camera / np.linalg.norm(in_camera)
    depression = -math.asin(max(-1.0, min(1.0, float(direction[2]))))
    if depression <= 0.0:
        return FloorGuess(
            FloorStatus.ABOVE_HORIZON,
            "the tap is above the horizon: no floor there",
            depression,
            None,
            None,
            None,
        )
    if depression < _CLEAR_OF_HORIZON * math.hypot(angle_sigma, pixel_sigma / camera.fy):
        reason = "the tap is so near the horizon that the floor there may be any distance away"
        return FloorGuess(FloorStatus.NEAR_HORIZON, reason, depression, None, None, None)
    position = np.asarray(base_from_camera.translation)
    distance = (finite("floor_height", floor_height) - float(position[2])) / float(direction[2])
    if distance <= 0.0:
        return FloorGuess(
            FloorStatus.ABOVE_HORIZON, "the camera is below the floor", depression, None, None, None
        )
    # A change of direction moves the point along the floor: oblique projection along the ray.
    onto_floor = np.eye(3) - np.outer(direction, [0.0, 0.0, 1.0]) / direction[2]
    by_pixel = np.linalg.inv(pixel_weights(camera, normalised)[0])
    slant = float(np.linalg.norm(in_camera))
    by_pixel_on_floor = distance / slant * onto_floor @ rotation[:, :2] @ by_pixel
    by_angle = -distance * onto_floor @ skew(direction)
    by_height = onto_floor[:, 2]
    covariance = (
        pixel_sigma**2 * by_pixel_on_floor @ by_pixel_on_floor.T
        + angle_sigma**2 * by_angle @ by_angle.T
        + height_sigma**2 * np.outer(by_height, by_height)
    )
    point = position + distance * direction
    return FloorGuess(
        FloorStatus.ON_FLOOR, "if it stands on the floor", depression, point, covariance, distance
    )
