"""`tapreach run` as a process: how it starts, fails, ends, and what it leaves behind (nothing)."""

import os
import signal
import socket
import subprocess
import time
import urllib.request
from pathlib import Path

import pytest
from tests.scenarios.running import COMMAND, Running, is_alive, tapreach_run

GONE_WITHIN_S = 1.0


def gone(pids: set[int], within_s: float = GONE_WITHIN_S) -> bool:
    deadline = time.monotonic() + within_s
    while any(map(is_alive, pids)) and time.monotonic() < deadline:
        os.sched_yield()
    return not any(map(is_alive, pids))


@pytest.fixture
def running(tmp_path: Path):
    with tapreach_run(tmp_path) as run:
        yield run


def test_page_is_served_at_the_printed_address(running: Running) -> None:
    with urllib.request.urlopen(running.address, timeout=5) as answer:
        assert answer.status == 200
        assert b"<html" in answer.read()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signal_ends_everything_with_a_plain_sentence(running: Running, number: signal.Signals) -> None:
    children = running.children()
    assert children, "the simulator runs in a process of its own"
    printed = running.end(number)
    assert "Traceback" not in printed
    assert "Stopped" in printed
    assert running.process.returncode == 0
    assert gone(children)


def test_killed_parent_leaves_no_process(running: Running) -> None:
    children = running.children()
    running.end(signal.SIGKILL)
    assert gone(children)


def test_dead_simulator_is_told_and_does_not_end_the_server(running: Running) -> None:
    simulator = _process_running(running.children(), "tapreach.drivers.sim.child")
    os.kill(simulator, signal.SIGKILL)
    assert gone({simulator})
    with urllib.request.urlopen(running.address, timeout=5) as answer:
        assert answer.status == 200
    printed = running.end(signal.SIGINT)
    assert "Traceback" not in printed
    assert running.process.returncode == 0


def test_port_taken_is_a_plain_sentence() -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        result = _run("run", "--port", str(port))
    assert result.returncode == 2
    assert str(port) in result.stderr
    assert "--port" in result.stderr
    assert "Traceback" not in result.stderr


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("--robot", "dalek"), "sim"),
        (("--scene", "atlantis"), "room"),
        (("--fault", "gremlins=1"), "slip"),
        (("--fault", "slip"), "slip=0.02"),
        (("--size", "huge"), "640x480"),
    ],
)
def test_wrong_argument_lists_what_would_be_right(arguments: tuple[str, str], named: str) -> None:
    result = _run("run", "--port", "0", *arguments)
    assert result.returncode == 2
    assert named in result.stderr
    assert "Traceback" not in result.stderr


def _run(*arguments: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run([COMMAND, *arguments], capture_output=True, text=True, timeout=60, check=False)


def _process_running(pids: set[int], module: str) -> int:
    for pid in pids:
        if module in Path(f"/proc/{pid}/cmdline").read_text():
            return pid
    raise AssertionError(f"no child runs {module}")
