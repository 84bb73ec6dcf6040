"""The small program of trivial.c, compiled, and how it is wired."""

import functools
import subprocess
import tempfile
from pathlib import Path

from tests.firmware.sim.avr import Chip
from tests.firmware.sim.boards import Wiring

PWM, SERVO, A, B, HIGH, UNUSED = ("D", 5), ("B", 1), ("D", 2), ("C", 4), ("B", 0), ("B", 5)
WIRING = Wiring(
    chip=Chip("atmega328p"),
    pwm=(PWM, PWM),
    direction=((HIGH, UNUSED), (HIGH, UNUSED)),
    encoders=((A, B), (("D", 3), ("C", 5))),
    servos=(SERVO, SERVO, SERVO, SERVO),
    stop=("B", 4),
    battery_channel=0,
    battery_divider=0.25,
)
_FOLDER = tempfile.TemporaryDirectory(prefix="tapreach-trivial-")


@functools.cache
def trivial_elf() -> Path:
    """Return the compiled program."""
    target = Path(_FOLDER.name) / "trivial.elf"
    source = Path(__file__).with_suffix(".c")
    command = ["avr-gcc", "-mmcu=atmega328p", "-Os", "-o", str(target), str(source)]
    subprocess.run(command, check=True, capture_output=True)
    return target
