import os
import subprocess
import sys

import pytest

from tapreach.bench.proc import cpu_seconds, family, identify, is_alive

INNER = "import sys; print(1, flush=True); sys.stdin.read()"
NESTED = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {INNER!r}])"


@pytest.fixture
def parent():
    process = subprocess.Popen(
        [sys.executable, "-c", NESTED], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    process.stdout.readline()
    yield process
    process.stdin.close()  # both read the end of it, and end
    process.stdout.close()
    process.wait(timeout=20)


def test_family_holds_the_process_and_its_grandchildren(parent):
    own = family(os.getpid())
    assert own[0].pid == os.getpid()
    assert parent.pid in [member.pid for member in own]
    grandchild = family(parent.pid)[1]
    assert "stdin.read" in grandchild.command
    assert grandchild in own


def test_ended_process_is_not_alive(parent):
    members = family(parent.pid)
    assert all(map(is_alive, members))
    parent.stdin.close()
    parent.wait(timeout=20)
    assert not any(map(is_alive, members))


def test_zombie_is_not_alive():
    process = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    who = identify(process.pid)
    process.stdin.close()
    os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)  # ended, and not yet collected
    assert not is_alive(who)
    process.wait()


def test_cpu_time_grows_with_work():
    before = cpu_seconds(os.getpid())
    while cpu_seconds(os.getpid()) < before + 0.03:
        sum(range(10_000))


def test_process_that_is_gone_has_no_cpu_time():
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    with pytest.raises(OSError, match=str(process.pid)):
        cpu_seconds(process.pid)
