"""The wheels behind a framed session."""

from collections.abc import Callable

from tapreach.drivers.arduino.relative_move import RelativeMove, legs_of, next_id
from tapreach.drivers.arduino.session import Session
from tapreach.drivers.arduino.wheel_spin import WheelSpin
from tapreach.drivers.arduino.wheels import Wheels
from tapreach.drivers.arduino.wire import Drive, Move, Moved, Result, State, Telemetry
from tapreach.drivers.tick_odometry import TickOdometry
from tapreach.errors import DriverError
from tapreach.geometry.planar_motion import PlanarStep
from tapreach.robot.clock import MS, Clock
from tapreach.robot.config import BaseSection
from tapreach.robot.interface import Listeners, Unsubscribe
from tapreach.robot.messages import STILL, Odometry, Twist
from tapreach.robot.own_moves import MoveStatus

OBEYING = (State.READY, State.DRIVING, State.MOVING)
BoardMove = RelativeMove | WheelSpin
STANDING_NS = 100 * MS
"""So often a robot that was told to stand is told again: its wheels stay ready for the next command."""


class BoardBase:
    """See Base, and MovesByItself.

    The board ramps speeds and stops 150 ms after the last command by itself. Nothing but standing is
    repeated here, and that only until something else is asked for: after a stop the zero that makes wheels
    ready comes from whoever drives.
    """

    def __init__(
        self, section: BaseSection, session: Session, clock: Clock, require_link: Callable[[], None]
    ) -> None:
        self._wheels = Wheels(section)
        self._session, self._clock, self._require_link = session, clock, require_link
        self._odometry = TickOdometry(section)
        self._listeners = Listeners()
        self._told_ns = 0
        self._telemetry: Telemetry | None = None
        self._move: BoardMove | None = None
        self._move_id = 0
        self._stands = True
        self._sent_ns = clock.now_ns()
        self.wished_ns = clock.now_ns()

    def drive(self, twist: Twist) -> Twist:
        """See Base. While the board waits for a zero, what is sent moves nothing: STILL.

        Sent are whole ticks/s; the answer is what they were rounded from.
        """
        if not twist.is_zero:
            self.wished_ns = self._clock.now_ns()
        self._stands = self._stands and twist.is_zero
        self._require_link()
        ended = self._move is not None and self._move.cancel("another command stopped it")
        self._stands = twist.is_zero
        allowed = self._wheels.limited(twist)
        self._send(allowed)
        return allowed if twist.is_zero or (self._obeys and not ended) else STILL

    @property
    def own_move(self) -> BoardMove | None:
        """See MovesByItself."""
        is_moving = self._move is not None and self._move.status is MoveStatus.MOVING
        return self._move if is_moving else None

    def drive_by(self, step: PlanarStep, share: float = 1.0) -> RelativeMove:
        """See MovesByItself."""
        telemetry = self._require_ready()
        legs = legs_of(step, self._wheels, share)
        self._move = move = RelativeMove(legs, self._session, self._clock, next_id(self._move_id))
        self._move_id = (self._move_id + len(legs)) % 255
        move.on_telemetry(telemetry)
        move.keep()
        return move

    def spin(self, left: int, right: int, duration_ns: int) -> WheelSpin:
        """Begin to turn the wheels at ticks/s for a while. Raises as `drive_by`."""
        self._require_ready()
        self._move = spin = WheelSpin(left, right, duration_ns, self._session, self._clock)
        return spin

    def _require_ready(self) -> Telemetry:
        self._require_link()
        if self.own_move is not None:
            raise DriverError("another move is not finished: cancel it first")
        if self._telemetry is None or self._telemetry.state is not State.READY:
            state = self._telemetry.state.name.lower() if self._telemetry else "unknown"
            raise DriverError(f"the wheels are not ready ({state}): send a zero first")
        self._stands, self.wished_ns = False, self._clock.now_ns()
        return self._telemetry

    def tick(self) -> None:
        """Keep wheels ready that were told to stand."""
        if self._stands and self._clock.now_ns() - self._sent_ns >= STANDING_NS:
            self._send(STILL)

    @property
    def is_known(self) -> bool:
        """True once the board has told how its wheels are, and that they obey where a zero was sent."""
        return self._telemetry is not None and (self._obeys or not self._stands)

    def subscribe(self, listener: Callable[[Odometry], None]) -> Unsubscribe:
        """See Base."""
        return self._listeners.subscribe(listener)

    def take(self, telemetry: Telemetry, captured_ns: int) -> None:
        """Take what the board told."""
        self._telemetry = telemetry
        if self._move is not None:
            self._move.on_telemetry(telemetry)
        # A better alignment may set the board's time back a little; odometry's own time never goes back.
        self._told_ns = max(captured_ns, self._told_ns + 1)
        self._listeners.tell(self._odometry.update(self._told_ns, telemetry.left, telemetry.right))

    def on_answer(self, message: object, result: Result) -> None:
        """Take the answer to a command."""
        if self._move is not None and isinstance(message, Move):
            self._move.on_answer(message, result)

    def on_moved(self, moved: Moved) -> None:
        """Take the end of a move."""
        if self._move is not None:
            self._move.on_moved(moved)

    def lose(self, reason: str) -> None:
        """The board is out of reach."""
        self._telemetry = None
        if self._move is not None:
            self._move.fail(reason)

    def rebase(self) -> None:
        """The board counts from 0 again; the pose goes on from where it was."""
        self._odometry.rebase()

    def _send(self, twist: Twist) -> None:
        self._sent_ns = self._clock.now_ns()
        self._session.send(Drive(*self._wheels.ticks_per_s(twist), self._session.at_ms))

    @property
    def _obeys(self) -> bool:
        return self._telemetry is not None and self._telemetry.state in OBEYING
