"""What `tapreach run` takes of a machine is measured over all its processes."""

import asyncio
import os

import pytest

from tapreach.bench.footprint import FootprintPlan, footprints, run_footprint
from tapreach.bench.proc import ProcessId, identify, memory_bytes
from tapreach.robot.clock import MonotonicClock

pytestmark = pytest.mark.timeout(300)  # a machine that others keep busy is slow, not wrong


def test_memory_follows_what_is_held():
    before = memory_bytes(os.getpid())
    held = bytearray(os.urandom(1)) * 60_000_000
    after = memory_bytes(os.getpid())
    assert len(held) == 60_000_000
    assert 40e6 < after - before < 90e6


def test_processes_of_one_role_are_summed_and_ended_ones_left_out():
    here = identify(os.getpid())
    gone = ProcessId(2**22 + 1, 0, "gone")
    compute = ProcessId(here.pid, here.started_ticks, "python -m tapreach.tasks.compute")
    found = footprints([here, compute, here, gone])
    assert set(found) == {"server", "compute"}
    assert found["server"].memory == pytest.approx(2 * found["compute"].memory, rel=0.2)


def test_running_robot_is_measured_alone_and_watched():
    heard = []
    plan = FootprintPlan("fake", 1.0, is_smoke=True)
    report = asyncio.run(run_footprint(plan, heard.append, MonotonicClock()))
    assert [section.title for section in report.sections] == ["Nobody watches", "One viewer watches"]
    for section in report.sections:
        values = {figure.name: figure.value for figure in section.figures}
        assert None not in values.values(), section
        assert 30 < values["memory in all"] < 2000
        assert values["memory in all"] == pytest.approx(
            sum(value for name, value in values.items() if name.startswith("memory: "))
        )
        assert 0 <= values["processor: server"] < 400
    assert report.sections[1].figures[-1].value > 1
