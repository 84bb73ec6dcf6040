"""All pages that are open: one encoding of a message, put into every outbox."""

from tapreach.server.message_base import Message
from tapreach.server.outbox import Outbox


class Hub:
    """Sends to all, and greets newcomers with what was last said under each key that stays true."""

    def __init__(self) -> None:
        self._outboxes: list[Outbox] = []
        self._standing: dict[str, str] = {}

    def join(self, outbox: Outbox) -> None:
        """Send to this one from now on, beginning with what stands."""
        self._outboxes.append(outbox)
        for key, text in self._standing.items():
            outbox.put(key, text)

    def leave(self, outbox: Outbox) -> None:
        """Send to this one no more."""
        if outbox in self._outboxes:
            self._outboxes.remove(outbox)

    def tell(self, key: str, message: Message) -> None:
        """Send to all; under one key only the newest is worth having, also for who comes later."""
        text = message.model_dump_json()
        self._standing[key] = text
        for outbox in self._outboxes:
            outbox.put(key, text)

    def forget(self, key: str) -> None:
        """Do not greet newcomers with this key any more."""
        self._standing.pop(key, None)
