"""Both benches in their short form, for structure and sane values. Timing is judged by full runs only."""

import asyncio

import pytest

from tapreach.bench import control, video
from tapreach.bench.report import Report, read_report, write_report
from tapreach.robot.clock import MonotonicClock

CLOCK = MonotonicClock()
pytestmark = pytest.mark.timeout(600)  # a machine that others keep busy is slow, not wrong


def run(measure) -> Report:
    heard = []
    report = asyncio.run(measure(heard.append))
    assert tuple(heard) == report.sections
    return report


def values(report: Report) -> dict[str, float]:
    missing = [f"{figure.name}: {figure.note}" for figure in report.figures if figure.value is None]
    assert missing == []
    return {f"{section.title}: {f.name}": f.value for section in report.sections for f in section.figures}


@pytest.fixture(scope="module")
def video_report():
    return run(lambda on_section: video.run_video(video.smoke_plan(), on_section, CLOCK))


@pytest.fixture(scope="module")
def control_report():
    return run(lambda on_section: control.run_control(control.smoke_plan(), on_section, CLOCK))


def test_video_bench_measures_every_part(video_report):
    assert video_report.is_smoke
    assert [section.title.split(",")[0] for section in video_report.sections] == [
        "Python viewers",
        "One slow viewer among 4",
        "A link of 6 Mbit/s",
        "Chromium",
        "Taps name the painted picture",
        "The simulated robot",
    ]
    values(video_report)


def test_ages_and_rates_of_pictures_are_possible(video_report):
    for name, value in values(video_report).items():
        if "age" in name and name.endswith(("median", "median age", "95 %")):
            assert 0 < value < 2000, name
        if "rate" in name and "over" not in name:
            assert 1 < value < 60, name


def test_taps_name_the_painted_picture(video_report):
    misses = {name: value for name, value in values(video_report).items() if "misses" in name}
    assert len(misses) == 2
    assert set(misses.values()) == {0}


def test_control_bench_measures_every_part(control_report):
    assert control_report.is_smoke
    assert len(control_report.sections) == 4
    measured = values(control_report)
    assert measured["Command round trip: estimates made meanwhile"] > 0
    assert 0 < measured["Command round trip: to the driver, idle: median"] < 1000


def test_wheels_stop_whichever_way_the_operator_ends(control_report):
    stops = [section for section in control_report.sections if section.title.startswith("From the operator")]
    longest = {f.name: f.value for f in stops[0].figures if f.name.endswith("longest")}
    assert len(longest) == 4
    assert all(0 <= value < 2000 for value in longest.values())


def test_stale_commands_are_not_obeyed(control_report):
    assert [figure.value for figure in control_report.figures if "obeyed" in figure.name] == [0]


def test_what_is_left_behind_is_counted(control_report):
    """That nothing is left in the end is tested in scenarios; a second is short on a busy machine."""
    (left,) = (figure for figure in control_report.figures if figure.name.startswith("left"))
    assert left.value in (0, 1)
    assert left.note == "of 3 processes"


def test_report_of_a_bench_is_kept_whole(control_report, tmp_path):
    write_report(control_report, tmp_path / "control.json")
    assert read_report(tmp_path / "control.json") == control_report
