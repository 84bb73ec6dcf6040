"""Where the firmware's pins are on each chip (firmware/tapreach/pins.h says it in Arduino's numbers)."""

from dataclasses import dataclass

from tests.firmware.sim.avr import Chip, Pin


@dataclass(frozen=True)
class Wiring:
    """What is joined to which pin; left before right."""

    chip: Chip
    pwm: tuple[Pin, Pin]
    direction: tuple[tuple[Pin, Pin], tuple[Pin, Pin]]
    """Forward and reverse input of each half of the motor driver."""
    encoders: tuple[tuple[Pin, Pin], tuple[Pin, Pin]]
    servos: tuple[Pin, Pin, Pin, Pin]
    stop: Pin
    battery_channel: int
    battery_divider: float
    """Voltage at the pin over voltage of the battery."""


WIRING = {
    "uno": Wiring(
        chip=Chip("atmega328p"),
        pwm=(("D", 5), ("D", 6)),
        direction=((("C", 1), ("C", 2)), (("C", 3), ("C", 4))),
        encoders=((("D", 2), ("D", 4)), (("D", 3), ("D", 7))),
        servos=(("B", 1), ("B", 2), ("B", 3), ("B", 4)),
        stop=("B", 0),
        battery_channel=0,
        battery_divider=1 / 3,
    ),
    "mega": Wiring(
        chip=Chip("atmega2560"),
        pwm=(("G", 5), ("B", 7)),
        direction=((("A", 2), ("A", 3)), (("A", 4), ("A", 5))),
        encoders=((("K", 0), ("K", 1)), (("K", 2), ("K", 3))),
        servos=(("H", 6), ("B", 4), ("B", 5), ("B", 6)),
        stop=("A", 6),
        battery_channel=0,
        battery_divider=1 / 3,
    ),
    "yun": Wiring(  # its Linux side is on UART 1; that of a Leonardo is USB, which simavr does not have
        chip=Chip("atmega32u4", "1"),
        pwm=(("C", 6), ("D", 0)),
        direction=((("F", 6), ("F", 5)), (("F", 4), ("F", 1))),
        encoders=((("B", 4), ("B", 5)), (("B", 6), ("B", 7))),
        servos=(("D", 1), ("D", 4), ("D", 7), ("D", 6)),
        stop=("F", 0),
        battery_channel=7,
        battery_divider=1 / 3,
    ),
}
