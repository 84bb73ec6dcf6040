"""docs/safety.md shows the figures that the code holds."""

import re
from pathlib import Path

import pytest

from tapreach.control import deadman, gate, lease, loop
from tapreach.drivers.sim import board
from tapreach.robot.clock import MS, SECOND

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "safety.md").read_text(encoding="utf-8")


def shown_ms(figure: str) -> float:
    (value,) = re.findall(rf"^\|[^|]*\| {re.escape(figure)} \| (\d+) ms \|", PAGE, re.MULTILINE)
    return float(value)


@pytest.mark.parametrize(
    ("figure", "held_ms"),
    [
        ("deadman", deadman.TIMEOUT_NS / MS),
        ("oldest command", gate.STALE_NS / MS),
        ("oldest picture", gate.FROZEN_NS / MS),
        ("control period", loop.PERIOD_NS / MS),
        ("robot's own deadman", board.DEADMAN_S * 1000.0),
    ],
)
def test_figure_of_the_page_is_the_one_held(figure: str, held_ms: float) -> None:
    assert shown_ms(figure) == pytest.approx(held_ms)


def test_drive_period_of_the_page_is_that_of_the_script() -> None:
    (period,) = re.findall(r"PERIOD_MS = (\d+)", (ROOT / "web/input/drive.js").read_text(encoding="utf-8"))
    assert shown_ms("drive message period") == float(period)


def test_lease_times_of_the_page_are_those_held() -> None:
    assert f"within {lease.ANSWER_NS // SECOND} s is granted" in PAGE
    assert f"no command for {lease.IDLE_NS // SECOND} s may be relieved" in PAGE
