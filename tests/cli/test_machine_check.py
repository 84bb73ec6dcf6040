"""Wi-Fi and disk, as the doctor sees them."""

import shutil
from collections import namedtuple

import pytest

from tapreach.cli.checkup.check import Check, Verdict, graded, worst
from tapreach.cli.checkup.machine_check import Signal, check_disk, check_wifi, read_signals

HEAD = (
    "Inter-| sta-|   Quality        |   Discarded packets               | Missed | WE\n"
    " face | tus | link level noise |  nwid  crypt   frag  retry   misc | beacon | 22\n"
)
LINE = " {}: 0000   54.  {}.  -256        0      0      0      0     21        0\n"


def proc_file(tmp_path, *lines):
    path = tmp_path / "wireless"
    path.write_text(HEAD + "".join(lines), encoding="ascii")
    return path


def test_signals_are_read_with_levels_of_both_kinds():
    text = HEAD + LINE.format("wlan0", "-56") + LINE.format("wlp2s0", "200") + "broken\n\n x: a b c\n"
    assert read_signals(text) == [Signal("wlan0", -56.0), Signal("wlp2s0", -56.0)]
    assert read_signals("") == []


@pytest.mark.parametrize(
    ("level", "verdict"), [("-50", Verdict.OK), ("-75", Verdict.WARN), ("-88", Verdict.FAIL)]
)
def test_wifi_is_judged_by_its_level(tmp_path, level, verdict):
    check = check_wifi(True, proc_file(tmp_path, LINE.format("wlan0", level)))
    assert (check.verdict, check.figures["signal_dbm"]) == (verdict, float(level))
    assert bool(check.advice) is (verdict is not Verdict.OK)


def test_strongest_of_two_counts(tmp_path):
    path = proc_file(tmp_path, LINE.format("wlan0", "-90"), LINE.format("wlan1", "-40"))
    assert check_wifi(True, path).figures["interface"] == "wlan1"


@pytest.mark.parametrize("lines", [(), (LINE.format("wlan0", "0"),)])
def test_missing_wifi_matters_only_where_the_robot_is_behind_a_network(tmp_path, lines):
    path = proc_file(tmp_path, *lines)
    assert check_wifi(False, path).verdict is Verdict.OK
    assert check_wifi(True, path).verdict is Verdict.WARN
    assert check_wifi(True, tmp_path / "none").verdict is Verdict.WARN


@pytest.mark.parametrize(("free", "verdict"), [(5e10, Verdict.OK), (1e9, Verdict.WARN), (1e8, Verdict.FAIL)])
def test_disk_is_judged_where_the_folder_will_be(tmp_path, monkeypatch, free, verdict):
    usage = namedtuple("usage", "total used free")
    asked = []
    monkeypatch.setattr(shutil, "disk_usage", lambda path: asked.append(path) or usage(0, 0, int(free)))
    check = check_disk(tmp_path / "not" / "yet")
    assert check.verdict is verdict
    assert asked == [tmp_path]


def test_grades_go_both_ways_and_the_worst_counts():
    assert [graded(value, 10, 20) for value in (9, 10, 20)] == list(Verdict)
    assert [graded(value, -10, -20) for value in (-9, -10, -20)] == list(Verdict)
    assert worst([]) is Verdict.OK
    assert worst([Check("a", Verdict.FAIL, ""), Check("b", Verdict.WARN, "")]) is Verdict.FAIL
