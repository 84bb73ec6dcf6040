"""Who may drive: one session at a time. Others watch, and may ask."""

from collections.abc import Callable
from dataclasses import dataclass

from tapreach.robot.clock import SECOND, Clock

IDLE_NS = 10 * SECOND
"""A holder who gave no command for this long can be relieved without being asked."""
ANSWER_NS = 5 * SECOND
"""An ask is granted when the holder neither answers nor gives a command for this long."""


@dataclass(frozen=True, slots=True)
class LeaseStatus:
    """Who holds the lease, whether it is idle, and who asks for it."""

    holder_id: int | None
    is_idle: bool
    asked_by_id: int | None


@dataclass(frozen=True, slots=True)
class LeaseReply:
    """What became of a request, with a sentence where the answer is no or not yet."""

    is_granted: bool
    reason: str = ""


class Lease:
    """Granted at once when free or idle; else the holder is asked, and silence is consent.

    `on_change` is called after every change of holder or asker; a change of holder must bring the wheels
    to rest. Without a `tick` now and then an unanswered ask stands.
    """

    def __init__(self, clock: Clock, on_change: Callable[[], None] = lambda: None) -> None:
        self._clock = clock
        self._on_change = on_change
        self._holder_id: int | None = None
        self._asked_by_id: int | None = None
        self._asked_ns = 0
        self._last_command_ns = 0

    @property
    def status(self) -> LeaseStatus:
        """Present state."""
        return LeaseStatus(self._holder_id, self._is_idle, self._asked_by_id)

    def is_held_by(self, session_id: int) -> bool:
        """Tell whether this session may drive."""
        return self._holder_id == session_id

    def command_given(self, session_id: int) -> None:
        """Note that the holder acted: the lease is not idle. Heartbeats do not count."""
        if self._holder_id == session_id:
            self._last_command_ns = self._clock.now_ns()

    def request(self, session_id: int) -> LeaseReply:
        """Ask for the lease."""
        if self._holder_id == session_id:
            return LeaseReply(True)
        if self._holder_id is None or self._is_idle:
            self._grant(session_id)
            return LeaseReply(True)
        if self._asked_by_id is None:
            self._asked_by_id, self._asked_ns = session_id, self._clock.now_ns()
            self._on_change()
        if self._asked_by_id == session_id:
            return LeaseReply(False, "somebody drives and has been asked; wait for the answer")
        return LeaseReply(False, "somebody drives and somebody else has asked before you; try again")

    def answer(self, session_id: int, asker_id: int, grant: bool) -> LeaseReply:
        """The holder's answer to whoever asked."""
        if self._holder_id != session_id:
            return LeaseReply(False, "only who drives can hand over")
        if self._asked_by_id != asker_id:
            return LeaseReply(False, f"session {asker_id} does not ask (any more)")
        if grant:
            self._grant(asker_id)
        else:
            self._asked_by_id = None
            self._on_change()
        return LeaseReply(True)

    def leave(self, session_id: int) -> None:
        """The session gives the lease back, withdraws its ask, or is gone."""
        if self._holder_id == session_id:
            self._grant(self._asked_by_id)
        elif self._asked_by_id == session_id:
            self._asked_by_id = None
            self._on_change()

    def tick(self) -> None:
        """Grant an ask that nobody answered while nobody acted."""
        quiet_since_ns = max(self._asked_ns, self._last_command_ns)
        if self._asked_by_id is not None and self._clock.now_ns() - quiet_since_ns >= ANSWER_NS:
            self._grant(self._asked_by_id)

    @property
    def _is_idle(self) -> bool:
        if self._holder_id is None:
            return False
        return self._clock.now_ns() - self._last_command_ns >= IDLE_NS

    def _grant(self, session_id: int | None) -> None:
        self._holder_id = session_id
        self._asked_by_id = None
        self._last_command_ns = self._clock.now_ns()
        self._on_change()
