"""A peer whose encoders count as they are wired."""

from dataclasses import replace

from tests.drivers.arduino.peer import PeerBoard

from tapreach.drivers.arduino.wire import ServoLimits


class WiredBoard(PeerBoard):
    """Counts as its encoders are wired: `counts` makes told ticks of true ones."""

    def __init__(self, clock, first_tick=0):
        super().__init__(clock, first_tick=first_tick)
        self.counts = lambda left, right: (left, right)
        self.limits = {index: ServoLimits(index, 500, 2500, 1500) for index in range(4)}

    def telemetry(self):
        told = super().telemetry()
        left, right = self.counts(told.left, told.right)
        return replace(told, left=left, right=right)
