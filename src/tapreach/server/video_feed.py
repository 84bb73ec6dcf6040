"""The newest frame, for everybody who watches."""

import asyncio
from collections.abc import Callable

from tapreach.errors import LinkLost
from tapreach.robot.messages import Frame
from tapreach.server.frame_packet import FramePacket


class VideoFeed:
    """Holds one frame. `describe` makes its meta, once per frame and only when somebody watches."""

    def __init__(self, describe: Callable[[Frame], bytes]) -> None:
        self._describe = describe
        self._newest: Frame | None = None
        self._packet: FramePacket | None = None
        self._arrival = asyncio.Event()
        self._has_ended = False
        self.viewers = 0

    def publish(self, frame: Frame) -> None:
        """Put a frame in the place of the one before."""
        self._newest = frame
        self._packet = None
        self._arrival.set()
        self._arrival = asyncio.Event()

    def end(self) -> None:
        """Let everybody who waits for a frame know that there will be none."""
        self._has_ended = True
        self._arrival.set()

    async def newer_than(self, frame_id: int) -> FramePacket:
        """Return the newest frame for sending, as soon as it is newer than `frame_id`."""
        frame = await self.frame_newer_than(frame_id)
        if self._packet is None:
            self._packet = FramePacket(frame, self._describe(frame))
        return self._packet

    async def frame_newer_than(self, frame_id: int) -> Frame:
        """Return the newest frame as soon as it is newer than `frame_id`. Raises LinkLost at the end."""
        while self._newest is None or self._newest.frame_id <= frame_id:
            if self._has_ended:
                raise LinkLost("the server is closing")
            await self._arrival.wait()
        return self._newest
