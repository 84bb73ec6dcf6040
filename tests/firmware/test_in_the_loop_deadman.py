"""The host vanishes: the power goes in time."""

import random

from tests.firmware.sim.needs import needs_bed

from tapreach.bench.firmware_vanish import LIMIT_MS, silence, stop_ms
from tapreach.drivers.arduino import wire


@needs_bed
def test_power_goes_in_time_when_the_host_falls_silent(host_of):
    host, chance = host_of("uno"), random.Random("uno silence")
    for _ in range(2):
        stopped_ms = stop_ms(host, silence, chance)
        # Sooner would mean that a good command was not obeyed to its end.
        assert wire.DEADMAN_MS - 20 < stopped_ms <= LIMIT_MS
        host.open()
