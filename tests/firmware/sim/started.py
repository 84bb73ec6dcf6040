"""A rover with the firmware of this checkout, compiled, started, and a framed session open."""

import functools
import subprocess
import tempfile
from pathlib import Path

from tests.firmware.sim.boards import WIRING
from tests.firmware.sim.host import Host
from tests.firmware.sim.library import BedMissing
from tests.firmware.sim.plant import DrivePlant, Plant
from tests.firmware.sim.rover import Rover

from tapreach.drivers.arduino.boards import board_named
from tapreach.drivers.arduino.build import build

__all__ = ["BedMissing", "compiled", "started_host", "started_rover", "stop"]

BOOT_US = 20_000.0
TCCR0B = 0x45
DATA = 0x80_0000
"""Where avr-gcc's symbols of the data space begin."""
TICK_US = 1024
"""Of Timer0, by which the Arduino core counts."""
_FOLDER = tempfile.TemporaryDirectory(prefix="tapreach-firmware-")


@functools.cache
def compiled(board: str) -> Path:
    """Return the ELF of the firmware for `board`, built once in this process."""
    return build(board_named(board), Path(_FOLDER.name) / f"{board}.elf").elf


def started_rover(board: str, plant: Plant | None = None, wraps_in_us: float | None = None) -> Rover:
    """Return a rover whose firmware has started."""
    rover = Rover(compiled(board), WIRING[board], plant if plant is not None else DrivePlant())
    if wraps_in_us is not None:
        set_clocks(rover, board, wraps_in_us)
    rover.run(BOOT_US)
    return rover


def set_clocks(rover: Rover, board: str, wraps_in_us: float) -> None:
    """Let the core's counts of Timer0's overflows and of milliseconds wrap so long after power-on.

    To be called before the program's `setup` has read the time.
    """
    while not rover.avr.memory(TCCR0B):
        rover.run(10)
    left_us = wraps_in_us - rover.now_us
    for name, value in (("timer0_overflow_count", left_us / TICK_US), ("timer0_millis", left_us / 1000)):
        rover.avr.write(address_of(board, name), (2**32 - round(value)).to_bytes(4, "little"))


def address_of(board: str, variable: str) -> int:
    """Return where a variable of the firmware lies."""
    command = ["avr-nm", str(compiled(board))]
    for line in subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines():
        if line.endswith(f" {variable}"):
            return int(line.split()[0], 16) - DATA
    raise LookupError(f"the firmware for {board} has no variable {variable}")


def started_host(board: str, physics: bool = False, wraps_in_us: float | None = None) -> Host:
    """Return a host with an open session; `physics` for the wheels of the MuJoCo rover.

    wraps_in_us: when, after power-on, the board's clocks wrap.
    """
    host = Host(started_rover(board, _physics() if physics else DrivePlant(), wraps_in_us))
    host.open()
    return host


def _physics() -> Plant:
    from tests.firmware.sim.mujoco_plant import rover_in_hall  # MuJoCo is slow to load, and rarely wanted

    return rover_in_hall()


def stop(host: Host) -> None:
    """Give back what the rover holds."""
    host.rover.close()
