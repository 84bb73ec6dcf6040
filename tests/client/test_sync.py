"""Blocking scripts, in processes of their own, against a real `tapreach run`: also killed and frozen ones."""

import contextlib
import json
import signal
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import pytest
from tests.scenarios.running import tapreach_run
from websockets.sync.client import ClientConnection
from websockets.sync.client import connect as open_socket

from tapreach.client.control_link import RequestRefused
from tapreach.client.sync import connect
from tapreach.errors import InputError, SetupError

LOCATES = """
import sys
from tapreach.client.sync import connect

with connect(sys.argv[1], name="doomed") as robot:
    while True:
        print("locating", flush=True)
        robot.locate(robot.snapshot().frame_id, 320, 300)
"""


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    """Where a fake robot is served by a process of its own."""
    with tapreach_run(tmp_path_factory.mktemp("captures"), "--robot", "fake") as run:
        yield run.address


class Watcher:
    """Somebody who only watches."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket
        self._socket.send(json.dumps({"type": "hello", "seq": 1, "name": "watcher"}))
        self.news: dict[str, Any] = {}

    def until(self, holds: Callable[[dict[str, Any]], Any]) -> None:
        """Read news until `holds`; pytest-timeout bounds it, news never end."""
        while not holds(self.news):
            message = json.loads(self._socket.recv(timeout=30))
            self.news[message["type"]] = message


@contextlib.contextmanager
def watching(address):
    """Somebody who watches; to be read from soon, or the server gives up on them."""
    with open_socket(address.replace("http", "ws") + "ws/control", proxy=None) as socket:
        yield Watcher(socket)


def test_script_looks_and_asks_in_plain_calls(address):
    with connect(address) as robot:
        shot = robot.snapshot()
        assert shot.picture().shape == (robot.picture_size.height, robot.picture_size.width, 3)
        with pytest.raises(InputError, match="outside the picture"):
            robot.fetch(shot.frame_id, 1e6, 0.0)
        with pytest.raises(RequestRefused, match="nothing is held"):
            robot.follow_up("hand_over")
        robot.emergency_stop()
        with pytest.raises(RequestRefused, match="emergency stop"):
            robot.locate(shot.frame_id, 320, 300)
        robot.emergency_reset()


def test_what_is_raised_while_a_phase_is_shown_stops_the_robot(address):
    class Enough(Exception): ...

    def on_phase(phase):
        assert phase.phase == "look"
        raise Enough

    with pytest.raises(Enough), connect(address, name="brief") as robot:
        robot.fetch(robot.snapshot().frame_id, 320, 300, on_phase=on_phase)
    with watching(address) as watcher:
        watcher.until(lambda news: news.get("task", {}).get("state") == "cancelled")
        watcher.until(lambda news: news["state"]["lease"]["holder_id"] is None)


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_script_that_is_ended_leaves_the_robot_at_rest_and_free(address, number):
    with doomed(address) as script, watching(address) as watcher:
        watcher.until(runs)
        script.send_signal(number)
        script.wait(timeout=30)
        watcher.until(lambda news: news["state"]["lease"]["holder_id"] is None)
        watcher.until(lambda news: news["task"]["state"] == "cancelled")
        watcher.until(at_rest)


def test_script_that_is_frozen_stops_the_robot(address):
    with doomed(address) as script, watching(address) as watcher:
        watcher.until(runs)
        script.send_signal(signal.SIGSTOP)
        watcher.until(lambda news: news["task"]["state"] == "cancelled")
        assert "not heard" in watcher.news["task"]["message"]
        watcher.until(at_rest)


def test_address_of_nobody_is_told_at_once():
    with pytest.raises(SetupError, match="tapreach run"), connect("http://127.0.0.1:9/"):
        raise AssertionError("nobody is there")


def doomed(address):
    """A script that locates until something ends it."""
    script = subprocess.Popen(
        [sys.executable, "-c", LOCATES, address], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    )
    assert script.stdout is not None
    assert "locating" in script.stdout.readline()
    return Doomed(script)


class Doomed:
    """Kills what is left of it at the end."""

    def __init__(self, process: "subprocess.Popen[str]") -> None:
        self._process = process

    def __enter__(self) -> "subprocess.Popen[str]":
        return self._process

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.communicate()


def runs(news):
    return news.get("task", {}).get("state") == "running" and news["task"]["kind"] == "locate"


def at_rest(news):
    return news["state"]["sent"] == {"linear": 0.0, "angular": 0.0}
