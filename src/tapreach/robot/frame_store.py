"""The last seconds of pictures, by id. A tap names a frame here, or learns that it is gone."""

from collections import OrderedDict

from tapreach.errors import FrameExpired, FrameUnknown
from tapreach.robot.clock import SECOND
from tapreach.robot.messages import Frame


class FrameStore:
    """Keeps JPEG frames for `keep_ns` behind the newest, and never more than `max_bytes` of them."""

    def __init__(self, keep_ns: int = 30 * SECOND, max_bytes: int = 100_000_000) -> None:
        self._keep_ns = keep_ns
        self._max_bytes = max_bytes
        self._bytes = 0
        self._frames: OrderedDict[int, Frame] = OrderedDict()
        self._newest_id = 0

    def add(self, frame: Frame) -> None:
        """Store a frame; ids must rise. Drops what has become too old or too much."""
        self._newest_id = max(self._newest_id, frame.frame_id)
        self._frames[frame.frame_id] = frame
        self._bytes += len(frame.jpeg)
        while len(self._frames) > 1 and self._is_over(frame.captured_ns):
            _, dropped = self._frames.popitem(last=False)
            self._bytes -= len(dropped.jpeg)

    def _is_over(self, now_ns: int) -> bool:
        oldest = next(iter(self._frames.values()))
        return oldest.captured_ns < now_ns - self._keep_ns or self._bytes > self._max_bytes

    def get(self, frame_id: int) -> Frame:
        """Return the frame. Raises FrameExpired when it was dropped, FrameUnknown when it never was."""
        frame = self._frames.get(frame_id)
        if frame is not None:
            return frame
        if 1 <= frame_id <= self._newest_id:
            oldest = next(iter(self._frames), self._newest_id)
            raise FrameExpired(
                f"picture {frame_id} is no longer kept (the oldest is {oldest}): tap a newer picture"
            )
        raise FrameUnknown(f"there was no picture {frame_id} (the newest is {self._newest_id})")

    @property
    def newest(self) -> Frame | None:
        """The newest frame, None before the first."""
        return next(reversed(self._frames.values())) if self._frames else None

    def since(self, frame_id: int) -> list[Frame]:
        """Return the stored frames newer than `frame_id`, oldest first."""
        return [frame for key, frame in self._frames.items() if key > frame_id]
