"""Outcomes of the taps that are done, one tap a line, so that a long run can go on where it was ended."""

from collections.abc import Iterable
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from tapreach.bench.locate_outcome import Outcome
from tapreach.errors import ConfigError

_line: TypeAdapter[list[Outcome]] = TypeAdapter(list[Outcome])


def read_kept(path: Path) -> dict[int, list[Outcome]]:
    """Return the outcomes by the tap's number; none where there is no file. Raises ConfigError."""
    if not path.exists():
        return {}
    try:
        taps = [_line.validate_json(line) for line in path.read_text().splitlines()]
    except ValidationError as error:
        raise ConfigError(f"{path} does not hold taps of this bench: {error.errors()[0]['msg']}") from error
    return {outcomes[0].tap: outcomes for outcomes in taps if outcomes}


def keep(path: Path, outcomes: Iterable[Outcome]) -> None:
    """Append the outcomes of one tap."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("ab") as file:
        file.write(_line.dump_json(list(outcomes)) + b"\n")
