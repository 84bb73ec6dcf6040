"""Which way round motors and encoders are wired, as the robot file says it and as the board is told."""

from tapreach.drivers.arduino.wire import Reversed, Wiring
from tapreach.robot.link_section import Part

PARTS: dict[Part, Reversed] = {
    "left_motor": Reversed.LEFT_MOTOR,
    "right_motor": Reversed.RIGHT_MOTOR,
    "left_encoder": Reversed.LEFT_ENCODER,
    "right_encoder": Reversed.RIGHT_ENCODER,
}


def wiring_of(parts: tuple[Part, ...]) -> Wiring:
    """Return what makes the board turn these parts round, and no others."""
    told = Reversed(0)
    for part in parts:
        told |= PARTS[part]
    return Wiring(told)
