"""A real `tapreach run` in a process of its own, and what it leaves behind."""

import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Timer

COMMAND = str(Path(sys.executable).with_name("tapreach"))
START_S = 60.0


class Running:
    """The process, its address, and its children."""

    def __init__(self, process: subprocess.Popen[str], address: str, printed: str) -> None:
        self.process = process
        self.address = address
        self.printed = printed

    def children(self) -> set[int]:
        """Ids of all its descendants."""
        return descendants(self.process.pid)

    def end(self, signal_number: int, within_s: float = 10.0) -> str:
        """Send a signal, wait for the end, return all that was printed."""
        self.process.send_signal(signal_number)
        rest, _ = self.process.communicate(timeout=within_s)
        return self.printed + rest


LAST_WORDS = "Ctrl-C ends it."
"""With them all is said: a signal sent before would cut it off."""


@contextmanager
def tapreach_run(captures: Path, *arguments: str) -> Iterator[Running]:
    """Start `tapreach run` on a free port and wait until it prints its address."""
    command = [COMMAND, "run", "--port", "0", "--captures", str(captures), *arguments]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    watchdog = Timer(START_S, process.kill)
    watchdog.start()
    try:
        printed, address = _read_address(process)
        watchdog.cancel()
        yield Running(process, address, printed)
    finally:
        watchdog.cancel()
        if process.poll() is None:
            process.kill()
            process.communicate()


def _read_address(process: subprocess.Popen[str]) -> tuple[str, str]:
    printed = ""
    assert process.stdout is not None
    for line in process.stdout:
        printed += line
        found = re.search(r"http://\S+", printed)
        if found and LAST_WORDS in line:
            return printed, found.group()
    raise AssertionError(f"tapreach run ended without an address; it printed:\n{printed}")


def descendants(pid: int) -> set[int]:
    """Ids of all living processes below `pid`."""
    parents = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        parents[int(stat.parent.name)] = (int(fields[1]), fields[0])
    found: set[int] = set()
    ring = {pid}
    while ring:
        ring = {child for child, (parent, state) in parents.items() if parent in ring and state != "Z"}
        found |= ring
    return found


def is_alive(pid: int) -> bool:
    """Whether a process runs (a zombie does not)."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
