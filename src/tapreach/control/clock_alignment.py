"""How old a message is on arrival, from a sender whose clock starts anywhere."""

from tapreach.robot.clock import MS

DRIFT = 1e-4
"""Fastest drift between two clocks that is followed: 100 ppm, 6 ms per minute."""


class ClockAlignment:
    """Compares each message with the fastest one of its session.

    The difference `received - sent` is offset + delay; its least value is the offset plus the least delay
    of the link. What a message has above that is its age. A delay that every message shares is not seen here;
    it is seen in the age of the picture that a command names, which has both ends on the server's clock.
    The least value rises by `DRIFT` with time, so that a slow clock is followed and a clogged link is not.
    """

    def __init__(self) -> None:
        self._least_ns: float | None = None
        self._noted_ns = 0

    def age_ns(self, client_ms: float, received_ns: int) -> int:
        """Return how much later than the fastest message this one arrived [ns]; 0 for the first."""
        difference_ns = received_ns - client_ms * MS
        if self._least_ns is None:
            least_ns = difference_ns
        else:
            least_ns = min(difference_ns, self._least_ns + DRIFT * (received_ns - self._noted_ns))
        self._least_ns, self._noted_ns = least_ns, received_ns
        return round(difference_ns - least_ns)
