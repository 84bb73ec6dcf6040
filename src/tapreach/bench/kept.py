"""Results of a long run, one a line, so that it can go on where it was ended."""

from pathlib import Path
from typing import Any, Generic, TypeVar

from pydantic import TypeAdapter, ValidationError

from tapreach.errors import ConfigError

Result = TypeVar("Result")


class Kept(Generic[Result]):
    """The file of results of one type, a dataclass or a list of them; without a path there is none."""

    def __init__(self, path: Path | None, result_type: Any) -> None:
        self._path = path
        self._line: TypeAdapter[Result] = TypeAdapter(result_type)

    def read(self) -> list[Result]:
        """Return what the file holds; nothing where there is no file. Raises ConfigError naming it."""
        if self._path is None or not self._path.exists():
            return []
        try:
            return [self._line.validate_json(line) for line in self._path.read_text().splitlines()]
        except ValidationError as error:
            what = error.errors()[0]["msg"]
            raise ConfigError(f"{self._path} does not hold results of this bench: {what}") from error

    def add(self, result: Result) -> None:
        """Append one result, making the folder where it is missing."""
        if self._path is None:
            return
        self._path.parent.mkdir(parents=True, exist_ok=True)
        with self._path.open("ab") as file:
            file.write(self._line.dump_json(result) + b"\n")
