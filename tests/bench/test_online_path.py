"""The bench of the online path measures every step of a frame, once on a real run."""

import asyncio

from tapreach.bench.online_path import OnlinePlan, run_online
from tapreach.robot.clock import MonotonicClock

STEPS = ("decoded", "tapped place followed", "background followed", "way by the background", "frame, whole")


def test_one_tap_gives_a_time_for_every_step() -> None:
    report = asyncio.run(run_online(OnlinePlan(3, 1, True), lambda section: None, MonotonicClock()))
    figures = {figure.name.removesuffix(", p95"): figure for figure in report.sections[0].figures}
    assert set(STEPS) <= set(figures)
    for step in STEPS:
        assert figures[step].value is not None and figures[step].value > 0.0
    assert figures["frame, whole"].limit is None
    assert figures["background followed"].limit is not None
