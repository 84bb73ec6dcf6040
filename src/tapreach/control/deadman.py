"""The operator's hand on the stick: a wish stands only while messages keep coming."""

from dataclasses import dataclass

from tapreach.robot.clock import MS, Clock
from tapreach.robot.messages import Twist

TIMEOUT_NS = 200 * MS
"""After this much silence the wish is dropped and the operator counts as gone."""


@dataclass(frozen=True, slots=True)
class Wish:
    """A speed that the operator holds, and the capture time of the picture it was judged by."""

    twist: Twist
    picture_captured_ns: int | None
    """None: there was no picture on the screen."""


class Deadman:
    """Two timers on the messages of whoever holds the lease, both restarted by reception, never by age.

    Presence: any message. Wish: drive messages only; a heartbeat does not prolong it, and after silence or a
    stop nothing but a fresh drive message brings a wish back. The last command never stands.
    """

    def __init__(self, clock: Clock, timeout_ns: int = TIMEOUT_NS) -> None:
        self._clock = clock
        self._timeout_ns = timeout_ns
        self._heard_ns: int | None = None
        self._wish: Wish | None = None
        self._wish_ns = 0

    def heard(self) -> None:
        """The operator showed to be there."""
        self._heard_ns = self._clock.now_ns()

    def hold(self, wish: Wish) -> None:
        """Take a wish from a drive message that has just arrived."""
        self.heard()
        self._wish, self._wish_ns = wish, self._clock.now_ns()

    def release(self) -> None:
        """Drop the wish now; the operator is still there."""
        self._wish = None

    def gone(self) -> None:
        """Drop the wish now; the operator has left, or another one takes over."""
        self._wish = None
        self._heard_ns = None

    @property
    def is_alive(self) -> bool:
        """True while the operator was heard within the timeout."""
        return self._heard_ns is not None and self._is_recent(self._heard_ns)

    @property
    def wish(self) -> Wish | None:
        """What the operator holds right now; None when nothing."""
        if self._wish is not None and not self._is_recent(self._wish_ns):
            self._wish = None
        return self._wish

    def _is_recent(self, when_ns: int) -> bool:
        return self._clock.now_ns() - when_ns < self._timeout_ns
