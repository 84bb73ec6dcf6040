"""What must never happen: wheels that turn though nobody means it any more."""

import random

import pytest
from tests.firmware.host.board import HAS_COMPILER, MS, Board

from tapreach.drivers.arduino import wire
from tapreach.drivers.arduino.frame_reader import encode
from tapreach.drivers.arduino.framing import frame
from tapreach.drivers.arduino.wire import Fault, Result, State

pytestmark = pytest.mark.skipif(not HAS_COMPILER, reason="needs g++ (Debian: apt-get install g++)")

PERIOD_US = 1_000_000 // wire.CONTROL_HZ
DEADMAN_US = wire.DEADMAN_MS * MS
WRAP_US = 2**32


@pytest.mark.parametrize("start_us", [0, WRAP_US - 400 * MS, 1000 * WRAP_US - 400 * MS, 7 * WRAP_US + 1])
def test_wheels_are_off_150_ms_after_the_last_command_at_any_moment(start_us):
    draw = random.Random(1)
    for _ in range(50):
        board = Board(start_us)
        board.make_ready()
        end_us = board.now_us + draw.randrange(400) * MS + draw.randrange(10) * 100
        while board.now_us < end_us:
            last_us = board.now_us
            assert board.drive(800, -500) is Result.OK
            board.run(min(draw.randrange(5, 130) * MS, max(100, end_us - board.now_us)))
        assert any(board.pwm) or board.now_us - last_us < 30 * MS
        board.run(300 * MS)
        assert board.pwm == (0, 0)
        assert board.lib.off_since() - last_us <= DEADMAN_US + PERIOD_US
        assert board.telemetry().state is State.TRIPPED


def test_trip_counts_from_sending_and_not_from_arrival():
    board = Board()
    board.make_ready()
    board.run(500 * MS)
    assert board.drive(900, 900, age_ms=100) is Result.OK
    board.run(30 * MS)
    assert any(board.pwm)
    board.run(40 * MS)
    assert board.pwm == (0, 0)


def test_command_from_ahead_gives_no_longer_time():
    board = Board()
    board.make_ready()
    sent_us = board.now_us
    assert board.drive(900, 900, age_ms=-50) is Result.OK
    board.run(400 * MS)
    assert 0 < board.lib.off_since() - sent_us <= DEADMAN_US + PERIOD_US


def test_after_a_trip_a_zero_is_needed():
    board = Board()
    board.make_ready()
    board.drive(500, 500)
    board.run(300 * MS)
    assert board.drive(500, 500) is Result.NEEDS_ZERO
    assert board.result(wire.Move(1, 100, 100, 100, 100, board.now_ms)) is Result.NEEDS_ZERO
    assert board.result(wire.Keep(board.now_ms)) is Result.NEEDS_ZERO
    board.run(100 * MS)
    assert board.pwm == (0, 0)
    assert board.drive(0, 0) is Result.OK
    assert board.drive(500, 500) is Result.OK


def test_keep_brings_a_tripped_drive_not_back():
    board = Board()
    board.make_ready()
    board.drive(500, 500)
    board.run(200 * MS)
    board.run_kept(200 * MS)
    assert board.pwm == (0, 0)


def test_nothing_moves_without_hello():
    board = Board()
    assert board.drive(0, 0) is Result.NO_SESSION
    assert board.drive(500, 500) is Result.NO_SESSION
    board.run(50 * MS)
    assert board.lib.pushes() == 0


def test_host_of_another_version_is_welcomed_but_gets_no_session():
    board = Board()
    assert board.tell(wire.Hello(wire.VERSION + 1)).version == wire.VERSION
    assert board.drive(0, 0) is Result.NO_SESSION


def test_stop_is_obeyed_at_once_and_needs_a_zero():
    board = Board()
    board.make_ready()
    board.drive(2000, 2000)
    board.run(100 * MS)
    assert board.result(wire.Stop()) is Result.OK
    assert board.pwm == (0, 0)
    assert board.drive(100, 100) is Result.NEEDS_ZERO


@pytest.mark.parametrize("age_ms", [151, 1000, 40_000, -51, -1000])
@pytest.mark.parametrize("start_us", [60_000 * MS, WRAP_US + 70 * MS])
def test_command_of_another_time_is_refused(age_ms, start_us):
    board = Board(start_us)
    board.make_ready()
    at_ms = (board.now_ms - age_ms) % 2**32
    assert board.drive(500, 500, age_ms) is Result.TOO_OLD
    assert board.result(wire.Keep(at_ms)) is Result.TOO_OLD
    assert board.result(wire.Move(1, 100, 100, 100, 100, at_ms)) is Result.TOO_OLD
    board.run(50 * MS)
    assert board.lib.pushes() == 0


@pytest.mark.parametrize("age_ms", [0, 149, -49])
def test_timely_command_is_taken_even_across_the_wrap(age_ms):
    board = Board(WRAP_US - 20 * MS)
    board.make_ready()
    assert board.drive(500, 500, age_ms) is Result.OK


def test_host_that_never_saw_the_wraps_is_understood():
    board = Board(5 * WRAP_US + 123_456)
    board.make_ready()
    assert board.result(wire.Drive(500, 500, board.now_us % WRAP_US // 1000)) is Result.OK


@pytest.mark.parametrize(
    "message",
    [
        wire.Drive(4001, 0, 0),
        wire.Drive(0, -32768, 0),
        wire.Move(0, 100, 100, 100, 100, 0),
        wire.Move(1, 1_000_001, 100, 100, 100, 0),
        wire.Move(1, -(2**31), 100, 100, 100, 0),
        wire.Move(1, 100, 100, 0, 100, 0),
        wire.Move(1, 100, 100, 4001, 100, 0),
        wire.Move(1, 100, 100, 100, 0, 0),
        wire.Move(1, 100, 100, 100, 8001, 0),
        wire.Servos((999, 0, 0, 0), (0, 0, 0, 0)),
        wire.Servos((1500, 1500, 1500, 2001), (0, 0, 0, 0)),
        wire.ServoLimits(4, 1000, 2000, 1500),
        wire.ServoLimits(0, 499, 2000, 1500),
        wire.ServoLimits(0, 1000, 2501, 1500),
        wire.ServoLimits(0, 1000, 2000, 2001),
        wire.Gains(1, 1, 1, 1, 0, 100),
        wire.Gains(1, 1, 1, 1, 40_000, 100),
        wire.Gains(1, 1, 1, 1, 100, 0),
    ],
)
def test_what_is_out_of_range_is_refused_and_moves_nothing(message):
    board = Board()
    board.make_ready()
    assert board.result(message) is Result.OUT_OF_RANGE
    board.run(100 * MS)
    assert board.lib.pushes() == 0
    assert board.pulses == [0, 0, 0, 0]


def mutated(draw: random.Random, board: Board) -> bytes:
    """A frame that would drive, with one to three bytes changed, lost or doubled."""
    changed = bytearray(encode(wire.Drive(900, 900, board.now_ms), 9))
    for _ in range(draw.randrange(1, 4)):
        at = draw.randrange(len(changed))
        changed[at : at + 1] = draw.choice(([], [draw.randrange(256)], [changed[at]] * 2))
    whole = encode(wire.Drive(900, 900, board.now_ms), 9).strip(b"\0")
    return b"" if whole in bytes(changed) else bytes(changed)


@pytest.mark.parametrize("in_session", [True, False])
def test_garbage_moves_nothing_and_the_next_frame_is_heard(in_session):
    draw = random.Random(2)
    board = Board()
    if in_session:
        board.make_ready()
    for _ in range(3000):
        noise = draw.randbytes(draw.randrange(40))
        board.feed(noise if draw.random() < 0.3 else mutated(draw, board))
        board.run(200)
        if in_session and draw.random() < 0.05:
            assert board.tell(wire.Ping(5)) == wire.Pong(5, board.now_us % WRAP_US)
    assert board.lib.pushes() == 0
    assert board.lib.bad_frames() > 100


def test_frame_of_unknown_type_or_length_is_named_and_counted():
    board = Board()
    board.make_ready()
    board.heard.clear()
    board.feed(frame(b"\x7f\x01") + frame(b"\x05\x02\x00") + frame(b"\x02\x03\x01"))
    assert [ack.result for ack in board.heard] == [Result.UNKNOWN, Result.BAD_LENGTH, Result.BAD_LENGTH]
    assert board.lib.bad_frames() == 3


def test_session_ends_in_silence_and_wheels_need_a_zero_again():
    board = Board()
    board.make_ready()
    board.run(2100 * MS)
    before = len(board.all_heard(wire.Telemetry))
    board.run(100 * MS)
    assert len(board.all_heard(wire.Telemetry)) == before
    assert board.drive(0, 0) is Result.NO_SESSION


def test_second_hello_takes_the_wheels_off():
    board = Board()
    board.make_ready()
    board.drive(2000, 2000)
    board.run(100 * MS)
    board.tell(wire.Hello(wire.VERSION))
    assert board.pwm == (0, 0)
    assert board.drive(100, 100) is Result.NEEDS_ZERO


def driving(board: Board, ms: int) -> None:
    for _ in range(0, ms, 50):
        board.drive(2500, 2500)
        board.run(50 * MS)


def test_stop_input_latches_until_it_is_released_and_cleared():
    board = Board()
    board.make_ready()
    driving(board, 200)
    board.lib.set_stop(1)
    board.run(30 * MS)
    assert board.pwm == (0, 0)
    assert board.drive(0, 0) is Result.FAULTED
    assert board.result(wire.Clear(Fault.STOP_INPUT)) is Result.FAULTED
    board.lib.set_stop(0)
    board.run(50 * MS)
    told = board.telemetry()
    assert (told.faults, told.state) == (Fault.STOP_INPUT, State.FAULTED)
    assert board.result(wire.Clear(Fault.STOP_INPUT)) is Result.OK
    assert board.drive(100, 100) is Result.NEEDS_ZERO
    assert board.drive(0, 0) is Result.OK


def test_held_wheels_are_a_fault():
    board = Board()
    board.make_ready()
    board.lib.hold_wheels(1)
    driving(board, 1500)
    told = board.telemetry()
    assert (told.faults, told.state) == (Fault.ENCODER_STUCK, State.FAULTED)


def test_steps_that_cannot_be_are_a_fault_and_single_ones_are_not():
    board = Board()
    board.make_ready()
    for illegal, fault in ((10, Fault(0)), (30, Fault.ENCODER_ILLEGAL)):
        board.lib.add_illegal(illegal)
        board.run_kept(1100 * MS)
        assert board.telemetry().faults == fault


def test_low_battery_is_a_fault_but_a_dip_is_not():
    board = Board()
    board.make_ready()
    for mv, ms, fault in ((5000, 500, Fault(0)), (7400, 500, Fault(0)), (5500, 2500, Fault.BATTERY_LOW)):
        board.lib.set_battery(mv)
        board.run_kept(ms * MS)
        assert board.telemetry().faults == fault
    assert board.result(wire.Clear(Fault.BATTERY_LOW)) is Result.FAULTED


def test_loop_that_stood_still_is_a_fault():
    board = Board()
    board.make_ready()
    board.drive(500, 500)
    board.run(50 * MS)
    board.lib.skip(50 * MS)
    board.run(MS)
    assert board.pwm == (0, 0)
    assert board.telemetry().faults == Fault.LOOP_OVERRUN


@pytest.mark.parametrize(
    ("cause", "fault"),
    [
        (wire.ResetCause.WATCHDOG, Fault.WATCHDOG_RESET),
        (wire.ResetCause.BROWN_OUT, Fault.BROWN_OUT_RESET),
        (wire.ResetCause.BROWN_OUT | wire.ResetCause.POWER_ON, Fault(0)),
        (wire.ResetCause.EXTERNAL, Fault(0)),
    ],
)
def test_reset_by_a_defect_is_a_fault(cause, fault):
    board = Board(reset_cause=cause)
    assert board.tell(wire.Hello(wire.VERSION)).reset_cause == cause
    assert board.telemetry().faults == fault
    assert board.drive(0, 0) is (Result.FAULTED if fault else Result.OK)
