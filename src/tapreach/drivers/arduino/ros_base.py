"""Wheels by the lines of ros_arduino_bridge; ramps and the 150 ms deadman are kept here."""

from collections.abc import Callable

from tapreach.drivers.arduino.ros_lines import RosLines, counts_of
from tapreach.drivers.arduino.wheels import Wheels
from tapreach.drivers.tick_odometry import TickOdometry
from tapreach.robot.clock import MS, SECOND, Clock
from tapreach.robot.config import BaseSection
from tapreach.robot.interface import Listeners, Unsubscribe
from tapreach.robot.messages import STILL, Odometry, Twist

DEADMAN_NS = 150 * MS
KEEP_NS = 100 * MS
"""The same speeds are sent again so often: that firmware's own stop comes only after 2 s."""
COUNT_EVERY_NS = 20 * MS
JUMP_S = 0.5
"""Counts further apart than this at full speed are a restart or a garbled answer, no drive."""


class RosBase:
    """See Base. Speeds are whole ticks per period of the board's control: the answer says what was sent.

    Times of the counts are the middles between question and answer, for that firmware has no clock to ask.
    """

    def __init__(
        self,
        section: BaseSection,
        pid_rate_hz: float,
        clock: Clock,
        lines: RosLines,
        require_link: Callable[[], None],
    ) -> None:
        self._wheels = Wheels(section)
        self._rate_hz, self._clock, self._lines = pid_rate_hz, clock, lines
        self._require_link = require_link
        self._odometry = TickOdometry(section)
        self._listeners = Listeners()
        self._counts: tuple[int, int] | None = None
        self._odd: tuple[int, int] | None = None
        self._told_ns = self._counted_ns = self._sent_ns = 0
        self._heard_ns = self._eased_ns = clock.now_ns()
        self._twist = STILL
        self._wanted = (0, 0)
        self._is_tripped = False
        self._counting = self._driving = False

    @property
    def is_counting(self) -> bool:
        """True once counts have come."""
        return self._counts is not None

    def drive(self, twist: Twist) -> Twist:
        """See Base. Speeding up keeps to the robot file's accelerations."""
        self._require_link()
        now_ns = self._clock.now_ns()
        self._watch(now_ns)
        self._heard_ns = now_ns
        self._is_tripped = self._is_tripped and not twist.is_zero
        allowed = STILL if self._is_tripped else self._wheels.limited(twist)
        elapsed = min(now_ns - self._eased_ns, KEEP_NS) / SECOND
        self._eased_ns = now_ns
        self._twist = self._wheels.eased(self._twist, allowed, elapsed)
        left, right = self._wheels.ticks_per_s(self._twist)
        self._send((round(left / self._rate_hz), round(right / self._rate_hz)))
        return self._wheels.twist(*(ticks * self._rate_hz for ticks in self._wanted))

    def subscribe(self, listener: Callable[[Odometry], None]) -> Unsubscribe:
        """See Base."""
        return self._listeners.subscribe(listener)

    def restart(self) -> None:
        """The line is new; the board may have restarted and count from 0 again."""
        self._counts = self._odd = None
        self._counting = self._driving = False
        self._odometry.rebase()

    def lose(self) -> None:
        """Nobody answers: what is wanted is to stand; where it drove, a zero has to come first."""
        self._is_tripped = self._is_tripped or any(self._wanted)
        self._twist, self._wanted = STILL, (0, 0)
        self._counting = self._driving = False

    def halt(self) -> None:
        """Stop as the deadman does."""
        self._twist, self._is_tripped = STILL, True
        self._send((0, 0))

    def tick(self) -> None:
        """Stop when the host is silent, keep the board's own deadman fed, and count."""
        now_ns = self._clock.now_ns()
        self._watch(now_ns)
        if any(self._wanted) and now_ns - self._sent_ns >= KEEP_NS:
            self._ask_to_drive()
        if not self._counting and now_ns - self._counted_ns >= COUNT_EVERY_NS:
            self._counting, self._counted_ns = True, now_ns
            self._lines.ask("e", self._hear_counts)

    def _watch(self, now_ns: int) -> None:
        if any(self._wanted) and now_ns - self._heard_ns >= DEADMAN_NS:
            self.halt()

    def _send(self, wanted: tuple[int, int]) -> None:
        changed, self._wanted = wanted != self._wanted, wanted
        if changed or self._clock.now_ns() - self._sent_ns >= KEEP_NS:
            self._ask_to_drive()

    def _ask_to_drive(self) -> None:
        # One at a time: what waits would be old when its turn comes. The newest is sent after the answer.
        if self._driving:
            return
        self._driving, self._sent_ns = True, self._clock.now_ns()
        sent = self._wanted
        self._lines.ask(f"m {sent[0]} {sent[1]}", lambda line: self._hear_ok(line, sent), is_urgent=True)

    def _hear_ok(self, line: str, sent: tuple[int, int]) -> None:
        self._driving = False
        if line != "OK":
            self._lines.doubt()
        if self._wanted != sent or line != "OK":
            self._ask_to_drive()

    def _hear_counts(self, line: str) -> None:
        self._counting = False
        counts = counts_of(line)
        if counts is None:
            self._lines.doubt()
        elif self._counts is not None and self._is_jump(counts):
            self._take_jump(counts)
        else:
            self._take(counts)

    def _take(self, counts: tuple[int, int]) -> None:
        self._counts, self._odd = counts, None
        middle_ns = (self._lines.asked_ns + self._clock.now_ns()) // 2
        self._told_ns = max(middle_ns, self._told_ns + 1)
        self._listeners.tell(self._odometry.update(self._told_ns, *counts))

    def _take_jump(self, counts: tuple[int, int]) -> None:
        # Said twice it is no garbled answer: the board restarted. Once alone it is dropped.
        if self._odd is not None and not self._is_apart(counts, self._odd):
            self._odometry.rebase()
            self._take(counts)
        else:
            self._odd = counts

    def _is_jump(self, counts: tuple[int, int]) -> bool:
        return self._counts is not None and self._is_apart(counts, self._counts)

    def _is_apart(self, one: tuple[int, int], other: tuple[int, int]) -> bool:
        most = self._wheels.fastest * JUMP_S
        return any(abs((a - b + 2**31) % 2**32 - 2**31) > most for a, b in zip(one, other, strict=True))
