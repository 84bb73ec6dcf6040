"""`/ws/video`: frames to one viewer, each acknowledged, one in flight, newest wins."""

import asyncio
import json

from starlette.websockets import WebSocket, WebSocketDisconnect

from tapreach.errors import LinkLost
from tapreach.robot.clock import SECOND, Clock
from tapreach.server.background import run_until_first_ends
from tapreach.server.video_feed import VideoFeed
from tapreach.server.viewer_pace import ViewerPace

PROBE_NS = 5 * SECOND
LONGEST_TEXT = 200


class Viewer:
    """One video socket. Text from the server is `{"probe": n}`, to be sent back at once."""

    def __init__(self, socket: WebSocket, feed: VideoFeed, clock: Clock, interval_ns: int) -> None:
        self._socket = socket
        self._feed = feed
        self._clock = clock
        self._pace = ViewerPace(interval_ns)
        self._acknowledged = asyncio.Event()
        self._probe = 0
        self._probe_ns = -PROBE_NS

    async def run(self) -> None:
        """Serve until the viewer leaves."""
        await self._socket.accept()
        self._feed.viewers += 1
        try:
            await run_until_first_ends(self._send_frames(), self._hear_acknowledgements())
        except LinkLost as error:
            await self._socket.close(1001, str(error))
        finally:
            self._feed.viewers -= 1

    async def _send_frames(self) -> None:
        last_id = 0
        while True:
            await self._feed.newer_than(last_id)
            while not self._pace.is_open:
                self._acknowledged.clear()
                await self._acknowledged.wait()
            await self._probe_now_and_then()
            packet = await self._feed.newer_than(last_id)
            encoded = await packet.encoded(self._pace.level)
            last_id = encoded.frame_id
            now_ns = self._clock.now_ns()
            self._pace.sent(last_id, now_ns)
            await self._socket.send_bytes(encoded.message(now_ns))

    async def _probe_now_and_then(self) -> None:
        now_ns = self._clock.now_ns()
        if now_ns - self._probe_ns >= PROBE_NS:
            self._probe, self._probe_ns = self._probe + 1, now_ns
            await self._socket.send_text(json.dumps({"probe": self._probe}))

    async def _hear_acknowledgements(self) -> None:
        while True:
            message = await self._socket.receive()
            if message["type"] == "websocket.disconnect":
                raise WebSocketDisconnect(message.get("code", 1006))
            if not self._take(message.get("text") or ""):
                reason = 'wanted {"ack": frame_id} or {"probe": n}'
                await self._socket.send_text(json.dumps({"refused": reason}))

    def _take(self, text: str) -> bool:
        try:
            value = json.loads(text) if len(text) <= LONGEST_TEXT else None
        except (ValueError, RecursionError):
            return False
        if not isinstance(value, dict):
            return False
        if isinstance(value.get("ack"), int):
            self._pace.acknowledged(value["ack"], self._clock.now_ns())
            self._acknowledged.set()
            return True
        if value.get("probe") == self._probe:
            self._pace.measured_round_trip(self._clock.now_ns() - self._probe_ns)
            return True
        return isinstance(value.get("probe"), int)
