"""Commands that wait for their acknowledgement, for a bounded time."""

from dataclasses import dataclass

from tapreach.drivers.arduino.wire import Ack, ToFirmware
from tapreach.robot.clock import MS

PATIENCE_NS = 250 * MS
"""Far less than the 256 sequence numbers take to come round, far more than a round trip."""


@dataclass(frozen=True, slots=True)
class Sent:
    """A command on its way."""

    message: ToFirmware
    sent_ns: int


class Pending:
    """What was sent and is not acknowledged. An answer after `PATIENCE_NS` is stale."""

    def __init__(self) -> None:
        self._sent: dict[int, Sent] = {}
        self.stale = 0
        self.unanswered_in_row = 0

    def note(self, seq: int, message: ToFirmware, now_ns: int) -> None:
        """Remember a command."""
        self._sent[seq & 0xFF] = Sent(message, now_ns)

    def settle(self, ack: Ack, now_ns: int) -> ToFirmware | None:
        """Return the command that is acknowledged; None, and a count, for what is stale or never was."""
        sent = self._sent.pop(ack.of, None)
        if sent is None or now_ns - sent.sent_ns > PATIENCE_NS:
            self.stale += 1
            return None
        self.unanswered_in_row = 0
        return sent.message

    def overdue(self, now_ns: int) -> list[ToFirmware]:
        """Take out and return the commands that nobody has answered in time."""
        late = [seq for seq, sent in self._sent.items() if now_ns - sent.sent_ns > PATIENCE_NS]
        self.unanswered_in_row += len(late)
        return [self._sent.pop(seq).message for seq in late]

    def forget(self) -> None:
        """Nothing sent before is waited for."""
        self._sent.clear()
        self.unanswered_in_row = 0
