"""How wrong a robot is: the sizes of its faults, drawn anew for every run, and the file that tells of them.

Odometry: all distances are told wrong by one factor, all turns by another, each normal. Slip: each wheel on
its own loses a constant share of its turning, evenly between none and the most; the wheel radius of the file
was measured on such floors, with half the most. Mount: turned by exactly the angle about an axis and moved by
exactly the way in a direction that are drawn evenly from the sphere. Servos: the horns set off by exactly the
angle, to either side. The rest is the same for every robot of a level.
"""

import math
from dataclasses import dataclass

import numpy as np

from tapreach.drivers.sim.faults import SimFaults
from tapreach.geometry.finite import FloatArray
from tapreach.resources import resource_path
from tapreach.robot.config import RobotDescription, load_robot

UNMEASURED_MS = 4.0
"""What a robot file says of the times of pictures when nobody has measured them."""


@dataclass(frozen=True)
class FaultLevel:
    """odometry_sigma, most_slip, dropped_frames: fractions. mount_shift [m]. camera_delay_ms: unknown to the
    host.
    """

    odometry_sigma: float = 0.01
    most_slip: float = 0.02
    mount_turn_deg: float = 1.0
    mount_shift: float = 0.005
    jpeg_quality: int = 80
    servo_offset_deg: float = 0.0
    camera_delay_ms: float = 0.0
    dropped_frames: float = 0.0

    def draw(self, of_scene: SimFaults, rng: np.random.Generator) -> SimFaults:
        """Return the faults of one robot, beside those `of_scene`."""
        distance, turn = self.odometry_sigma * rng.standard_normal(2)
        left, right = (self._slipping(distance, slip) for slip in rng.uniform(0.0, self.most_slip, 2))
        pitch, yaw, roll = map(float, self.mount_turn_deg * _direction(rng))
        forward, sideways, up = map(float, self.mount_shift * _direction(rng))
        servo = self.servo_offset_deg and math.copysign(self.servo_offset_deg, rng.random() - 0.5)
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
                "jpeg_quality": self.jpeg_quality,
                "servo_offset_deg": servo,
                "camera_delay_ms": self.camera_delay_ms,
                "dropped_frames": self.dropped_frames,
            }
        )

    def robot_file(self, rate_hz: float) -> RobotDescription:
        """Return the simulated robot's file, with the sigmas that `draw` makes true."""
        robot = load_robot(resource_path("robots") / "sim.toml")
        slip = self.most_slip / math.sqrt(12.0)
        per_axis = 1.0 / math.sqrt(3.0)
        base = robot.base.model_copy(
            update={
                "distance_sigma": math.hypot(self.odometry_sigma, slip / math.sqrt(2.0)),
                "turn_sigma": math.hypot(self.odometry_sigma, slip / math.sqrt(2.0)),
                "drift_sigma_deg_per_m": math.degrees(math.sqrt(2.0) * slip / robot.base.track_width),
            }
        )
        mount = robot.camera.mount.model_copy(
            update={
                "position_sigma": per_axis * self.mount_shift,
                "angle_sigma_deg": per_axis * self.mount_turn_deg,
            }
        )
        camera = robot.camera.model_copy(update={"mount": mount, "rate_hz": rate_hz})
        if self.camera_delay_ms:
            camera = camera.model_copy(update={"timing_sigma_ms": UNMEASURED_MS})
        return robot.model_copy(update={"base": base, "camera": camera})

    def _slipping(self, distance_error: float, slip: float) -> float:
        """Return by what fraction an encoder counts too much; the file's radius has the mean slip in it."""
        return float((1.0 + distance_error) * (1.0 - self.most_slip / 2.0) / (1.0 - slip) - 1.0)


def _direction(rng: np.random.Generator) -> FloatArray:
    drawn = rng.standard_normal(3)
    return np.asarray(drawn / np.linalg.norm(drawn))


LOCATING = FaultLevel()
"""1 % odometry, 2 % slip, mount off by 1 degree and 5 mm, JPEG 80."""
DEFAULT = FaultLevel(servo_offset_deg=2.0, camera_delay_ms=80.0)
"""The same, with servo horns set off by 2 degrees and a camera 80 ms later than the host knows."""
HARD = FaultLevel(0.03, 0.05, 2.0, 0.010, servo_offset_deg=4.0, camera_delay_ms=150.0, dropped_frames=0.05)
"""3 % odometry, 5 % slip, mount off by 2 degrees and 10 mm, servos by 4 degrees, 150 ms, 5 % frames lost."""
