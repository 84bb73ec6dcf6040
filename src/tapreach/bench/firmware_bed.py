"""The firmware's test bed. It lies with the tests: GPL-3 with its simulator, and never shipped."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any, Protocol

from tapreach.drivers.arduino import wire
from tapreach.drivers.arduino.frame_reader import Received
from tapreach.errors import DriverError, SetupError

_CHECKOUT = Path(__file__).resolve().parents[3]
_PACKAGES = "apt install gcc libc6-dev libsimavr-dev libelf-dev gcc-avr avr-libc arduino-core-avr"


class BedRover(Protocol):
    """The compiled firmware in its robot; times in simulated microseconds since power-on."""

    plant: Any
    avr: Any

    @property
    def now_us(self) -> float:
        """The time."""
        ...

    @property
    def ticks(self) -> tuple[int, int]:
        """How far the wheels have truly turned, left and right."""
        ...

    def powered_us(self) -> float:
        """For how long in all the motors have had power."""
        ...

    def off_since_us(self) -> float:
        """When the last motor lost its power; now where one has it."""
        ...


class BedHost(Protocol):
    """The other end of its line, in lock step."""

    rover: BedRover
    heard: list[Received]
    """All that was heard; whoever looks at it clears it."""
    offset_us: float
    """Of the firmware's clock before simulated time."""

    @property
    def at_ms(self) -> int:
        """The firmware's clock now, as the host believes it."""
        ...

    def open(self) -> wire.Welcome:
        """Say hello and align the clocks."""
        ...

    def send(self, message: wire.Message) -> int:
        """Put a frame on the line; return its seq."""
        ...

    def run(self, us: float) -> list[Received]:
        """Let time pass; return what was heard meanwhile."""
        ...

    def drive(self, left: int, right: int) -> wire.Result:
        """Ask for wheel speeds [ticks/s]."""
        ...

    def drive_for(self, left: int, right: int, us: float) -> None:
        """Drive as a host does, with a message every 50 ms."""
        ...

    def move(self, left: int, right: int, speed: int = ..., acceleration: int = ...) -> wire.Moved:
        """Make a relative move to its end."""
        ...

    def telemetry(self) -> wire.Telemetry:
        """Return the next telemetry."""
        ...

    def round_trip_us(self) -> float:
        """Return the time from a ping's first bit to a pong's last."""
        ...


@contextmanager
def firmware_host(board: str, physics: bool = False, wraps_in_us: float | None = None) -> Iterator[BedHost]:
    """Compile the firmware for `board` ("uno", "mega"), start it in its robot and open a framed session.

    With `physics` the wheels are those of the MuJoCo rover; `wraps_in_us` sets the board's clocks so that
    they wrap so long after power-on. Raises DriverError when the firmware does not do as it is told,
    SetupError outside a checkout of the
    source or without the simulator.
    """
    bed = _bed()
    try:
        host: BedHost = bed.started_host(board, physics, wraps_in_us)
    except bed.BedMissing as reason:
        raise SetupError(f"{reason} ({_PACKAGES})") from None
    try:
        yield host
    except AssertionError as failure:  # the bed's way to say that the firmware did something else
        raise DriverError(f"the firmware did not do as it was told: {failure}") from failure
    finally:
        bed.stop(host)


def _bed() -> Any:
    if not (_CHECKOUT / "tests" / "firmware" / "sim").is_dir():
        raise SetupError("the firmware bench needs a checkout: its simulator lies with the tests")
    if str(_CHECKOUT) not in sys.path:
        sys.path.insert(0, str(_CHECKOUT))
    return import_module("tests.firmware.sim.started")
