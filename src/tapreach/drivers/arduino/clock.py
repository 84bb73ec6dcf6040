"""The board's clock as seen from here: a 32-bit count of microseconds that wraps every 71.6 minutes."""

from collections import deque
from dataclasses import dataclass

from tapreach.robot.clock import MS

US = 1000
"""Nanoseconds of a microsecond."""
WRAP_US = 2**32
KEPT = 16
DRIFT = 2e-4
"""How fast a ceramic resonator may run away from our clock: doubt that an old round trip gathers [s/s]."""


@dataclass(frozen=True, slots=True)
class _Trip:
    offset_ns: int
    half_ns: int
    middle_ns: int

    def doubt_ns(self, now_ns: int) -> float:
        return self.half_ns + DRIFT * max(0, now_ns - self.middle_ns)


class BoardClock:
    """Offset from the board's microseconds to our nanoseconds, by the round trip that leaves least doubt.

    The answer was written somewhere between question and reply: half the round trip is the doubt, and it
    grows with age by the drift, so that a quick old trip is given up for a fresh one in time. Of the last 16
    trips the best counts; the offset therefore follows a drifting clock and not a clogged line.
    """

    def __init__(self) -> None:
        self._trips: deque[_Trip] = deque(maxlen=KEPT)
        self._newest_us: int | None = None

    @property
    def is_aligned(self) -> bool:
        """True once a round trip is known."""
        return bool(self._trips)

    def reset(self) -> None:
        """Forget everything: the board has restarted."""
        self._trips.clear()
        self._newest_us = None

    def take_trip(self, asked_ns: int, at_us: int, heard_ns: int) -> None:
        """Take a pong: asked and heard by our clock, answered when the board's count was `at_us`."""
        middle_ns = (asked_ns + heard_ns) // 2
        offset_ns = middle_ns - self._unwrapped(at_us) * US
        self._trips.append(_Trip(offset_ns, (heard_ns - asked_ns) // 2, middle_ns))

    def time_of_ns(self, at_us: int, heard_ns: int) -> int | None:
        """Return our time of the board's count `at_us`, not after `heard_ns`; None before the first trip."""
        best = self._best(heard_ns)
        unwrapped = self._unwrapped(at_us)
        return None if best is None else min(heard_ns, unwrapped * US + best.offset_ns)

    def board_ms(self, now_ns: int) -> int | None:
        """Return the board's milliseconds now, modulo 2^32; None before the first trip."""
        best = self._best(now_ns)
        return None if best is None else (now_ns - best.offset_ns) // MS % WRAP_US

    def doubt_ns(self, now_ns: int) -> int | None:
        """Return how far the alignment may be off; None before the first trip."""
        best = self._best(now_ns)
        return None if best is None else round(best.doubt_ns(now_ns))

    def _best(self, now_ns: int) -> _Trip | None:
        return min(self._trips, key=lambda trip: trip.doubt_ns(now_ns), default=None)

    def _unwrapped(self, at_us: int) -> int:
        """Return the count without wraps: the nearest to the newest that is known."""
        newest = self._newest_us if self._newest_us is not None else at_us
        half = WRAP_US // 2
        unwrapped = newest + (at_us - newest + half) % WRAP_US - half
        self._newest_us = max(newest, unwrapped)
        return unwrapped
