"""The host vanishes, or the line makes noise: the power goes in time, and nothing moves by itself."""

import random

import pytest
from tests.firmware.sim.needs import needs_bed

from tapreach.bench.firmware_noise import CHARACTER_US, burst, good_frame, send_burst
from tapreach.bench.firmware_vanish import LIMIT_MS, WAYS, stop_ms
from tapreach.drivers.arduino import wire
from tapreach.drivers.arduino.wire import Result, State

pytestmark = needs_bed


@pytest.mark.parametrize("board", ["uno", "mega"])
@pytest.mark.parametrize("way", WAYS)
def test_power_goes_in_time_when_the_host_vanishes(host_of, board, way):
    host, chance = host_of(board), random.Random(f"{board} {way}")
    for _ in range(2 if board == "uno" else 1):
        stopped_ms = stop_ms(host, WAYS[way], chance)
        # Sooner would mean that a good command was not obeyed to its end.
        assert wire.DEADMAN_MS - 20 < stopped_ms <= LIMIT_MS
        host.open()


def test_wheels_that_tripped_need_a_zero(host_of):
    host = host_of("uno")
    host.drive(0, 0)
    host.drive_for(700, 700, 200_000)
    host.run(250_000)
    assert host.telemetry().state is State.TRIPPED
    assert host.drive(700, 700) is Result.NEEDS_ZERO
    assert host.drive(0, 0) is Result.OK
    assert host.drive(700, 700) is Result.OK


@pytest.mark.parametrize("board", ["uno", "mega"])
def test_noise_moves_nothing_and_the_next_frame_is_understood(host_of, board):
    host, chance = host_of(board), random.Random(f"noise {board}")
    before = host.open()
    for _ in range(5):
        assert send_burst(host, burst(chance, host.at_ms))
    assert host.rover.powered_us() == 0
    assert host.telemetry().pulse_us == (0, 0, 0, 0)
    assert host.open().boot_id == before.boot_id


def test_noise_between_commands_does_not_disturb_the_drive(host_of):
    host, chance = host_of("uno"), random.Random("between")
    host.drive(0, 0)
    host.drive_for(700, 700, 500_000)
    began, began_us = host.rover.ticks, host.rover.now_us
    for _ in range(30):
        host.rover.avr.send(burst(chance, host.at_ms, 100) + b"\0")
        host.run(130 * CHARACTER_US)
        assert host.drive(700, 700) is Result.OK
    seconds = (host.rover.now_us - began_us) / 1e6
    speeds = [(b - a) / seconds for a, b in zip(began, host.rover.ticks, strict=True)]
    assert speeds == pytest.approx([700, 700], rel=0.05)


def test_frames_in_which_any_one_bit_is_wrong_are_not_obeyed(host_of):
    """Each single bit of frames that would move something: CRC and COBS find them all."""
    host = host_of("uno")
    frame = good_frame(random.Random(4), host.at_ms)
    for bit in range(8, 8 * (len(frame) - 1)):
        wrong = bytearray(frame)
        wrong[bit // 8] ^= 1 << bit % 8
        host.rover.avr.send(bytes(wrong))
        heard = host.run(len(frame) * CHARACTER_US + 3_000)
        assert not any(isinstance(each.message, wire.Ack) for each in heard), bit
    assert host.rover.powered_us() == 0
