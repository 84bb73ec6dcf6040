"""The scene's camera on a robot, described as robots are: what the product's choice of a move is handed."""

import math
from functools import lru_cache

from tapreach.bench.accuracy_scene import FOCAL, HEIGHT, LEVER, PITCH, PRINCIPAL, WIDTH
from tapreach.robot.config import RobotDescription


@lru_cache
def described_robot() -> RobotDescription:
    """Return the description; base and arm are those of any small rover, and play no part."""
    x, y, z = LEVER.tolist()
    folded = {"shoulder_deg": -40.0, "elbow_deg": 40.0, "claw": 0.0}
    return RobotDescription.model_validate(
        {
            "name": "accuracy bench",
            "driver": "fake",
            "camera": {
                "width": WIDTH,
                "height": HEIGHT,
                "fx": FOCAL,
                "cx": float(PRINCIPAL[0]),
                "cy": float(PRINCIPAL[1]),
                "mount": {"forward": x, "left": y, "up": z, "pitch_deg": math.degrees(PITCH)},
            },
            "base": {"wheel_radius": 0.033, "track_width": 0.17, "ticks_per_turn": 1440},
            "arm": {
                "shoulder_forward": 0.03,
                "shoulder_up": 0.09,
                "upper_length": 0.12,
                "fore_length": 0.12,
                "hand_length": 0.08,
                "claw_max": 0.07,
                "rotation_limits_deg": [-90.0, 90.0],
                "shoulder_limits_deg": [-60.0, 80.0],
                "elbow_limits_deg": [-80.0, 80.0],
                "standard": folded,
                "stowed": folded,
            },
        }
    )
