"""`/stream.mjpg` and `/snapshot.jpg`: for programs that know nothing of our sockets."""

from collections.abc import AsyncIterator

from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response, StreamingResponse

from tapreach.errors import LinkLost
from tapreach.robot.frame_store import FrameStore
from tapreach.server.video_feed import VideoFeed

BOUNDARY = "tapreach-frame"
PART_HEAD = f"--{BOUNDARY}\r\nContent-Type: image/jpeg\r\n\r\n".encode()
NO_STORE = {"Cache-Control": "no-store"}


class PlainVideo:
    """The newest frames over plain HTTP."""

    def __init__(self, feed: VideoFeed, frames: FrameStore) -> None:
        self._feed = feed
        self._frames = frames

    async def stream(self, _: Request) -> Response:
        """Answer with a multipart stream that never ends; a slow reader misses frames."""
        media_type = f"multipart/x-mixed-replace; boundary={BOUNDARY}"
        return StreamingResponse(self._parts(), media_type=media_type, headers=NO_STORE)

    async def snapshot(self, _: Request) -> Response:
        """Answer with the newest frame."""
        frame = self._frames.newest
        if frame is None:
            return PlainTextResponse("no picture yet\n", status_code=503, headers=NO_STORE)
        facts = {"X-Frame-Id": str(frame.frame_id), "X-Captured-Ns": str(frame.captured_ns)}
        return Response(frame.jpeg, media_type="image/jpeg", headers=NO_STORE | facts)

    async def _parts(self) -> AsyncIterator[bytes]:
        self._feed.viewers += 1
        try:
            last_id = 0
            yield PART_HEAD
            while True:
                frame = await self._feed.frame_newer_than(last_id)
                last_id = frame.frame_id
                # A browser shows a part when it has the head of the next one: send that ahead.
                yield frame.jpeg + b"\r\n" + PART_HEAD
        except LinkLost:
            return  # the server is closing: a stream has no other way to say so than to end
        finally:
            self._feed.viewers -= 1
