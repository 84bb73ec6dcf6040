"""The live robot in a process of its own, so that nothing else in the test's process holds it up."""

import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path

from tests.firmware.sim.live_robot import live_robot

from tapreach.drivers.sim.scene import load_scene

ROOT = Path(__file__).resolve().parents[3]


@dataclass(frozen=True)
class Look:
    """What is so at one moment: simulated times [µs], duties of the motors, how far behind it was at most,
    and the heights of the middles of all things above the floor [m].
    """

    now_us: float
    off_since_us: float
    powered_us: float
    duties: tuple[float, float]
    worst_lag_s: float
    heights: dict[str, float]


class LiveProcess:
    """`robot_file` is for `tapreach run`; `look` asks for the present."""

    def __init__(self, process: subprocess.Popen[str], robot_file: Path) -> None:
        self._process, self.robot_file = process, robot_file
        self.worst_lag_s = 0.0
        """Of all looks; may be set to 0."""

    def look(self) -> Look:
        """Ask; the worst lag in the answer counts from the look before."""
        assert self._process.stdin is not None and self._process.stdout is not None
        self._process.stdin.write("look\n")
        self._process.stdin.flush()
        seen = Look(**json.loads(self._process.stdout.readline()))
        self.worst_lag_s = max(self.worst_lag_s, seen.worst_lag_s)
        return seen


@contextmanager
def live_process(scene: str, folder: Path) -> Iterator[LiveProcess]:
    """Start it; end it by closing its input."""
    command = [sys.executable, "-m", "tests.firmware.sim.live_process", scene, str(folder)]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    process = subprocess.Popen(command, cwd=ROOT, **pipes)
    try:
        yield LiveProcess(process, Path(process.stdout.readline().strip()))
    finally:
        try:
            process.communicate(timeout=10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()


def main(scene: str, folder: str) -> None:
    """Serve looks until the input ends."""
    names = load_scene(scene).object_names()
    with live_robot(scene, Path(folder)) as (file, bridge, world):
        _say(str(file))
        for _ in sys.stdin:
            with bridge.lock:
                rover = bridge.rover
                powered_us, off_us = rover.powered_us(), rover.off_since_us()
                heights = {name: float(world.data.body(name).xpos[2]) for name in names}
                told = Look(rover.now_us, off_us, powered_us, rover.duties, bridge.worst_lag_s, heights)
                bridge.worst_lag_s = 0.0
            _say(json.dumps(asdict(told)))


def _say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main(*sys.argv[1:])
