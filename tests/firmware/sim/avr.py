"""A microcontroller that runs a compiled firmware: time, serial line, pins."""

import ctypes
from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path

from tests.firmware.sim.library import library

CLOCK_HZ = 16_000_000
Pin = tuple[str, int]
"""Port and bit: ("D", 5) is PD5."""


class ResetCause(IntEnum):
    """The bits of MCUSR."""

    POWER_ON = 1
    EXTERNAL = 2
    BROWN_OUT = 4
    WATCHDOG = 8


@dataclass(frozen=True)
class Chip:
    """What simavr must be told: its name of the chip, and which UART is the link."""

    name: str
    uart: str = "0"


class Died(AssertionError):
    """The processor ran off its program."""


class Avr:
    """Time is simulated and stands still but in `run`; all of it in microseconds since power-on."""

    def __init__(self, elf: Path, chip: Chip) -> None:
        self._lib = library()
        self._bed = self._lib.bed_open(str(elf).encode(), chip.name.encode(), CLOCK_HZ, chip.uart.encode())
        if not self._bed:
            raise ValueError(f"{elf} is no ELF file, or simavr does not know the chip {chip.name}")
        self._buffer = (ctypes.c_uint8 * 4096)()

    def close(self) -> None:
        if self._bed:
            self._lib.bed_close(self._bed)
            self._bed = None

    @property
    def now_us(self) -> float:
        return self._lib.bed_now_us(self._bed)

    @property
    def asleep_us(self) -> float:
        """How long the processor has slept in all."""
        return self._lib.bed_asleep_us(self._bed)

    def run(self, us: float) -> None:
        self.run_to(self.now_us + us)

    def run_to(self, us: float, until_frame: bool = False) -> None:
        """Run to a time, or only until a 0x00, the end of a frame, came out of the serial line."""
        if self._lib.bed_run_to(self._bed, us, until_frame):
            raise Died(f"the processor died at {self.now_us:.0f} µs")

    def send(self, data: bytes) -> None:
        """Put bytes on the line to the firmware; they arrive at its baud rate."""
        self._lib.bed_send(self._bed, data, len(data))

    @property
    def unsent(self) -> int:
        return self._lib.bed_unsent(self._bed)

    def unplug(self) -> None:
        """Lose the bytes that wait for the line."""
        self._lib.bed_drop_unsent(self._bed)

    def receive(self) -> bytes:
        count = self._lib.bed_receive(self._bed, self._buffer, len(self._buffer))
        return bytes(self._buffer[:count])

    def level(self, pin: Pin) -> int:
        return self._lib.bed_level(self._bed, *_named(pin))

    def edges(self, pin: Pin) -> int:
        return self._lib.bed_edges(self._bed, *_named(pin))

    def fell_us(self, pin: Pin) -> float:
        """When the pin last went low."""
        return self._lib.bed_fell_us(self._bed, *_named(pin))

    def pulse_us(self, pin: Pin) -> float:
        """Width of the last whole pulse."""
        return self._lib.bed_pulse_us(self._bed, *_named(pin))

    def high_us(self, pin: Pin) -> float:
        """How long the pin has been high in all."""
        return self._lib.bed_high_us(self._bed, *_named(pin))

    def duty(self, pin: Pin) -> float:
        """Share of the last whole period in which the pin was high."""
        return self._lib.bed_duty(self._bed, *_named(pin))

    def drive_pin(self, pin: Pin, level: int) -> None:
        self._lib.bed_drive_pin(self._bed, *_named(pin), level)

    def adc(self, channel: int, millivolts: float) -> None:
        self._lib.bed_adc(self._bed, channel, round(millivolts))

    def memory(self, address: int) -> int:
        """A byte of the data space: registers and RAM."""
        return self._lib.bed_memory(self._bed, address)

    def write(self, address: int, data: bytes) -> None:
        """Change bytes of the data space."""
        for index, value in enumerate(data):
            self._lib.bed_write(self._bed, address + index, value)

    def connect_encoder(self, index: int, a: Pin, b: Pin) -> None:
        self._lib.bed_encoder(self._bed, index, *_named(a), *_named(b))

    def encoder_to(self, index: int, edges: int, us: float) -> None:
        """Turn the wheel so that it has made `edges` quadrature edges in all, `us` from now, evenly."""
        self._lib.bed_encoder_to(self._bed, index, edges, us)

    def encoder_edges(self, index: int) -> int:
        return self._lib.bed_encoder_edges(self._bed, index)

    def break_encoder(self, index: int, broken: bool = True) -> None:
        """Pull its cable: the wheel turns on, the pins keep still."""
        self._lib.bed_encoder_broken(self._bed, index, broken)

    def reset(self, cause: ResetCause) -> None:
        self._lib.bed_reset(self._bed, cause)

    def stall(self) -> None:
        """Let the program hang; interrupts go on."""
        self._lib.bed_stall(self._bed)

    def unstall(self) -> None:
        self._lib.bed_unstall(self._bed)


def _named(pin: Pin) -> tuple[bytes, int]:
    return pin[0].encode(), pin[1]
