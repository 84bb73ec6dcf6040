"""Runs the measurements of a bench one after the other and collects what they found."""

from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass

from websockets.exceptions import WebSocketException

from tapreach.bench.figure import Figure, exactly
from tapreach.bench.report import Report, Section, this_machine
from tapreach.errors import TapreachError
from tapreach.robot.clock import Clock


@dataclass(frozen=True)
class Measurement:
    """A part of a bench: its name on the command line, and what does it."""

    name: str
    run: Callable[[], Awaitable[Section]]


async def run_series(
    bench: str,
    title: str,
    is_smoke: bool,
    measurements: Sequence[Measurement],
    on_section: Callable[[Section], None],
    clock: Clock,
    seed: int | None = None,
) -> Report:
    """Return the report; `on_section` hears of each section as soon as it is measured.

    A measurement that fails is a section with one figure that does not hold and says why; the others go on.
    """
    machine = this_machine(clock.wall_time())
    sections = []
    for measurement in measurements:
        section = await _section(measurement)
        on_section(section)
        sections.append(section)
    return Report(bench, title, machine, is_smoke, tuple(sections), seed)


async def _section(measurement: Measurement) -> Section:
    try:
        return await measurement.run()
    except (TapreachError, OSError, WebSocketException) as error:  # TimeoutError is an OSError
        reason = f"{type(error).__name__}: {error}"
        failed = Figure("measurements that could be made", None, "", exactly(1), reason)
        return Section(measurement.name, "This part of the bench failed.", (failed,))
