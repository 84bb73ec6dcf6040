"""How late pictures arrive by the sender's own time stamps: a link that falls behind is seen by its lag."""

from tapreach.robot.clock import SECOND

FORGETTING = 2e-4
"""How fast two quartz clocks may drift apart [s/s]: so fast the smallest difference is forgotten."""
CLOCK_WAS_SET_NS = 5 * SECOND


class Lag:
    """Compares arrivals with the sender's stamps, whose zero is unknown.

    The smallest difference so far is taken as "on time"; what a picture has more, it is late by: it waited
    in some buffer, and shows what was then. A stamp that goes back, or leaves a gap that the arrivals do not
    have, means the sender's clock was set, and all begins anew.
    """

    def __init__(self) -> None:
        self._floor_ns: int | None = None
        self._arrival_ns = 0
        self._stamp_ns = 0

    def of(self, arrival_ns: int, stamp_ns: int) -> int:
        """Return by how much the picture is late [ns], 0 or more."""
        difference_ns = arrival_ns - stamp_ns
        elapsed_ns = arrival_ns - self._arrival_ns
        advanced_ns = stamp_ns - self._stamp_ns
        if self._floor_ns is None or advanced_ns < 0 or advanced_ns - elapsed_ns > CLOCK_WAS_SET_NS:
            self._floor_ns = difference_ns
        else:
            self._floor_ns = min(difference_ns, self._floor_ns + round(FORGETTING * elapsed_ns))
        self._arrival_ns, self._stamp_ns = arrival_ns, stamp_ns
        return difference_ns - self._floor_ns
