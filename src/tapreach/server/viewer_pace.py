"""How much one viewer's link can take: frames in flight, and the quality that keeps up with the camera."""

from tapreach.robot.clock import MS, SECOND
from tapreach.server.frame_packet import LADDER

FAR_NS = 20 * MS
"""Above this round trip of an empty link two frames are in flight, else one."""
SMOOTHING = 0.3
LATE_ACKS = 5
CALM_NS = 3 * SECOND
LONGEST_WAIT_NS = 60 * SECOND


class ViewerPace:
    """Fed with every acknowledgement; all times on one clock [ns].

    Quality goes down when frames take longer than the camera's interval to be acknowledged, beyond the round
    trip of the empty link; it goes up on trial after a calm time, which doubles each time a trial fails.
    """

    def __init__(self, interval_ns: int) -> None:
        self._interval_ns = interval_ns
        self._in_flight: dict[int, int] = {}
        self._round_trip_ns = 0
        self._transfer_ns: float = 0.0
        self._acks_at_level = 0
        self._calm_since_ns: int | None = None
        self._wait_ns = CALM_NS
        self._raised_ns: int | None = None
        self.level = 0

    @property
    def is_open(self) -> bool:
        """True when another frame may be sent."""
        return len(self._in_flight) < (2 if self._round_trip_ns > FAR_NS else 1)

    def sent(self, frame_id: int, now_ns: int) -> None:
        """Note that a frame has left."""
        self._in_flight[frame_id] = now_ns

    def measured_round_trip(self, round_trip_ns: int) -> None:
        """Note the round trip of a message too small to fill the link."""
        self._round_trip_ns = round_trip_ns

    def acknowledged(self, frame_id: int, now_ns: int) -> None:
        """Note that a frame, and all before it, has been drawn. Unknown ids change nothing."""
        sent_ns = self._in_flight.get(frame_id)
        if sent_ns is None:
            return
        self._in_flight = {key: when for key, when in self._in_flight.items() if key > frame_id}
        transfer_ns = max(0, now_ns - sent_ns - self._round_trip_ns)
        self._acks_at_level += 1
        share = SMOOTHING if self._acks_at_level > 1 else 1.0
        self._transfer_ns += share * (transfer_ns - self._transfer_ns)
        self._adapt(now_ns)

    def _adapt(self, now_ns: int) -> None:
        if self._transfer_ns > self._interval_ns:
            self._calm_since_ns = None
            if self._acks_at_level >= LATE_ACKS and self.level < len(LADDER) - 1:
                self._lower(now_ns)
        elif self._transfer_ns > self._interval_ns / 2 or self.level == 0:
            self._calm_since_ns = None
        elif self._calm_since_ns is None:
            self._calm_since_ns = now_ns
        elif now_ns - self._calm_since_ns >= self._wait_ns:
            self._raised_ns = now_ns
            self._change_level(-1)

    def _lower(self, now_ns: int) -> None:
        trial_failed = self._raised_ns is not None and now_ns - self._raised_ns < CALM_NS
        self._wait_ns = min(2 * self._wait_ns, LONGEST_WAIT_NS) if trial_failed else CALM_NS
        self._change_level(+1)

    def _change_level(self, step: int) -> None:
        self.level += step
        self._acks_at_level = 0
        self._calm_since_ns = None
