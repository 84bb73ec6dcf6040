"""What the server knows of one open control socket."""

from dataclasses import dataclass, field

from tapreach.control.clock_alignment import ClockAlignment
from tapreach.server.outbox import Outbox


@dataclass
class Visitor:
    """One session: who it is, how its clock runs, and what waits to be sent to it."""

    session_id: int
    name: str
    alignment: ClockAlignment = field(default_factory=ClockAlignment)
    outbox: Outbox = field(default_factory=Outbox)
    has_said_hello: bool = False
