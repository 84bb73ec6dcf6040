"""Wheel speeds, relative moves and servos against simple motors that stick."""

import random
from itertools import pairwise

import pytest
from tests.firmware.host.board import HAS_COMPILER, MS, Board

from tapreach.drivers.arduino import wire
from tapreach.drivers.arduino.wire import Fault, MoveResult, Result, State

pytestmark = pytest.mark.skipif(not HAS_COMPILER, reason="needs g++ (Debian: apt-get install g++)")


def ready() -> Board:
    board = Board()
    board.make_ready()
    return board


@pytest.mark.parametrize("speeds", [(300, 300), (-2000, 2000), (1500, 100), (0, -700)])
def test_speed_is_reached_and_held(speeds):
    board = ready()
    for _ in range(20):
        board.drive(*speeds)
        board.run(50 * MS)
    before = board.angles
    for _ in range(20):
        board.drive(*speeds)
        board.run(50 * MS)
    gone = [after - earlier for after, earlier in zip(board.angles, before, strict=True)]
    assert gone == pytest.approx(speeds, rel=0.03, abs=8)
    told = board.telemetry()
    assert told.state is State.DRIVING
    assert (told.left_speed, told.right_speed) == pytest.approx(speeds, rel=0.1, abs=40)


def test_zero_stops_by_a_ramp_and_stays_ready():
    board = ready()
    for _ in range(10):
        board.drive(1500, 1500)
        board.run(50 * MS)
    assert board.drive(0, 0) is Result.OK
    board.run_kept(1000 * MS)
    assert board.pwm == (0, 0)
    assert board.telemetry().state is State.READY
    assert board.drive(300, 300) is Result.OK


def moves(draw: random.Random) -> tuple[int, int, int, int]:
    return (
        draw.randrange(-3000, 3001),
        draw.randrange(-3000, 3001),
        draw.randrange(300, 2500),
        draw.randrange(500, 8000),
    )


def test_relative_moves_end_within_two_ticks_at_rest():
    draw = random.Random(3)
    board = ready()
    for number in range(1, 41):
        left, right, speed, acceleration = moves(draw)
        before = board.angles
        asked = wire.Move(number, left, right, speed, acceleration, board.now_ms)
        assert board.result(asked) is Result.OK
        for _ in range(400):
            board.tell(wire.Keep(board.now_ms))
            board.run(50 * MS)
            if ended := board.all_heard(wire.Moved):
                break
        board.heard.clear()
        (moved,) = ended
        assert (moved.id, moved.result) == (number, MoveResult.DONE)
        assert (moved.left, moved.right) == pytest.approx((left, right), abs=wire.SETTLED_TICKS)
        gone = [after - earlier for after, earlier in zip(board.angles, before, strict=True)]
        assert gone == pytest.approx((left, right), abs=wire.SETTLED_TICKS + 1)
        board.run_kept(200 * MS)
        assert board.all_heard(wire.Moved) == []
        assert [a - b for a, b in zip(board.angles, before, strict=True)] == pytest.approx(gone, abs=0.5)


def test_both_wheels_go_in_proportion_all_the_way():
    board = ready()
    board.result(wire.Move(1, 2000, 500, 1000, 2000, board.now_ms))
    worst = 0.0
    for _ in range(80):
        board.run_kept(50 * MS)
        left, right = board.angles
        worst = max(worst, abs(left / 4 - right))
    assert board.angles == pytest.approx((2000, 500), abs=3)
    assert worst < 40


def test_progress_goes_down_to_nothing():
    board = ready()
    board.result(wire.Move(9, 1500, -1500, 1000, 3000, board.now_ms))
    board.run_kept(4000 * MS)
    told = [t for t in board.all_heard(wire.Telemetry) if t.move_id == 9]
    assert told[0].state is State.MOVING
    assert told[0].move_left > 950
    assert told[-1].move_left < 20
    assert board.telemetry().move_id == 0


def test_move_ends_by_the_deadman():
    board = ready()
    board.result(wire.Move(3, 3000, 3000, 1000, 3000, board.now_ms))
    board.run(400 * MS)
    (moved,) = board.all_heard(wire.Moved)
    assert (moved.id, moved.result) == (3, MoveResult.TRIPPED)
    assert 0 < moved.left < 3000


@pytest.mark.parametrize("ends", [wire.Stop(), wire.Drive(0, 0, 0)])
def test_move_is_ended_by_stop_or_zero_and_busy_for_the_rest(ends):
    board = ready()
    board.result(wire.Move(3, 3000, 3000, 1000, 3000, board.now_ms))
    board.run_kept(500 * MS)
    assert board.result(wire.Move(4, 30, 30, 100, 100, board.now_ms)) is Result.BUSY
    assert board.drive(100, 100) is Result.BUSY
    if isinstance(ends, wire.Drive):
        ends = wire.Drive(0, 0, board.now_ms)
    assert board.result(ends) is Result.OK
    board.run(500 * MS)
    (moved,) = board.all_heard(wire.Moved)
    assert (moved.id, moved.result) == (3, MoveResult.STOPPED)
    assert board.pwm == (0, 0)


def test_move_ends_by_a_fault():
    board = ready()
    board.result(wire.Move(3, 3000, 3000, 1000, 3000, board.now_ms))
    board.run_kept(300 * MS)
    board.lib.set_stop(1)
    board.run_kept(100 * MS)
    assert board.all_heard(wire.Moved)[0].result is MoveResult.FAULTED


def test_move_over_the_wrap_of_the_ticks_ends_right():
    board = ready()
    board.lib.set_angle(0, 2**31 - 700)
    board.run_kept(200 * MS)
    board.result(wire.Move(1, 1500, 1500, 1500, 3000, board.now_ms))
    board.run_kept(3000 * MS)
    (moved,) = board.all_heard(wire.Moved)
    assert moved.result is MoveResult.DONE
    assert (moved.left, moved.right) == pytest.approx((1500, 1500), abs=2)


def test_gains_are_taken_at_rest_and_bound_what_is_accepted():
    board = ready()
    gains = wire.Gains(kp=20, ki=200, kd=0, feedforward=20, max_speed=400, max_acceleration=900)
    assert board.result(gains) is Result.OK
    assert board.drive(401, 0) is Result.OUT_OF_RANGE
    assert board.drive(400, 0) is Result.OK
    assert board.result(gains) is Result.BUSY


def test_servo_goes_at_its_speed_from_rest_and_holds_when_the_host_is_gone():
    board = ready()
    assert board.result(wire.ServoLimits(1, 800, 2200, 1400)) is Result.OK
    assert board.result(wire.Servos((0, 2000, 0, 0), (0, 500, 0, 0))) is Result.OK
    board.run(100 * MS)
    assert board.pulses == [0, pytest.approx(1450, abs=10), 0, 0]
    board.run(5000 * MS)
    assert board.pulses == [0, 2000, 0, 0]


def test_stop_holds_servos_where_they_are():
    board = ready()
    board.result(wire.Servos((2000, 0, 0, 0), (500, 0, 0, 0)))
    board.run(300 * MS)
    board.result(wire.Stop())
    held = board.pulses
    board.run(500 * MS)
    assert board.pulses == held
    assert 1600 < held[0] < 1700


def test_stop_input_refuses_servos():
    board = ready()
    board.lib.set_stop(1)
    board.run(50 * MS)
    assert board.result(wire.Servos((1600, 0, 0, 0), (0, 0, 0, 0))) is Result.FAULTED
    assert board.telemetry().faults == Fault.STOP_INPUT


def test_telemetry_comes_at_its_rate():
    board = ready()
    board.run_kept(1000 * MS)
    times = [t.at_us for t in board.all_heard(wire.Telemetry)]
    assert len(times) == wire.TELEMETRY_HZ
    assert {b - a for a, b in pairwise(times)} == {20_000}
