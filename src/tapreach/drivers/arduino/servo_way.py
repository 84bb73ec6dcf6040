"""One servo on its way to a pulse, slowly."""

from tapreach.drivers.arduino.fault_words import refusal_words
from tapreach.drivers.arduino.talk import Talk
from tapreach.drivers.arduino.wire import Result, Servos
from tapreach.robot.clock import MS, SECOND
from tapreach.robot.own_moves import MoveStatus
from tapreach.robot.teachable import ServoIndex

SPEED_US_PER_S = 150
"""About 15 degrees a second."""
ARRIVED_US, ARRIVAL_NS, AGAIN_NS = 3, 20 * SECOND, 300 * MS


class ServoWay:
    """See OwnMove. Nothing moves before the first `keep`; ended early the servo holds where it is."""

    fraction = 0.0

    def __init__(self, index: ServoIndex, pulse_us: int, talk: Talk) -> None:
        self._index, self._pulse_us, self._talk = index, pulse_us, talk
        self._began_ns = self._sent_ns = 0
        self.status = MoveStatus.MOVING
        self.reason = ""

    def keep(self) -> None:
        """See OwnMove."""
        now_ns = self._talk.clock.now_ns()
        if self.status is not MoveStatus.MOVING:
            return
        if not self._began_ns:
            self._began_ns = now_ns
            self._send(self._pulse_us)
        elif self._talk.answer is None and now_ns - self._sent_ns >= AGAIN_NS:
            self._send(self._pulse_us)
        elif self._talk.answer not in (None, Result.OK):
            self._fail(f"the board refuses it: {refusal_words(self._talk.answer)}")
        elif self._is_there:
            self.status = MoveStatus.ARRIVED
        elif now_ns - self._began_ns >= ARRIVAL_NS:
            name = "ABCD"[self._index]
            self._fail(f"the board did not bring servo {name} to {self._pulse_us} µs")

    def cancel(self, reason: str = "cancelled") -> bool:
        """See OwnMove."""
        if self.status is not MoveStatus.MOVING:
            return False
        told = self._talk.telemetry
        if told is not None and told.pulse_us[self._index]:
            self._send(told.pulse_us[self._index])
        self.status, self.reason = MoveStatus.CANCELLED, reason
        return True

    @property
    def _is_there(self) -> bool:
        told = self._talk.telemetry
        if told is None or self._talk.answer is not Result.OK:
            return False
        return abs(told.pulse_us[self._index] - self._pulse_us) <= ARRIVED_US

    def _send(self, pulse_us: int) -> None:
        self._sent_ns = self._talk.clock.now_ns()
        pulses, speeds = [0, 0, 0, 0], [0, 0, 0, 0]
        pulses[self._index], speeds[self._index] = pulse_us, SPEED_US_PER_S
        a, b, c, d = pulses
        e, f, g, h = speeds
        self._talk.say(Servos((a, b, c, d), (e, f, g, h)))

    def _fail(self, reason: str) -> None:
        self.status, self.reason = MoveStatus.FAILED, reason
