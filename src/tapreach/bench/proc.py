"""What Linux says about processes: CPU time and memory used, children, and whether one still lives."""

import os
from dataclasses import dataclass
from pathlib import Path

_TICKS_PER_SECOND = os.sysconf("SC_CLK_TCK")
# Fields of /proc/PID/stat after the command's closing bracket (proc_pid_stat(5)): state is number 3 there.
_STATE, _PARENT, _USER, _SYSTEM, _STARTED = 0, 1, 11, 12, 19


@dataclass(frozen=True)
class ProcessId:
    """A process and its start, so that a number used again is not taken for the same process."""

    pid: int
    started_ticks: int
    command: str


def cpu_seconds(pid: int) -> float:
    """Return user and system time of a process, all threads [s]; steps of 10 ms. OSError when it is gone."""
    fields = _fields(pid)
    return (int(fields[_USER]) + int(fields[_SYSTEM])) / _TICKS_PER_SECOND


def memory_bytes(pid: int) -> int:
    """Return the memory of a process, its part of what it shares with others. OSError when it is gone."""
    for line in Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines():
        if line.startswith("Pss:"):
            return int(line.split()[1]) * 1024
    raise FileNotFoundError(f"process {pid} has no memory left")


def identify(pid: int) -> ProcessId:
    """Return who `pid` is now. OSError when it is gone."""
    command = Path(f"/proc/{pid}/cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace").strip()
    return ProcessId(pid, int(_fields(pid)[_STARTED]), command)


def is_alive(process: ProcessId) -> bool:
    """Tell whether that very process still runs; a zombie does not."""
    try:
        fields = _fields(process.pid)
    except OSError:
        return False
    return int(fields[_STARTED]) == process.started_ticks and fields[_STATE] not in ("Z", "X")


def family(pid: int) -> list[ProcessId]:
    """Return the process and all its descendants, itself first."""
    children: dict[int, list[int]] = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                children.setdefault(int(_fields(int(entry.name))[_PARENT]), []).append(int(entry.name))
            except OSError:
                continue  # it ended while we looked
    found: list[ProcessId] = []
    waiting = [pid]
    while waiting:
        member = waiting.pop(0)
        try:
            found.append(identify(member))
        except OSError:
            continue
        waiting += sorted(children.get(member, []))
    return found


def _fields(pid: int) -> list[str]:
    # The command in brackets may hold spaces and brackets itself: split after the last one.
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except ProcessLookupError as error:
        raise FileNotFoundError(f"there is no process {pid}") from error
