"""A wheel or two turned for a while at a speed that nobody need know in metres."""

from tapreach.drivers.arduino.fault_words import fault_sentence
from tapreach.drivers.arduino.session import Session
from tapreach.drivers.arduino.wire import Drive, Moved, Result, Stop, Telemetry
from tapreach.robot.clock import Clock
from tapreach.robot.own_moves import MoveStatus


class WheelSpin:
    """See OwnMove. left, right: [ticks/s]; nothing turns before the first `keep`. Its end is a Stop."""

    def __init__(self, left: int, right: int, duration_ns: int, session: Session, clock: Clock) -> None:
        self._speeds, self._duration_ns = (left, right), duration_ns
        self._session, self._clock = session, clock
        self._began_ns: int | None = None
        self.status = MoveStatus.MOVING
        self.reason = ""

    @property
    def fraction(self) -> float:
        """See OwnMove."""
        if self.status is MoveStatus.ARRIVED:
            return 1.0
        return min(1.0, self._gone_ns / self._duration_ns)

    def keep(self) -> None:
        """See OwnMove."""
        if self.status is not MoveStatus.MOVING:
            return
        if self._began_ns is None:
            self._began_ns = self._clock.now_ns()
        if self._gone_ns < self._duration_ns:
            self._session.send(Drive(*self._speeds, self._session.at_ms))
        else:
            self._end(MoveStatus.ARRIVED, "")

    def cancel(self, reason: str = "cancelled") -> bool:
        """See OwnMove."""
        if self.status is not MoveStatus.MOVING:
            return False
        self._end(MoveStatus.CANCELLED, reason)
        return True

    def fail(self, reason: str) -> None:
        """The board is out of reach, or another one since its restart."""
        if self.status is MoveStatus.MOVING:
            self.status, self.reason = MoveStatus.FAILED, reason

    def on_telemetry(self, telemetry: Telemetry) -> None:
        """See whether a fault has taken the wheels off."""
        if telemetry.faults:
            self.fail(fault_sentence(telemetry.faults))

    def on_answer(self, message: object, result: Result) -> None:
        """Drives are repeated until they count: no single answer matters."""

    def on_moved(self, moved: Moved) -> None:
        """It is no move of the board's own."""

    @property
    def _gone_ns(self) -> int:
        return 0 if self._began_ns is None else self._clock.now_ns() - self._began_ns

    def _end(self, status: MoveStatus, reason: str) -> None:
        # Off at once: a zero would be gone down to by a ramp.
        self._session.send(Stop())
        self.status, self.reason = status, reason
