"""A board with a robot around it: PWM moves the motors, the wheels move the encoders, all in lock step."""

import math
from dataclasses import dataclass
from pathlib import Path

from tests.firmware.sim.avr import Avr, ResetCause
from tests.firmware.sim.boards import Wiring
from tests.firmware.sim.plant import DrivePlant, Plant

STEP_US = 2048.0
"""Two periods of the PWM: what is averaged holds whole periods."""
SIDES = (0, 1)


@dataclass(frozen=True)
class Trace:
    """What the pins did in one step."""

    at_us: float
    duties: tuple[float, float]


class Rover:
    """The firmware in its robot. `run` moves both on; time is simulated [µs since power-on]."""

    def __init__(
        self, elf: Path, wiring: Wiring, plant: Plant | None = None, ticks_per_turn: float = 1320.0
    ) -> None:
        self.wiring, self.ticks_per_turn = wiring, ticks_per_turn
        self.plant = plant if plant is not None else DrivePlant()
        self.avr = Avr(elf, wiring.chip)
        self.duties = (0.0, 0.0)
        self._high_us = [0.0, 0.0]
        self._next_us = STEP_US
        for side in SIDES:
            self.avr.connect_encoder(side, *wiring.encoders[side])
        self.avr.drive_pin(wiring.stop, 1)
        self.battery_mv(7400)

    def close(self) -> None:
        self.avr.close()

    @property
    def now_us(self) -> float:
        return self.avr.now_us

    def run(self, us: float) -> None:
        self.run_to(self.now_us + us)

    def run_to(self, us: float, until_frame: bool = False) -> None:
        """Run to a time; with `until_frame` only until the firmware has ended a frame."""
        while self.now_us < us:
            stop_us = min(us, self._next_us)
            self.avr.run_to(stop_us, until_frame)
            if self.now_us >= self._next_us:
                self._step()
            elif until_frame and self.now_us < stop_us:
                return

    def _step(self) -> None:
        high = [self.avr.high_us(pin) for pin in self.wiring.pwm]
        self.duties = tuple(self._sign(i) * (high[i] - self._high_us[i]) / STEP_US for i in SIDES)
        self._high_us = high
        self._next_us += STEP_US
        self.plant.step(self.duties, STEP_US / 1e6)
        for side, angle in enumerate(self.plant.angles):
            edges = math.floor(angle * self.ticks_per_turn / (2 * math.pi))
            self.avr.encoder_to(side, edges, self._next_us - self.now_us)

    def _sign(self, side: int) -> int:
        forward, reverse = self.wiring.direction[side]
        return self.avr.level(forward) - self.avr.level(reverse)

    @property
    def ticks(self) -> tuple[int, int]:
        """How far the wheels have truly turned."""
        return self.avr.encoder_edges(0), self.avr.encoder_edges(1)

    def powered_us(self) -> float:
        """For how long in all the motors have had power, both added up."""
        return sum(self.avr.high_us(pin) for pin in self.wiring.pwm)

    def off_since_us(self) -> float:
        """When the last motor lost its PWM; now where one has it."""
        if any(self.avr.level(pin) for pin in self.wiring.pwm):
            return self.now_us
        return max(self.avr.fell_us(pin) for pin in self.wiring.pwm)

    def battery_mv(self, millivolts: float) -> None:
        self.avr.adc(self.wiring.battery_channel, millivolts * self.wiring.battery_divider)

    def pull_stop(self, pulled: bool = True) -> None:
        self.avr.drive_pin(self.wiring.stop, not pulled)

    def reset(self, cause: ResetCause) -> None:
        self.avr.reset(cause)
