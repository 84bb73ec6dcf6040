"""The faults that a robot has when it locates, drawn anew for every tap, and the file that tells of them.

Odometry 1 %: all distances are told wrong by one factor, all turns by another, each normal with sigma 1 %.
Slip 2 %: each wheel on its own loses a constant share of its turning, evenly between 0 and 2 %; the wheel
radius of the file was measured on such floors, with 1 %. Mount: turned by exactly 1 degree about an axis and
moved by exactly 5 mm in a direction that are drawn evenly from the sphere. JPEG quality 80. A scene's own
faults (darkness: blur and noise) come on top.
"""

import math

import numpy as np

from tapreach.drivers.sim.faults import SimFaults
from tapreach.geometry.finite import FloatArray
from tapreach.resources import resource_path
from tapreach.robot.config import RobotDescription, load_robot

ODOMETRY_SIGMA = 0.01
MOST_SLIP = 0.02
MOUNT_TURN_DEG = 1.0
MOUNT_SHIFT = 0.005
"""[m]"""
JPEG_QUALITY = 80


def draw_faults(of_scene: SimFaults, rng: np.random.Generator) -> SimFaults:
    """Return the faults of one robot, beside those `of_scene`."""
    distance, turn = ODOMETRY_SIGMA * rng.standard_normal(2)
    left, right = (_slipping(distance, share) for share in rng.uniform(0.0, MOST_SLIP, 2))
    pitch, yaw, roll = map(float, MOUNT_TURN_DEG * _direction(rng))
    forward, sideways, up = map(float, MOUNT_SHIFT * _direction(rng))
    return of_scene.merged(
        {
            "wheel_left_error": left,
            "wheel_right_error": right,
            "track_error": float(turn - distance),
            "mount_pitch_deg": pitch,
            "mount_yaw_deg": yaw,
            "mount_roll_deg": roll,
            "mount_forward": forward,
            "mount_left": sideways,
            "mount_up": up,
            "jpeg_quality": JPEG_QUALITY,
        }
    )


def robot_file(rate_hz: float) -> RobotDescription:
    """Return the simulated robot's file, with the sigmas that `draw_faults` makes true."""
    robot = load_robot(resource_path("robots") / "sim.toml")
    slip = MOST_SLIP / math.sqrt(12.0)
    per_axis = 1.0 / math.sqrt(3.0)
    base = robot.base.model_copy(
        update={
            "distance_sigma": math.hypot(ODOMETRY_SIGMA, slip / math.sqrt(2.0)),
            "turn_sigma": math.hypot(ODOMETRY_SIGMA, slip / math.sqrt(2.0)),
            "drift_sigma_deg_per_m": math.degrees(math.sqrt(2.0) * slip / robot.base.track_width),
        }
    )
    mount = robot.camera.mount.model_copy(
        update={"position_sigma": per_axis * MOUNT_SHIFT, "angle_sigma_deg": per_axis * MOUNT_TURN_DEG}
    )
    camera = robot.camera.model_copy(update={"mount": mount, "rate_hz": rate_hz})
    return robot.model_copy(update={"base": base, "camera": camera})


def _slipping(distance_error: float, slip: float) -> float:
    """Return by what fraction an encoder counts too much; the radius in the file has the mean slip in it."""
    return float((1.0 + distance_error) * (1.0 - MOST_SLIP / 2.0) / (1.0 - slip) - 1.0)


def _direction(rng: np.random.Generator) -> FloatArray:
    drawn = rng.standard_normal(3)
    return np.asarray(drawn / np.linalg.norm(drawn))
