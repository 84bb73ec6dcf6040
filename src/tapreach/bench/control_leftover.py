"""Does anything of `tapreach run` outlive it, however it ends?"""

import signal
from collections.abc import Sequence

from tapreach.bench.figure import Figure, exactly
from tapreach.bench.report import Section
from tapreach.bench.simulated import kill, simulated_run
from tapreach.robot.clock import SECOND, Clock

ENDS = {
    "SIGTERM": signal.SIGTERM,
    "SIGINT (Ctrl-C)": signal.SIGINT,
    "SIGKILL": signal.SIGKILL,
    "a crash (SIGSEGV)": signal.SIGSEGV,
}


async def measure_leftovers(ends: Sequence[str], clock: Clock) -> Section:
    """End a simulated run in each of the ways, keys of ENDS, and count its processes a second later."""
    return Section(
        "Processes left behind",
        "`tapreach run` with the simulated robot and a picture on the way; counted one second after its main "
        "process was sent the signal.",
        tuple([await _after(name, ENDS[name], clock) for name in ends]),
    )


async def _after(name: str, number: signal.Signals, clock: Clock) -> Figure:
    async with simulated_run(clock) as run:
        await run.first_picture(clock)
        members = run.family
        run.process.send_signal(number)
        await clock.sleep_until(clock.now_ns() + SECOND)
        left = kill(members)
    return Figure(f"left 1 s after {name}", left, "", exactly(0), f"of {len(members)} processes")
