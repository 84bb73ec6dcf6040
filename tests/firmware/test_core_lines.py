"""Hosts of ros_arduino_bridge are understood, under our limits, while no framed session is open."""

import pytest
from tests.firmware.host.board import HAS_COMPILER, MS, Board

from tapreach.drivers.arduino import wire

pytestmark = pytest.mark.skipif(not HAS_COMPILER, reason="needs g++ (Debian: apt-get install g++)")

OK, INVALID = b"OK\r\n", b"Invalid Command\r\n"


@pytest.mark.parametrize(
    ("line", "reply"),
    [
        (b"e", b"0 0\r\n"),
        (b"r", OK),
        (b"b", b"115200\r\n"),
        (b"m 0 0", OK),
        (b"o 0 0", OK),
        (b"u 20:12:0:50", OK),
        (b"s 0 90", OK),
        (b"t 0", b"93\r\n"),
        (b"a 3", b"103\r\n"),
        (b"d 5", b"1\r\n"),
        *((line, INVALID) for line in (b"", b"x 5 255", b"w 5 1", b"c 5 1", b"p 1", b"ee", b"e 1")),
        *((line, INVALID) for line in (b"m", b"m 1", b"m 1 2 3", b"m  1 2", b"m 1 2 ", b"m a b", b"m 1 -")),
        *((line, INVALID) for line in (b"m 999999 70000", b"m 134 0", b"m 65536 0", b"o 256 0", b"o 0 -256")),
        *((line, INVALID) for line in (b"u 1:2:3", b"u 20:12:0:0", b"s 4 90", b"s 0 181", b"s 0 0", b"t 9")),
        (b"m 00000000001 1", INVALID),
    ],
)
def test_each_line_has_its_reply(line, reply):
    board = Board()
    board.feed(b"m 0 0\r")
    assert board.feed(line + b"\r") == reply


def test_line_that_drives_stops_after_two_seconds_and_needs_a_zero():
    board = Board()
    assert board.feed(b"m 20 20\r") == INVALID
    assert board.feed(b"m 0 0\r") == OK
    assert board.feed(b"m 20 20\r") == OK
    board.run(1900 * MS)
    assert all(board.pwm)
    assert int(board.feed(b"e\r").split()[0]) == pytest.approx(board.angles[0], abs=20)
    board.run(150 * MS)
    assert board.pwm == (0, 0)
    assert board.feed(b"m 20 20\r") == INVALID


def test_speed_of_a_line_is_in_ticks_for_a_thirtieth_of_a_second():
    board = Board()
    board.feed(b"m 0 0\r")
    board.feed(b"m 20 -20\r")
    board.run(500 * MS)
    before = board.angles
    board.run(1000 * MS)
    assert board.angles[0] - before[0] == pytest.approx(600, rel=0.03)
    assert board.angles[1] - before[1] == pytest.approx(-600, rel=0.03)


def test_zero_line_stops_at_once():
    board = Board()
    board.feed(b"m 0 0\r")
    board.feed(b"m 50 50\r")
    board.run(500 * MS)
    assert board.feed(b"m 0 0\r") == OK
    assert board.pwm == (0, 0)


def test_raw_line_sets_the_pwm():
    board = Board()
    board.feed(b"o 0 0\r")
    assert board.feed(b"o 100 -60\r") == OK
    board.run(20 * MS)
    assert board.pwm == (100, -60)
    board.run(2000 * MS)
    assert board.pwm == (0, 0)


def test_reset_line_takes_the_count_to_zero_and_stops():
    board = Board()
    board.feed(b"m 0 0\r")
    board.feed(b"m 50 50\r")
    board.run(500 * MS)
    assert board.feed(b"r\r") == OK
    assert board.pwm == (0, 0)
    assert board.feed(b"e\r") == b"0 0\r\n"


@pytest.mark.parametrize("byte", [b"\n", b"\x80", b"\xff", b"\x01", b"\x7f"])
def test_byte_that_is_not_printable_drops_the_line(byte):
    board = Board()
    assert board.feed(b"m 0" + byte + b" 0\r") == b""
    assert board.feed(b"e\r") == b"0 0\r\n"


def test_endless_line_is_dropped():
    board = Board()
    assert board.feed(b"m 0 0" * 1000 + b"\r") == b""
    assert board.feed(b"e\r") == b"0 0\r\n"


def test_lines_are_not_heard_in_a_session_and_again_after_it():
    board = Board()
    board.make_ready()
    assert board.feed(b"m 20 20\r") == b""
    board.run(30 * MS)
    assert board.lib.pushes() == 0
    board.run(2100 * MS)
    assert b"0 0\r\n" in board.feed(b"\re\r")


def test_hello_takes_over_from_lines():
    board = Board()
    board.feed(b"m 0 0\r")
    board.feed(b"m 50 50\r")
    board.run(300 * MS)
    assert isinstance(board.tell(wire.Hello(wire.VERSION)), wire.Welcome)
    assert board.pwm == (0, 0)
