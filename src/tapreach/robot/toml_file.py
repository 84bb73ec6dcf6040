"""TOML files checked against a pydantic model; every error names file, line, key and the known keys."""

import tomllib
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from tapreach.errors import ConfigError
from tapreach.robot.model_keys import known_keys
from tapreach.robot.toml_lines import KeyPath, find_line

Model = TypeVar("Model", bound=BaseModel)


class PlacedValueError(ValueError):
    """A validator of a whole model found a fault in one part of it, at `path` below the model."""

    def __init__(self, message: str, *path: str | int) -> None:
        super().__init__(message)
        self.path: KeyPath = path


def load_validated(path: Path, model: type[Model]) -> Model:
    """Read the TOML file `path` as `model`.

    Raises ConfigError where the file cannot be read, is not TOML, or does not fit the model. The message has
    one line per fault: `file:line: key: what is wrong`, and for an unknown key the keys that are known.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise ConfigError(_missing_file_message(path)) from None
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path}: cannot be read as UTF-8 text: {error}") from None
    return parse_validated(text, str(path), model)


def parse_validated(text: str, source: str, model: type[Model]) -> Model:
    """Like `load_validated` for a text; `source` stands in messages where the file name would."""
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(f"{source}: not valid TOML: {error}") from None
    try:
        return model.model_validate(data)
    except ValidationError as error:
        faults = [_describe(fault, text, source, data, model) for fault in error.errors()]
        raise ConfigError("\n".join(faults)) from None


def _missing_file_message(path: Path) -> str:
    siblings = sorted(p.name for p in path.parent.glob("*.toml")) if path.parent.is_dir() else []
    there = f"; in {path.parent} there are: {', '.join(siblings)}" if siblings else ""
    return f"{path}: no such file{there}"


def _describe(fault: ErrorDetails, text: str, source: str, data: Any, model: type[BaseModel]) -> str:
    path = _path_in_data(fault, data)
    line = find_line(text, path)
    where = f"{source}:{line}" if line else source
    name = ".".join(str(part) for part in path) or "the file"
    if fault["type"] == "extra_forbidden":
        keys = ", ".join(known_keys(model, tuple(fault["loc"])[:-1]))
        return f"{where}: {name}: unknown key {path[-1]!r}; known keys here: {keys}"
    if fault["type"] == "missing":
        keys = ", ".join(known_keys(model, tuple(fault["loc"])[:-1]))
        return f"{where}: {name}: the key {path[-1]!r} is missing; known keys here: {keys}"
    message = fault["msg"].removeprefix("Value error, ")
    shown = fault["input"]
    given = f" (given: {shown!r})" if isinstance(shown, str | int | float | bool) else ""
    return f"{where}: {name}: {message}{given}"


def _path_in_data(fault: ErrorDetails, data: Any) -> KeyPath:
    """Drop the union tags that pydantic adds to a location, append what a PlacedValueError says."""
    inner = getattr(fault.get("ctx", {}).get("error"), "path", ())
    path: list[str | int] = []
    loc = (*fault["loc"], *inner)
    for index, part in enumerate(loc):
        last = index == len(loc) - 1
        in_list = isinstance(data, list) and isinstance(part, int) and part < len(data)
        if in_list or (isinstance(data, dict) and part in data):
            data = data[part]
        elif not (last and isinstance(part, str) and fault["type"] in ("missing", "extra_forbidden")):
            continue
        path.append(part)
    return tuple(path)
