"""What a kind of camera has to give: one picture after the other, to a thread that may wait for them."""

from dataclasses import dataclass
from typing import Protocol

from tapreach.geometry.pixel import ImageSize

OPEN_S = 3.0
"""A camera that has not answered for so long is tried anew."""
STALL_S = 2.0
"""A stream that has not given a picture for so long is opened anew."""


@dataclass(frozen=True, slots=True)
class Picture:
    """A JPEG: when the middle of its exposure was, as far as known, and when it was here [monotonic ns]."""

    captured_ns: int
    received_ns: int
    size: ImageSize
    jpeg: bytes


@dataclass
class Hold:
    """Whether exposure, gain and white balance are to stay: set by one thread, read by another."""

    is_wanted: bool = False


class Stream(Protocol):
    """One opening of one camera. Used by one thread, but for `interrupt`. The constructor opens nothing."""

    @property
    def skipped(self) -> int:
        """Pictures that were broken and left out."""
        ...

    def open(self) -> None:
        """Open the camera, within OPEN_S for each step. Raises DriverError or SetupError."""
        ...

    def read(self) -> Picture:
        """Return the newest picture; waits for one, STALL_S at most. Raises DriverError."""
        ...

    def interrupt(self) -> None:
        """From any thread: let `open` and `read` end soon. May be called at any time, and twice."""
        ...

    def close(self) -> None:
        """Let go of everything; nothing is raised."""
        ...
