"""The firmware bench in its short form: every part is measured, and the firmware keeps to its limits in it.

Time is simulated and the seed fixed: unlike other benches, this one gives the same figures on every machine.
"""

import asyncio

from tests.firmware.sim.needs import needs_bed

from tapreach.bench.firmware import run_firmware, smoke_plan
from tapreach.robot.clock import MonotonicClock


@needs_bed
def test_firmware_bench_measures_every_part_and_all_limits_hold():
    report = asyncio.run(run_firmware(smoke_plan(seed=7), lambda section: None, MonotonicClock()))
    assert len(report.sections) == 6
    assert [f"{f.name}: {f.note}" for f in report.figures if f.value is None] == []
    assert [f"{f.name}: {f.shown}, {f.wanted}" for f in report.broken] == []
