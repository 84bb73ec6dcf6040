"""The compiled firmware in a simulated microcontroller and robot: session, wheels, servos, faults."""

import math
from itertools import pairwise

import pytest
from tests.firmware.sim.avr import ResetCause
from tests.firmware.sim.needs import needs_bed

from tapreach.drivers.arduino import wire
from tapreach.drivers.arduino.wire import Fault, Result, State

pytestmark = needs_bed
BOARDS = ("uno", "mega")


@pytest.fixture(params=BOARDS)
def any_host(request, host_of):
    return host_of(request.param)


@pytest.fixture
def host(host_of):
    return host_of("uno")


def until(host, wanted, us=1_000_000):
    return host.await_message(wire.Telemetry, wanted, us)


def test_hello_is_welcomed(any_host):
    welcome = any_host.open()
    assert welcome.version == wire.VERSION
    assert welcome.board.name.lower() in BOARDS
    assert (welcome.deadman_ms, welcome.telemetry_hz) == (wire.DEADMAN_MS, wire.TELEMETRY_HZ)
    assert {wire.Feature.QUADRATURE, wire.Feature.SERVOS} <= set(welcome.features)


def test_telemetry_comes_at_its_rate_with_the_boards_clock(any_host):
    heard = [r.message for r in any_host.run(1_000_000) if isinstance(r.message, wire.Telemetry)]
    steps_us = [b.at_us - a.at_us for a, b in pairwise(heard)]
    assert len(heard) == pytest.approx(wire.TELEMETRY_HZ, abs=1)
    assert all(step == pytest.approx(1e6 / wire.TELEMETRY_HZ, abs=1_500) for step in steps_us)
    assert sum(steps_us) / len(steps_us) == pytest.approx(1e6 / wire.TELEMETRY_HZ, abs=100)


def test_clocks_agree(host):
    told = host.telemetry()
    assert told.at_us == pytest.approx(host.rover.now_us + host.offset_us, abs=8_000)


@pytest.mark.parametrize(("left", "right"), [(700, 700), (-900, -900), (600, -600), (300, 1200)])
def test_wheels_turn_as_they_are_told(any_host, left, right):
    any_host.drive(0, 0)
    any_host.drive_for(left, right, 1_000_000)
    began, began_us = any_host.rover.ticks, any_host.rover.now_us
    any_host.drive_for(left, right, 1_000_000)
    seconds = (any_host.rover.now_us - began_us) / 1e6
    speeds = [(b - a) / seconds for a, b in zip(began, any_host.rover.ticks, strict=True)]
    assert speeds == pytest.approx([left, right], rel=0.03)
    told = any_host.telemetry()
    assert (told.left_speed, told.right_speed) == pytest.approx((left, right), rel=0.2)
    assert told.state is State.DRIVING


def test_ticks_told_are_those_of_the_wheels(any_host):
    any_host.drive(0, 0)
    any_host.drive_for(1500, -1100, 1_500_000)
    any_host.send(wire.Stop())
    any_host.run(1_000_000)
    told = any_host.telemetry()
    assert (told.left, told.right) == any_host.rover.ticks
    assert not told.faults


def test_stop_takes_the_power_at_once_and_wants_a_zero(host):
    host.drive(0, 0)
    host.drive_for(800, 800, 300_000)
    sent_us = host.rover.now_us
    assert host.ask(wire.Stop()) is Result.OK
    host.run(20_000)
    assert host.rover.off_since_us() - sent_us < 5_000
    assert host.drive(500, 500) is Result.NEEDS_ZERO
    assert host.drive(0, 0) is Result.OK
    assert host.drive(500, 500) is Result.OK


def test_wheels_need_a_zero_after_the_start(host):
    assert host.drive(500, 500) is Result.NEEDS_ZERO
    host.run(100_000)
    assert host.rover.powered_us() == 0


@pytest.mark.parametrize(
    ("age_ms", "result"), [(100, Result.OK), (180, Result.TOO_OLD), (-70, Result.TOO_OLD)]
)
def test_age_of_a_command_is_judged_by_the_firmware(host, age_ms, result):
    host.drive(0, 0)
    assert host.ask(wire.Drive(400, 400, (host.at_ms - age_ms) & 0xFFFFFFFF)) is result


def test_servos_go_to_their_place_at_their_speed(any_host):
    start, goal, speed = (1500, 1500, 1500, 1500), (1800, 1300, 1550, 1500), (500, 400, 100, 100)
    assert any_host.ask(wire.Servos(start, (1000,) * 4)) is Result.OK
    any_host.run(1_500_000)
    assert any_host.ask(wire.Servos(goal, speed)) is Result.OK
    began_us = any_host.rover.now_us
    for _ in range(60):
        any_host.run(20_000)
        passed = (any_host.rover.now_us - began_us) / 1e6
        for pin, a, b, rate in zip(any_host.rover.wiring.servos, start, goal, speed, strict=True):
            on_the_way = a + math.copysign(min(abs(b - a), rate * passed), b - a)
            assert any_host.rover.avr.pulse_us(pin) == pytest.approx(on_the_way, abs=0.06 * rate + 12)
    assert any_host.telemetry().pulse_us == pytest.approx(goal, abs=2)


def test_servos_hold_when_the_host_is_gone(host):
    host.ask(wire.Servos((1700, 1500, 1500, 1500), (2000,) * 4))
    host.run(4_000_000)
    pin = host.rover.wiring.servos[0]
    edges = host.rover.avr.edges(pin)
    host.run(1_000_000)
    assert host.rover.avr.edges(pin) - edges == pytest.approx(100, abs=4)
    assert host.rover.avr.pulse_us(pin) == pytest.approx(1700, abs=15)


@pytest.mark.parametrize("millivolts", [6600, 7400, 8200])
def test_battery_is_told(any_host, millivolts):
    any_host.rover.battery_mv(millivolts)
    any_host.run(1_500_000)
    assert any_host.telemetry().battery_mv == pytest.approx(millivolts, rel=0.02)


def test_low_battery_stops_the_wheels(host):
    host.drive(0, 0)
    host.drive_for(600, 600, 300_000)
    host.rover.battery_mv(3000)
    for _ in range(100):
        host.drive(600, 600)
        host.run(50_000)
    assert Fault.BATTERY_LOW in host.telemetry().faults
    assert host.rover.now_us - host.rover.off_since_us() > 10_000


def test_pulled_stop_input_takes_the_power_and_stays_latched(any_host):
    any_host.drive(0, 0)
    any_host.drive_for(800, 800, 300_000)
    pulled_us = any_host.rover.now_us
    any_host.rover.pull_stop()
    any_host.run(60_000)
    assert any_host.rover.off_since_us() - pulled_us < 25_000
    any_host.rover.pull_stop(False)
    any_host.run(100_000)
    assert any_host.drive(0, 0) in (Result.FAULTED, Result.OK)
    assert any_host.drive(500, 500) is Result.FAULTED
    assert Fault.STOP_INPUT in any_host.telemetry().faults
    assert any_host.ask(wire.Clear(Fault.STOP_INPUT)) is Result.OK
    assert any_host.drive(500, 500) is Result.NEEDS_ZERO
    assert any_host.drive(0, 0) is Result.OK
    assert any_host.drive(500, 500) is Result.OK


def test_stop_input_that_is_still_pulled_cannot_be_cleared(host):
    host.rover.pull_stop()
    host.run(100_000)
    assert host.ask(wire.Clear(Fault.STOP_INPUT)) is Result.FAULTED


def test_wheel_whose_encoder_is_silent_stops(host):
    host.drive(0, 0)
    host.rover.avr.break_encoder(0)
    for _ in range(60):
        host.drive(800, 800)
        host.run(50_000)
    assert Fault.ENCODER_STUCK in host.telemetry().faults
    assert host.rover.now_us - host.rover.off_since_us() > 100_000


@pytest.mark.parametrize(
    ("cause", "fault"),
    [
        (ResetCause.BROWN_OUT, Fault.BROWN_OUT_RESET),
        (ResetCause.WATCHDOG, Fault.WATCHDOG_RESET),
        (ResetCause.EXTERNAL, Fault(0)),
    ],
)
def test_restart_while_driving_is_seen_and_moves_nothing(host, cause, fault):
    before = host.open()
    host.drive(0, 0)
    host.drive_for(800, 800, 300_000)
    host.rover.reset(cause)
    host.run(300_000)
    powered_us = host.rover.powered_us()
    after = host.open()
    assert after.reset_cause == wire.ResetCause(int(cause))
    assert after.boot_id != before.boot_id
    assert host.drive(500, 500) in (Result.NEEDS_ZERO, Result.FAULTED)
    assert host.telemetry().faults & (Fault.BROWN_OUT_RESET | Fault.WATCHDOG_RESET) == fault
    assert host.rover.powered_us() == powered_us


def test_hanging_firmware_is_restarted_and_the_wheels_go_off(host):
    host.drive(0, 0)
    host.drive_for(800, 800, 300_000)
    host.rover.avr.stall()
    hung_us = host.rover.now_us
    host.run(700_000)
    host.rover.avr.unstall()
    host.run(300_000)
    assert host.rover.off_since_us() - hung_us < 600_000
    assert host.open().reset_cause is wire.ResetCause.WATCHDOG
