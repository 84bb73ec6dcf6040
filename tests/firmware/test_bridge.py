"""Other programs reach the simulated board by a device path or a port, in real time or in lock step."""

import os
import select
import socket

import pytest
from tests.firmware.sim.bridge import TICK_US, Bridge, Pty, Tcp
from tests.firmware.sim.needs import needs_bed
from tests.firmware.sim.rover import Rover
from tests.firmware.sim.trivial import WIRING, trivial_elf

pytestmark = needs_bed
WAIT_S = 10.0


@pytest.fixture
def rover():
    made = Rover(trivial_elf(), WIRING)
    made.run(10_000)
    yield made
    made.close()


def heard(file, size):
    data = b""
    while len(data) < size and select.select([file], [], [], WAIT_S)[0]:
        data += os.read(file, 100)
    return data


def test_device_answers_in_real_time(rover):
    with Bridge(rover, Pty()) as bridge:
        file = os.open(bridge.url, os.O_RDWR | os.O_NOCTTY)
        os.write(file, b"hello")
        assert heard(file, 5) == b"hello"
        os.close(file)


def test_port_answers_in_real_time_and_takes_the_next_client(rover):
    line = Tcp()
    with Bridge(rover, line) as bridge:
        assert bridge.url == f"socket://127.0.0.1:{line.port}"
        for word in (b"this!", b"next!"):
            with socket.create_connection(("127.0.0.1", line.port), WAIT_S) as client:
                client.sendall(word)
                assert heard(client.fileno(), 5) == word


def test_nothing_happens_in_lock_step_without_a_turn(rover):
    bridge = Bridge(rover, Pty())
    file = os.open(bridge.url, os.O_RDWR | os.O_NOCTTY)
    os.write(file, b"hi")
    began_us = rover.now_us
    assert not select.select([file], [], [], 0.05)[0]
    for _ in range(5):
        bridge.turn()
    assert rover.now_us - began_us == pytest.approx(5 * TICK_US, abs=5)
    assert heard(file, 2) == b"hi"
    os.close(file)
    bridge.line.close()


def test_unplugged_line_loses_what_is_sent(rover):
    bridge = Bridge(rover, Pty())
    file = os.open(bridge.url, os.O_RDWR | os.O_NOCTTY)
    bridge.unplug()
    os.write(file, b"lost")
    bridge.turn(5_000)
    bridge.plug()
    os.write(file, b"soon")
    bridge.turn(5_000)
    assert heard(file, 4) == b"soon"
    os.close(file)
    bridge.line.close()


def test_wheels_turn_by_the_programs_pwm(rover):
    rover.avr.send(b"p" + bytes([127]))
    rover.run(1_000_000)
    assert rover.avr.duty(("D", 5)) == pytest.approx(0.5, abs=0.01)
    assert rover.plant.angles[0] > 5
