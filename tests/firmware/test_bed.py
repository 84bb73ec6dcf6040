"""The test bed itself, shown right with a program so small that it can be read (sim/trivial.c)."""

import pytest
from tests.firmware.sim.avr import Avr, ResetCause
from tests.firmware.sim.needs import needs_bed
from tests.firmware.sim.trivial import PWM, SERVO, WIRING, A, B, trivial_elf

pytestmark = needs_bed


@pytest.fixture
def avr():
    made = Avr(trivial_elf(), WIRING.chip)
    made.connect_encoder(0, A, B)
    made.run(6_000)
    yield made
    made.close()


def ask(avr, command, wait_us=2_000):
    avr.send(command)
    avr.run(wait_us)
    return avr.receive()


def test_bytes_come_back_at_the_rate_of_the_line(avr):
    data = bytes(range(1, 90))
    avr.send(data)
    avr.run_to(avr.now_us + 1_000)
    began, heard = avr.now_us, avr.receive()
    before = len(heard)
    avr.run(5_000)
    heard += avr.receive()
    # Ten bits for each byte at 115200 baud, as near to it as whole cycles of 16 MHz and the loop come.
    assert (avr.now_us - began) / (len(heard) - before) == pytest.approx(1e7 / 115_200, rel=0.1)
    assert data.startswith(heard)


@pytest.mark.parametrize("value", [1, 64, 128, 200])
def test_duty_is_that_of_whole_periods(avr, value):
    avr.send(b"p" + bytes([value]))
    avr.run(10_000)
    assert avr.duty(PWM) == pytest.approx((value + 1) / 256, abs=1e-3)
    before = avr.high_us(PWM)
    avr.run(10 * 1024)
    assert (avr.high_us(PWM) - before) / (10 * 1024) == pytest.approx((value + 1) / 256, abs=2e-3)


def test_pulse_width_is_measured(avr):
    avr.run(45_000)
    assert avr.pulse_us(SERVO) == pytest.approx(1500, abs=5)


@pytest.mark.parametrize("edges", [400, -400])
def test_every_edge_of_the_wheel_arrives(avr, edges):
    for part in range(1, 11):
        avr.encoder_to(0, edges * part // 10, 10_000)
        avr.run(10_000)
    assert avr.encoder_edges(0) == edges
    assert int.from_bytes(ask(avr, b"c"), "little", signed=True) == edges // 2


def test_broken_cable_hides_the_wheel(avr):
    avr.break_encoder(0)
    avr.encoder_to(0, 100, 10_000)
    avr.run(12_000)
    assert avr.encoder_edges(0) == 100
    assert ask(avr, b"c") == b"\0\0"


@pytest.mark.parametrize("millivolts", [0, 1200, 3700])
def test_adc_reads_the_voltage(avr, millivolts):
    avr.adc(0, millivolts)
    assert int.from_bytes(ask(avr, b"a"), "little") == pytest.approx(millivolts / 5000 * 1024, abs=1.5)


@pytest.mark.parametrize("cause", list(ResetCause))
def test_reset_tells_its_cause_and_stops_the_pins(avr, cause):
    avr.send(b"p" + bytes([200]))
    avr.run(5_000)
    avr.reset(cause)
    assert avr.level(PWM) == 0
    avr.run(1_000)
    assert ask(avr, b"r") == bytes([cause])
    assert avr.duty(PWM) < 0.01


def test_hanging_processor_is_bitten_by_its_watchdog(avr):
    avr.send(b"d")
    avr.run(5_000)
    avr.stall()
    avr.run(60_000)
    assert ask(avr, b"x") == b""
    avr.run(120_000)
    avr.unstall()
    avr.run(5_000)
    assert ask(avr, b"r")[-1:] == bytes([ResetCause.WATCHDOG])
