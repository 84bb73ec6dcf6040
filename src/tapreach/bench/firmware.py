"""The firmware bench: the compiled machine code in a simulated microcontroller, in a simulated robot."""

from collections.abc import Callable
from dataclasses import dataclass

from tapreach.bench.firmware_endurance import measure_endurance
from tapreach.bench.firmware_moves import measure_moves
from tapreach.bench.firmware_noise import measure_noise
from tapreach.bench.firmware_round_trip import measure_round_trip
from tapreach.bench.firmware_vanish import measure_vanishing
from tapreach.bench.report import Report, Section
from tapreach.bench.series import Measurement, run_series
from tapreach.robot.clock import Clock


@dataclass(frozen=True)
class FirmwarePlan:
    """How often. The seed makes a run again, to the microsecond."""

    seed: int
    board: str = "uno"
    pings: int = 300
    vanishings: int = 200
    moves: int = 100
    noise_bytes: int = 1_000_000
    hours: float = 24.0
    wraps: int = 30
    is_smoke: bool = False


def smoke_plan(seed: int, board: str = "uno") -> FirmwarePlan:
    """Return a plan that only shows that everything works."""
    return FirmwarePlan(
        seed, board, pings=5, vanishings=5, moves=2, noise_bytes=2_000, hours=0.001, wraps=3, is_smoke=True
    )


async def run_firmware(plan: FirmwarePlan, on_section: Callable[[Section], None], clock: Clock) -> Report:
    """Run the whole bench."""

    def measured(name: str, measure: Callable[[], Section]) -> Measurement:
        async def run() -> Section:
            return measure()

        return Measurement(name, run)

    board, seed = plan.board, plan.seed
    measurements = (
        measured("Round trip", lambda: measure_round_trip(board, plan.pings, seed)),
        measured("Vanishing", lambda: measure_vanishing(board, plan.vanishings, seed)),
        measured("Moves", lambda: measure_moves(board, plan.moves, seed)),
        measured("Moves in MuJoCo", lambda: measure_moves(board, plan.moves, seed, physics=True)),
        measured("Noise", lambda: measure_noise(board, plan.noise_bytes, seed)),
        measured("Endurance", lambda: measure_endurance(board, plan.hours, plan.wraps, seed)),
    )
    return await run_series("firmware", "Firmware", plan.is_smoke, measurements, on_section, clock, seed)
