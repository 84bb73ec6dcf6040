"""A step as the board's own moves: the turn, then the advance."""

from dataclasses import dataclass

from tapreach.drivers.arduino.fault_words import refusal_words
from tapreach.drivers.arduino.session import Session
from tapreach.drivers.arduino.wheels import Wheels
from tapreach.drivers.arduino.wire import Keep, Move, Moved, MoveResult, Result, Stop, Telemetry
from tapreach.geometry.planar_motion import PlanarStep
from tapreach.robot.clock import MS, Clock
from tapreach.robot.own_moves import MoveStatus

TAKEN_WITHIN_NS = 400 * MS
ASKED_FOR_NS = 1000 * MS
"""So long a leg that comes too late is asked for again: what the board refused has moved nothing."""
NEAR_TICKS = 4
"""From its goal, within which a leg whose report was lost has arrived by its ticks."""
ENDINGS = {
    MoveResult.STOPPED: "another command stopped it",
    MoveResult.TRIPPED: "the board's deadman stopped it: the host was silent for 150 ms",
    MoveResult.FAULTED: "a fault stopped it",
    MoveResult.STALLED: "the wheels do not turn as they should: is the robot stuck?",
}


@dataclass(frozen=True, slots=True)
class Leg:
    """One move of the board: ways of the wheels [ticks], speed [ticks/s], acceleration [ticks/s²]."""

    left: int
    right: int
    speed: int
    acceleration: int

    @property
    def length(self) -> int:
        """Way of the faster wheel [ticks]."""
        return max(abs(self.left), abs(self.right))


def legs_of(step: PlanarStep, wheels: Wheels, share: float = 1.0) -> tuple[Leg, ...]:
    """Return the turn and the advance of a step, at a share of gentle speeds.

    What is shorter than half a tick is left out.
    """
    turn = Leg(*wheels.turn_ticks(step), *wheels.turn_rates(share))
    advance = Leg(*wheels.advance_ticks(step), *wheels.advance_rates(share))
    return tuple(leg for leg in (turn, advance) if leg.length)


class RelativeMove:
    """See OwnMove. first_id: of the first leg, from 1 to 255; the others follow."""

    def __init__(self, legs: tuple[Leg, ...], session: Session, clock: Clock, first_id: int) -> None:
        self._legs, self._session, self._clock = legs, session, clock
        self._id = first_id
        self._at = 0
        self._is_sent = self._is_taken = False
        self._sent_ns = self._asked_ns = 0
        self._left_permille = 1000
        self._ticks: tuple[int, int] | None = None
        self._begun_at: tuple[int, int] | None = None
        self.status = MoveStatus.MOVING if legs else MoveStatus.ARRIVED
        self.reason = ""

    @property
    def fraction(self) -> float:
        """See OwnMove."""
        whole = sum(leg.length for leg in self._legs)
        done = sum(leg.length for leg in self._legs[: self._at])
        if self.status is MoveStatus.ARRIVED or not whole:
            return 1.0
        return (done + self._legs[self._at].length * (1.0 - self._left_permille / 1000.0)) / whole

    def keep(self) -> None:
        """See OwnMove."""
        if self.status is not MoveStatus.MOVING:
            return
        if not self._is_sent:
            self._asked_ns = self._asked_ns or self._clock.now_ns()
            self._send_leg()
        elif not self._is_taken and self._clock.now_ns() - self._sent_ns > TAKEN_WITHIN_NS:
            self._end(MoveStatus.FAILED, "the board did not take the move")
            self._session.send(Stop())
        else:
            self._session.send(Keep(self._session.at_ms))

    def cancel(self, reason: str = "cancelled") -> bool:
        """See OwnMove."""
        if self.status is not MoveStatus.MOVING:
            return False
        self._session.send(Stop())
        self._end(MoveStatus.CANCELLED, reason)
        return True

    def fail(self, reason: str) -> None:
        """The board is out of reach, or another one since its restart."""
        self._end(MoveStatus.FAILED, reason)

    def on_answer(self, move: Move, result: Result) -> None:
        """The board has answered a leg."""
        if move.id != self._id or self.status is not MoveStatus.MOVING:
            return
        self._is_taken = result is Result.OK
        if result is Result.TOO_OLD and self._clock.now_ns() - self._asked_ns < ASKED_FOR_NS:
            self._is_sent = False
        elif not self._is_taken:
            self._end(MoveStatus.FAILED, f"the board refuses the move: {refusal_words(result)}")

    def on_moved(self, moved: Moved) -> None:
        """A leg has ended."""
        if moved.id != self._id or self.status is not MoveStatus.MOVING:
            return
        if moved.result is MoveResult.DONE:
            self._next()
        else:
            self._end(MoveStatus.FAILED, ENDINGS[moved.result])

    def on_telemetry(self, telemetry: Telemetry) -> None:
        """See how far it is; a leg whose report was lost is judged by its ticks."""
        self._ticks = telemetry.left, telemetry.right
        if not self._is_sent or self.status is not MoveStatus.MOVING:
            return
        if telemetry.move_id == self._id:
            self._is_taken, self._left_permille = True, telemetry.move_left
        elif self._is_taken and self._clock.now_ns() - self._sent_ns > TAKEN_WITHIN_NS:
            if self._is_near(telemetry):
                self._next()
            else:
                self._end(MoveStatus.FAILED, "it ended early, and the board's report of why was lost")

    def _send_leg(self) -> None:
        leg = self._legs[self._at]
        rates = leg.speed, leg.acceleration
        self._begun_at = self._ticks
        self._is_sent, self._is_taken, self._sent_ns = True, False, self._clock.now_ns()
        self._session.send(Move(self._id, leg.left, leg.right, *rates, self._session.at_ms))

    def _next(self) -> None:
        if self._at + 1 == len(self._legs):
            self._end(MoveStatus.ARRIVED, "")
            return
        self._at += 1
        self._id = next_id(self._id)
        self._is_sent, self._asked_ns, self._left_permille = False, 0, 1000

    def _is_near(self, telemetry: Telemetry) -> bool:
        if self._begun_at is None:
            return False
        leg, (left, right) = self._legs[self._at], self._begun_at
        misses = telemetry.left - left - leg.left, telemetry.right - right - leg.right
        return all(abs((miss + 2**31) % 2**32 - 2**31) <= NEAR_TICKS for miss in misses)

    def _end(self, status: MoveStatus, reason: str) -> None:
        if self.status is MoveStatus.MOVING:
            self.status, self.reason = status, reason


def next_id(move_id: int) -> int:
    """Return the id after this one: 1 to 255, for 0 means none."""
    return move_id % 255 + 1
