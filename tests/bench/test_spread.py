"""Work over several processes: results in order, and nobody left when the bench is killed."""

import os
import select
import subprocess
import sys
from pathlib import Path

import pytest

from tapreach.bench.spread import spread

TESTS = Path(__file__).resolve().parents[1]
PATIENCE_S = 30.0


def test_results_come_in_the_order_of_the_tasks() -> None:
    assert spread(abs, [-3, 2, -1], 1) == spread(abs, [-3, 2, -1], 2) == [3, 2, 1]


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the workers end with their pipe")
def test_workers_end_when_the_bench_is_killed() -> None:
    path = os.pathsep.join([str(TESTS), os.environ.get("PYTHONPATH", "")])
    bench = subprocess.Popen(
        [sys.executable, "-c", "from bench.waiting import main; main()"],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": path},
    )
    assert bench.stdout is not None
    with bench.stdout:
        workers = [os.pidfd_open(int(bench.stdout.readline())) for _ in range(2)]
        bench.kill()
        bench.wait()
        for worker in workers:
            assert select.select([worker], [], [], PATIENCE_S)[0], "a worker goes on"
            os.close(worker)
