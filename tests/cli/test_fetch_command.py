"""`tapreach fetch` as a user types it, against a real server with the fake robot."""

import asyncio
import re
import signal
import subprocess

import pytest
from tests.client.conftest import turned_by_beats
from tests.scenarios.running import COMMAND
from tests.server import conftest as server
from typer.testing import CliRunner

from tapreach.cli.fetch import _conclude
from tapreach.cli.main import app
from tapreach.client.fetching import FetchResult, FetchStatus
from tapreach.errors import InputError, SetupError

description = server.description
play = server.play
PLACE = ("--at", "320,300")


def invoked(*arguments, text=""):
    return CliRunner().invoke(app, ["fetch", *arguments], input=text)


async def fetched(here, *arguments, text=""):
    """Run the command in a thread while the robot's clock turns."""
    command = asyncio.to_thread(invoked, "--url", f"http://{here.host}/", *arguments, text=text)
    return await turned_by_beats(here, command)


def test_plan_is_printed_a_line_a_phase(play):
    async def scenario(here):
        done = await fetched(here, *PLACE, "--mode", "plan")
        assert done.exit_code == 0, done.stderr
        heads = [line.split()[0] for line in done.stdout.splitlines()]
        assert heads == ["look", "preview", "planned"], done.stdout
        assert re.search(r"^preview .*\(.*away.*\)$", done.stdout, re.MULTILINE)
        assert re.search(r"^planned +can it be fetched: (yes|unsure); ", done.stdout, re.MULTILINE)

    play(scenario)


def test_no_to_the_plan_stops_and_exits_with_1(play):
    async def scenario(here):
        done = await fetched(here, *PLACE, "--mode", "confirm", text="n\n")
        assert done.exit_code == 1
        assert "fetch it? [y/N]" in done.stdout, done.stderr
        assert "stopped: stopped (button); the robot stands" in done.stderr

    play(scenario)


def test_refusal_is_a_sentence_on_stderr_and_exit_code_1(play):
    async def scenario(here):
        done = await fetched(here, *PLACE, "--frame", "999999")
        assert (done.exit_code, done.stdout) == (1, "")
        assert "not fetched: " in done.stderr and "999999" in done.stderr
        here.station.emergency_stop.press("Anna")
        done = await fetched(here, *PLACE)
        assert done.exit_code == 1
        assert "emergency stop" in done.stderr and "Anna" in done.stderr

    play(scenario)


def test_ctrl_c_stops_the_robot_and_says_so(play):
    async def scenario(here):
        command = [COMMAND, "fetch", "--url", f"http://{here.host}/", *PLACE]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            line = await turned_by_beats(here, asyncio.to_thread(process.stdout.readline))
            assert line.startswith("look")
            process.send_signal(signal.SIGINT)
            _, said = await turned_by_beats(here, asyncio.to_thread(process.communicate))
        assert process.returncode == 130
        assert "the robot stands" in said and "Traceback" not in said
        assert not here.station.tasks.is_running and here.speed == 0.0
        assert here.station.lease.status.holder_id is None

    play(scenario)


@pytest.mark.parametrize("status", FetchStatus)
def test_exit_code_tells_whether_it_is_held_or_planned(status, capsys):
    try:
        _conclude(FetchResult(status, "the reason", None))
        code = 0
    except Exception as ended:
        code = ended.exit_code
    printed = capsys.readouterr()
    assert code == (0 if status in ("held", "planned") else 1)
    assert "the reason" in (printed.err if code else printed.out)


def test_without_a_server_it_says_how_to_start_one():
    result = invoked("--url", "http://127.0.0.1:9/", *PLACE)
    assert isinstance(result.exception, SetupError)
    assert "start one with `tapreach run`" in str(result.exception)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((), "give --at U,V or --box"),
        (("--at", "320"), "--at is '320'"),
        (("--at", "a,b"), "like 320,240"),
        (("--at", "nan,1"), "--at"),
        (("--at", "1,2", "--box", "1,2,3"), "--box is '1,2,3'"),
        (("--box", "1,2,3,4"), "at least 4 px"),
        (("--at", "1,2", "--url", "https://rover.test"), "https://rover.test"),
    ],
)
def test_place_that_makes_no_sense_is_named(arguments, message):
    result = invoked(*arguments)
    assert isinstance(result.exception, InputError)
    assert message in str(result.exception)


def test_address_may_come_from_the_environment(monkeypatch):
    monkeypatch.setenv("TAPREACH_URL", "gopher://rover")
    assert "gopher://rover" in str(invoked(*PLACE).exception)
