"""The processor sleeps between events: most of the time, without a byte or a period coming later for it."""

import random
from statistics import median

import pytest
from tests.firmware.sim.host import CHARACTER_US
from tests.firmware.sim.needs import needs_bed

from tapreach.drivers.arduino import wire

pytestmark = needs_bed
PING_US = CHARACTER_US * 26
"""The bits of a ping and its pong."""


@pytest.fixture(params=("uno", "mega"))
def host(request, host_of):
    return host_of(request.param)


def share_asleep(host, seconds=1.0):
    began_us = host.rover.avr.asleep_us
    host.run(seconds * 1e6)
    return (host.rover.avr.asleep_us - began_us) / (seconds * 1e6)


def test_a_board_that_stands_sleeps_most_of_the_time(host):
    assert 0.6 < share_asleep(host) < 1.0


def test_a_board_without_a_host_sleeps_most_of_the_time(host):
    host.run(2e6)
    assert share_asleep(host) > 0.6


def test_a_byte_wakes_it_at_once(host):
    chance, answered_us = random.Random(8), []
    for _ in range(40):
        host.run(chance.uniform(0.0, 20_000.0))
        answered_us.append(host.round_trip_us())
    # Telemetry may be in the way of some; Timer0 alone would wake it 0.5 ms later on average.
    assert median(answered_us) < PING_US + 700


def test_periods_come_as_even_as_without_sleep(host):
    host.drive(0, 0)
    host.heard.clear()
    host.drive_for(900, -700, 2e6)
    told_us = [each.message.at_us for each in host.heard if isinstance(each.message, wire.Telemetry)]
    assert len(told_us) >= 95
    late_us = [at - told_us[0] - 1_000_000 // wire.TELEMETRY_HZ * i for i, at in enumerate(told_us)]
    assert max(late_us) - min(late_us) < 150
