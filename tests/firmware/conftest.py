"""Hosts that have a session with the compiled firmware, in a simulated robot."""

import pytest
from tests.firmware.sim.started import started_host, stop


@pytest.fixture
def host_of():
    """Return `host_of(board)`: a fresh robot each, stopped after the test."""
    hosts = []

    def start(board):
        hosts.append(started_host(board))
        return hosts[-1]

    yield start
    for host in hosts:
        stop(host)
