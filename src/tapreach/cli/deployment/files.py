"""Files that are written below a root folder, none of them half, none of them readable too early."""

import os
from dataclasses import dataclass
from pathlib import Path
from tempfile import mkstemp

from tapreach.errors import SetupError

PRIVATE, PUBLIC = 0o600, 0o644


@dataclass(frozen=True, slots=True)
class PlannedFile:
    """A file to be written: path without its leading slash, text, mode; `holds_secret`: kept if there."""

    path: Path
    text: str
    mode: int
    holds_secret: bool = False


def is_kept(root: Path, file: PlannedFile, renews: bool) -> bool:
    """Tell whether a file stays as it is: a secret that people have typed is not changed unasked."""
    return file.holds_secret and not renews and (root / file.path).exists()


def write_file(root: Path, file: PlannedFile) -> None:
    """Write it at once as a whole. Raises SetupError where that is not allowed."""
    target = root / file.path
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        descriptor, name = mkstemp(dir=target.parent, prefix=".tapreach-")
        with os.fdopen(descriptor, "w", encoding="utf-8") as opened:
            os.fchmod(opened.fileno(), file.mode)
            opened.write(file.text)
        Path(name).replace(target)
    except PermissionError:
        raise SetupError(f"{target} cannot be written by you; run the same command with sudo") from None
