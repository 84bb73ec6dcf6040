"""A bench's result: sections of figures, and the machine they were measured on; to and from JSON."""

import os
import platform
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from tapreach.bench.figure import Figure
from tapreach.bench.grid import Grid
from tapreach.errors import ConfigError


@dataclass(frozen=True)
class Machine:
    """Where and when: figures mean little without it."""

    processor: str
    cores: int
    load: float
    """One-minute load average at the start: work of others on the same cores."""
    nice: int
    """Priority over the others: below zero goes before them."""
    system: str
    python: str
    date: str

    def __str__(self) -> str:
        raised = f" (the bench at nice {self.nice})" if self.nice else ""
        return (
            f"{self.processor}, {self.cores} cores, load {self.load:.1f} at the start{raised}, "
            f"{self.system}, Python {self.python}, {self.date}"
        )


def this_machine(now: datetime) -> Machine:
    """Describe the machine this runs on; `now` becomes the date."""
    return Machine(
        processor=_processor_name(),
        cores=len(os.sched_getaffinity(0)),
        load=os.getloadavg()[0],
        nice=os.getpriority(os.PRIO_PROCESS, 0),
        system=f"Linux {platform.release().split('-')[0]}",
        python=platform.python_version(),
        date=now.date().isoformat(),
    )


def _processor_name() -> str:
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith(("model name", "Model")):
            return line.split(":", 1)[1].strip()
    return platform.machine()


@dataclass(frozen=True)
class Section:
    """Figures that belong together, and how they were measured."""

    title: str
    method: str
    figures: tuple[Figure, ...]
    grid: Grid | None = None


@dataclass(frozen=True)
class Report:
    """All that one run of a bench found."""

    bench: str
    title: str
    machine: Machine
    is_smoke: bool
    sections: tuple[Section, ...]
    seed: int | None = None
    """That repeats the run; None where only a default was used."""

    @property
    def figures(self) -> tuple[Figure, ...]:
        """The figures of all sections."""
        return tuple(figure for section in self.sections for figure in section.figures)

    @property
    def broken(self) -> tuple[Figure, ...]:
        """The figures that do not keep to their limits."""
        return tuple(figure for figure in self.figures if figure.holds is False)


_report: TypeAdapter[Report] = TypeAdapter(Report)


def write_report(report: Report, path: Path) -> None:
    """Write `report` as JSON, making the folder where it is missing."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(_report.dump_json(report, indent=1) + b"\n")


def read_report(path: Path) -> Report:
    """Read what `write_report` wrote. Raises ConfigError naming the file when it is something else."""
    try:
        return _report.validate_json(path.read_bytes())
    except ValidationError as error:
        raise ConfigError(f"{path} is not the JSON of a bench: {error.errors()[0]['msg']}") from error
