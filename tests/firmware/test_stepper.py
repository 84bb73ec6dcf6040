"""Stepper motors behind the same commands: ramps, exact steps, the same deadman; on a host and in simavr."""

import os
import random

import pytest
from tests.firmware.host.board import HAS_COMPILER, MS
from tests.firmware.host.stepper_board import StepperBoard
from tests.firmware.sim.boards import WIRING
from tests.firmware.sim.host import Host
from tests.firmware.sim.needs import needs_bed
from tests.firmware.sim.rover import Rover
from typer.testing import CliRunner

from tapreach.cli.firmware import firmware
from tapreach.drivers.arduino import wire
from tapreach.drivers.arduino.build import missing_tools
from tapreach.drivers.arduino.wire import Fault, Feature, MoveResult, Result, State

needs_host = pytest.mark.skipif(not HAS_COMPILER, reason="needs g++ (Debian: apt-get install g++)")
needs_compiler = pytest.mark.skipif(
    bool(missing_tools()) and not os.environ.get("CI"), reason="needs gcc-avr avr-libc arduino-core-avr"
)
PERIOD_S = 1 / wire.CONTROL_HZ
BY_PLACE = 24
"""What the hold of the place may add to a ramp's change in a period [steps/s]: three steps of error."""
MOST_ACCELERATION = 6000
FASTEST = 4500
STEP_PINS = WIRING["uno"].pwm


def ready() -> StepperBoard:
    board = StepperBoard()
    board.make_ready()
    return board


def stepper_elf(board, folder):
    """Build as a user does, and return the ELF; a firmware that does not fit exits with 1."""
    target = folder / f"{board}.elf"
    words = ["build", "--board", board, "--drive", "stepper", "--out", str(target)]
    done = CliRunner().invoke(firmware, words)
    assert done.exit_code == 0, done.output
    return target


@needs_host
@pytest.mark.parametrize("speeds", [(300, 300), (-2000, 2000), (2900, 100), (0, -700), (17, -1)])
def test_speed_is_reached_and_every_step_of_it_made(speeds):
    board = ready()
    for _ in range(40):
        board.drive(*speeds)
        board.run(50 * MS)
    before = board.angles
    for _ in range(40):
        board.drive(*speeds)
        board.run(50 * MS)
    gone = [after - earlier for after, earlier in zip(board.angles, before, strict=True)]
    assert gone == pytest.approx([2 * speed for speed in speeds], abs=2)


@needs_host
def test_ramps_keep_to_the_acceleration_also_when_turning_round():
    board = ready()
    draw = random.Random(11)
    for _ in range(30):
        left, right = draw.randrange(-3000, 3001), draw.randrange(-3000, 3001)
        for _ in range(draw.randrange(2, 30)):
            board.drive(left, right)
            board.run(50 * MS)
        assert board.largest_jump() <= MOST_ACCELERATION * PERIOD_S + BY_PLACE
    assert board.lib.turns_without_notice() == 0


@needs_host
def test_zero_stops_by_a_ramp_and_stays_ready():
    board = ready()
    for _ in range(30):
        board.drive(2000, 2000)
        board.run(50 * MS)
    assert board.drive(0, 0) is Result.OK
    board.run_kept(1000 * MS)
    assert board.pwm == (0, 0)
    assert board.largest_jump() <= MOST_ACCELERATION * PERIOD_S + BY_PLACE
    assert board.telemetry().state is State.READY


@needs_host
def test_relative_moves_are_exact_and_within_their_acceleration():
    draw = random.Random(5)
    board = ready()
    for number in range(1, 31):
        left, right = draw.randrange(-4000, 4001), draw.randrange(-4000, 4001)
        speed, acceleration = draw.randrange(100, 3000), draw.randrange(300, 3000)
        before = board.angles
        board.largest_jump()
        asked = wire.Move(number, left, right, speed, acceleration, board.now_ms)
        assert board.result(asked) is Result.OK
        for _ in range(1000):
            board.tell(wire.Keep(board.now_ms))
            board.run(50 * MS)
            if ended := board.all_heard(wire.Moved):
                break
        board.heard.clear()
        assert (ended[0].id, ended[0].result) == (number, MoveResult.DONE)
        gone = [after - earlier for after, earlier in zip(board.angles, before, strict=True)]
        assert tuple(gone) == (ended[0].left, ended[0].right) == (left, right)
        assert board.largest_jump() <= acceleration * PERIOD_S + BY_PLACE


@needs_host
def test_deadman_stops_the_steps_at_once():
    board = ready()
    for _ in range(30):
        board.drive(1500, -1500)
        board.run(50 * MS)
    board.drive(1500, -1500)
    said_us = board.now_us
    board.run(400 * MS)
    assert board.pwm == (0, 0)
    assert board.lib.off_since() - said_us <= (wire.DEADMAN_MS + 10) * MS
    assert board.telemetry().state is State.TRIPPED
    stood = board.angles
    board.run(1000 * MS)
    assert board.angles == stood
    assert board.drive(100, 100) is Result.NEEDS_ZERO


@needs_host
def test_gains_set_the_limits_alone():
    board = ready()
    assert board.result(wire.Gains(9, 9, 9, 9, 500, 700)) is Result.OK
    assert board.drive(501, 0) is Result.OUT_OF_RANGE
    for _ in range(40):
        board.drive(400, 400)
        board.run(50 * MS)
    assert board.pwm == pytest.approx((400, 400), abs=10)
    assert board.largest_jump() <= 700 * PERIOD_S + BY_PLACE
    board.result(wire.Stop())
    assert board.result(wire.Gains(9, 9, 9, 9, 5000, 700)) is Result.OUT_OF_RANGE


@needs_host
def test_raw_pwm_of_ros_arduino_bridge_is_refused_and_its_speeds_are_not():
    board = StepperBoard()
    assert board.feed(b"m 0 0\r") == b"OK\r\n"
    assert board.feed(b"o 100 100\r").startswith(b"Invalid")
    assert board.feed(b"m 20 20\r") == b"OK\r\n"
    board.run(1500 * MS)
    assert board.angles == pytest.approx((20 * 30 * 1.4,) * 2, rel=0.1)


@needs_compiler
@pytest.mark.parametrize("name", ["mega", "leonardo"])
def test_stepper_build_fits_the_other_chips(name, tmp_path):
    assert stepper_elf(name, tmp_path).read_bytes()[:4] == b"\x7fELF"


@needs_bed
def test_every_step_that_is_told_was_made_at_the_pin_of_an_uno(tmp_path):
    rover = Rover(stepper_elf("uno", tmp_path), WIRING["uno"])
    host = Host(rover)
    rover.run(20_000.0)
    assert Feature.STEPPER in host.open().features
    assert host.drive(0, 0) is Result.OK
    before = [rover.avr.edges(pin) for pin in STEP_PINS]
    moved = host.move(1000, -400, speed=1200, acceleration=2500)
    assert (moved.result, moved.left, moved.right) == (MoveResult.DONE, 1000, -400)
    rover.run(1000.0)
    made = [(rover.avr.edges(pin) - first) / 2 for pin, first in zip(STEP_PINS, before, strict=True)]
    assert made == [1000, 400]
    assert host.ask(wire.Servos((1600, 0, 0, 0), (0, 0, 0, 0))) is Result.OK
    at = host.telemetry()
    before = [rover.avr.edges(pin) for pin in STEP_PINS]
    host.drive_for(FASTEST, -FASTEST, 1_200_000.0)
    told = host.telemetry()
    assert (told.faults, told.state) == (Fault(0), State.DRIVING)
    assert (told.left_speed, told.right_speed) == pytest.approx((FASTEST, -FASTEST), abs=60)
    made = [(rover.avr.edges(pin) - first) / 2 for pin, first in zip(STEP_PINS, before, strict=True)]
    assert made == pytest.approx((told.left - at.left, at.right - told.right), abs=0.04 * FASTEST)
    assert rover.avr.pulse_us(WIRING["uno"].servos[0]) == pytest.approx(1600, abs=20)
    rover.close()
