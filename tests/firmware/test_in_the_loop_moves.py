"""Relative moves that the firmware makes by itself, against where the wheels and the robot really got to."""

import math
import random

import pytest
from tests.firmware.sim.needs import needs_bed

from tapreach.bench.firmware_moves import move_error
from tapreach.drivers.arduino import wire
from tapreach.drivers.arduino.wire import MoveResult, Result, State

pytestmark = needs_bed


@pytest.mark.parametrize("board", ["uno", "mega"])
def test_turns_and_advances_end_where_they_should(host_of, board):
    host, chance = host_of(board), random.Random(f"moves {board}")
    for index in range(2):
        sign = chance.choice((-1, 1))
        turn = sign * math.radians(chance.uniform(10, 120)) if index % 2 else 0.0
        advance = 0.0 if index % 2 else sign * chance.uniform(0.05, 0.3)
        error = move_error(host, turn, advance, chance.randrange(400, 1400))
        assert error.result is MoveResult.DONE
        assert error.worst_ticks <= 2 * wire.SETTLED_TICKS
        assert abs(error.turn) < math.radians(0.5)
        assert abs(error.advance) < 0.002


def test_both_wheels_start_and_end_together(host_of):
    host = host_of("uno")
    host.drive(0, 0)
    assert host.ask(wire.Move(5, 1200, 400, 900, 1500, host.at_ms)) is Result.OK
    seen = []
    for _ in range(60):
        host.send(wire.Keep(host.at_ms))
        host.run(50_000)
        seen.append(host.rover.ticks)
    assert seen[-1] == pytest.approx((1200, 400), abs=2 * wire.SETTLED_TICKS)
    assert all(abs(left - 3 * right) < 150 for left, right in seen)


def test_progress_is_told_and_the_end_once(host_of):
    host = host_of("uno")
    host.drive(0, 0)
    assert host.ask(wire.Move(9, 800, 800, 800, 1500, host.at_ms)) is Result.OK
    told, ends = [], []
    for _ in range(60):
        host.send(wire.Keep(host.at_ms))
        heard = [received.message for received in host.run(50_000)]
        told += [m for m in heard if isinstance(m, wire.Telemetry) and m.move_id == 9]
        ends += [m for m in heard if isinstance(m, wire.Moved)]
    left = [each.move_left for each in told]
    assert left == sorted(left, reverse=True)
    assert left[0] > 950 and left[-1] < 50
    assert {each.state for each in told} == {State.MOVING}
    assert [(end.id, end.result) for end in ends] == [(9, MoveResult.DONE)]


def test_move_without_a_host_trips(host_of):
    host = host_of("uno")
    host.drive(0, 0)
    began_us = host.rover.now_us
    assert host.ask(wire.Move(3, 4000, 4000, 900, 1500, host.at_ms)) is Result.OK
    ended = host.await_message(wire.Moved, us=400_000)
    assert ended.result is MoveResult.TRIPPED
    assert host.rover.off_since_us() - began_us < 170_000


def test_drive_ends_a_move_and_a_stop_does_too(host_of):
    host = host_of("uno")
    host.drive(0, 0)
    assert host.ask(wire.Move(4, 4000, 4000, 900, 1500, host.at_ms)) is Result.OK
    host.run(100_000)
    host.send(wire.Stop())
    assert host.await_message(wire.Moved).result is MoveResult.STOPPED
    host.run(30_000)
    assert host.rover.now_us - host.rover.off_since_us() > 20_000
