"""Motors and encoders that are wired the other way round, turned round by the board: forward is forward."""

import pytest
from tests.firmware.host.board import HAS_COMPILER, MS, Board

from tapreach.drivers.arduino import wire
from tapreach.drivers.arduino.wire import MoveResult, Result, Reversed

pytestmark = pytest.mark.skipif(not HAS_COMPILER, reason="needs g++ (Debian: apt-get install g++)")
ALL = [Reversed(bits) for bits in range(16)]


def wired(reversed_: Reversed, told: Reversed) -> Board:
    board = Board()
    board.lib.wire_up(reversed_)
    board.lib.set_angle(0, 70.0)
    board.run(100 * MS)
    assert isinstance(board.tell(wire.Hello(wire.VERSION)), wire.Welcome)
    assert board.result(wire.Wiring(told)) is Result.OK
    assert board.drive(0, 0) is Result.OK
    return board


def run_move(board: Board, left: int, right: int) -> wire.Moved:
    assert board.result(wire.Move(1, left, right, 800, 3000, board.now_ms)) is Result.OK
    for _ in range(100):
        board.tell(wire.Keep(board.now_ms))
        board.run(50 * MS)
        if ended := board.all_heard(wire.Moved):
            return ended[0]
    raise AssertionError("the move did not end")


@pytest.mark.parametrize("wiring", ALL, ids=str)
def test_drive_move_and_telemetry_agree_however_it_is_wired(wiring):
    board = wired(wiring, wiring)
    before, told_before = board.angles, board.telemetry()
    for _ in range(20):
        board.drive(400, -250)
        board.run(50 * MS)
    told, gone = board.telemetry(), [a - b for a, b in zip(board.angles, before, strict=True)]
    assert gone[0] > 250 and gone[1] < -150
    assert [told.left - told_before.left, told.right - told_before.right] == pytest.approx(gone, abs=40)
    assert (told.left_speed, told.right_speed) == pytest.approx((400, -250), rel=0.15)
    board.drive(0, 0)
    board.run_kept(800 * MS)
    before = board.angles
    moved = run_move(board, 500, -300)
    assert moved.result is MoveResult.DONE
    assert [a - b for a, b in zip(board.angles, before, strict=True)] == pytest.approx((500, -300), abs=3)


def test_wheel_with_one_of_both_reversed_runs_away_unless_the_board_is_told():
    board = wired(Reversed.LEFT_MOTOR, Reversed(0))
    for _ in range(10):
        board.drive(300, 300)
        board.run(50 * MS)
    assert board.angles[0] < -300


def test_ticks_go_on_from_where_they_were_and_a_turning_wheel_is_not_turned_round():
    board = wired(Reversed(0), Reversed(0))
    for _ in range(10):
        board.drive(400, 400)
        board.run(50 * MS)
    assert board.result(wire.Wiring(Reversed.LEFT_ENCODER)) is Result.BUSY
    board.drive(0, 0)
    board.run_kept(800 * MS)
    before = board.telemetry()
    assert board.result(wire.Wiring(Reversed.LEFT_ENCODER | Reversed.RIGHT_MOTOR)) is Result.OK
    after = board.telemetry()
    assert (after.left, after.right) == (before.left, before.right)
    assert (after.left_speed, after.right_speed) == (0, 0)


def test_wiring_beyond_what_there_is_is_refused():
    board = wired(Reversed(0), Reversed(0))
    assert board.result(wire.Wiring(Reversed(0b10000))) is Result.OUT_OF_RANGE
