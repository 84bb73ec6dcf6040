"""The paper's board, an ATmega32U4 with its host on UART 1: greets, drives, stops by itself, sleeps.

Its encoder counts are not judged: simavr is not to be trusted with them on this chip.
"""

import pytest
from tests.firmware.sim.needs import needs_bed

from tapreach.drivers.arduino import wire
from tapreach.drivers.arduino.wire import Result, State

pytestmark = needs_bed


@pytest.fixture
def yun(host_of):
    return host_of("yun")


def test_it_is_welcomed_as_a_yun_and_tells_its_battery(yun):
    assert yun.open().board is wire.Board.YUN
    told = yun.telemetry()
    assert told.state is State.NEEDS_ZERO
    assert told.battery_mv == pytest.approx(7400, abs=40)
    assert not told.faults


def test_wheels_have_power_in_the_direction_asked_for_and_none_after_the_deadman(yun):
    assert yun.drive(0, 0) is Result.OK
    yun.drive_for(800, -800, 500_000)
    left, right = yun.rover.duties
    assert left > 0.1 and right < -0.1
    asked_us = yun.rover.now_us
    yun.run(400_000)
    assert yun.telemetry().state is State.TRIPPED
    assert yun.rover.off_since_us() - asked_us <= (wire.DEADMAN_MS + 1000 / wire.CONTROL_HZ) * 1000


def test_servo_pulses_are_as_long_as_asked_for(yun):
    assert yun.ask(wire.Servos((1200, 1500, 1700, 1900), (0, 0, 0, 0))) is Result.OK
    yun.run(1_500_000)
    assert [yun.rover.avr.pulse_us(pin) for pin in yun.rover.wiring.servos] == pytest.approx(
        [1200, 1500, 1700, 1900], abs=15
    )


def test_it_sleeps_between_events(yun):
    began_us = yun.rover.avr.asleep_us
    yun.run(1_000_000)
    assert yun.rover.avr.asleep_us - began_us > 600_000
