"""The compiled firmware in a simulated microcontroller and robot: the session."""

import pytest
from tests.firmware.sim.needs import needs_bed

from tapreach.drivers.arduino import wire

pytestmark = needs_bed
BOARDS = ("uno", "mega")


@pytest.fixture(params=BOARDS)
def any_host(request, host_of):
    return host_of(request.param)


def test_hello_is_welcomed(any_host):
    welcome = any_host.open()
    assert welcome.version == wire.VERSION
    assert welcome.board.name.lower() in BOARDS
    assert (welcome.deadman_ms, welcome.telemetry_hz) == (wire.DEADMAN_MS, wire.TELEMETRY_HZ)
    assert {wire.Feature.QUADRATURE, wire.Feature.SERVOS} <= set(welcome.features)
