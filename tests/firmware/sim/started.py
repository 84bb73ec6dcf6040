"""A rover with the firmware of this checkout, compiled, started, and a framed session open."""

import functools
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
_FOLDER = tempfile.TemporaryDirectory(prefix="tapreach-firmware-")


@functools.cache
def compiled(board: str) -> Path:
    """Return the ELF of the firmware for `board`, built once in this process."""
    return build(board_named(board), Path(_FOLDER.name) / f"{board}.elf").elf


def started_rover(board: str, plant: Plant | None = None) -> Rover:
    """Return a rover whose firmware has started."""
    rover = Rover(compiled(board), WIRING[board], plant if plant is not None else DrivePlant())
    rover.run(BOOT_US)
    return rover


def started_host(board: str, physics: bool = False) -> Host:
    """Return a host with an open session; `physics` for the wheels of the MuJoCo rover."""
    host = Host(started_rover(board, _physics() if physics else DrivePlant()))
    host.open()
    return host


def _physics() -> Plant:
    from tests.firmware.sim.mujoco_plant import rover_in_hall  # MuJoCo is slow to load, and rarely wanted

    return rover_in_hall()


def stop(host: Host) -> None:
    """Give back what the rover holds."""
    host.rover.close()
