"""What was taught, written into the robot file: comments, order and everything else stay as they are."""

import difflib
import re
from collections.abc import Mapping
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import Any

import tomlkit

from tapreach.errors import InputError
from tapreach.resources import resource_path
from tapreach.robot.config import RobotDescription
from tapreach.robot.toml_file import parse_validated

Changes = Mapping[tuple[str, ...], bool | int | float | list[str]]
"""Path of each key and its new value."""


def changed_text(text: str, changes: Changes, source: str) -> str:
    """Return the TOML text with these values. Raises ConfigError where it would be no robot file."""
    document = tomlkit.parse(text)
    for path, value in changes.items():
        table: Any = document
        for part in path[:-1]:
            table = table[part]
        table[path[-1]] = value
    changed = tomlkit.dumps(document)
    parse_validated(changed, source, RobotDescription)
    return changed


def difference(before: str, after: str, name: str) -> str:
    """Return the lines that change as a unified diff; each hunk names the table that it stands in."""
    old = before.splitlines()
    lines = difflib.unified_diff(old, after.splitlines(), name, name, lineterm="", n=0)
    return "\n".join(_with_table(line, old) for line in lines)


def _with_table(line: str, old: list[str]) -> str:
    found = re.match(r"@@ -(\d+)", line)
    above = old[: int(found[1])] if found else []
    table = next((each for each in reversed(above) if each.startswith("[")), "")
    return f"{line} {table.partition(']')[0]}]" if table else line


def require_own_file(path: Path) -> None:
    """Raise InputError for a robot file that comes with Tapreach: the next version would write over it."""
    if path.resolve().parent == resource_path("robots").resolve():
        raise InputError(f"{path.name} is shipped with Tapreach: copy it, and give the path of your copy")


def write_text(path: Path, text: str) -> None:
    """Write it as a whole, with the mode that it has."""
    with NamedTemporaryFile(
        "w", encoding="utf-8", dir=path.parent, prefix=".tapreach-", delete=False
    ) as made:
        made.write(text)
    written = Path(made.name)
    written.chmod(path.stat().st_mode & 0o777)
    written.replace(path)
