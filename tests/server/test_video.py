"""Pictures on the wire: the header, the newest frame, acknowledgements, slow viewers, other programs."""

import asyncio
import json

import cv2
import httpx
import numpy as np
import pytest
from websockets.asyncio.client import ClientConnection, connect

from tapreach.geometry.pixel import ImageSize
from tapreach.robot.clock import MS, SECOND
from tapreach.robot.messages import Frame
from tapreach.server.frame_packet import HEADER, LADDER, FramePacket
from tapreach.server.mjpeg import BOUNDARY


def jpeg_of(width: int, height: int) -> bytes:
    noise = np.random.default_rng(1).integers(0, 255, (height, width, 3), np.uint8)
    return cv2.imencode(".jpg", noise)[1].tobytes()


class Watcher:
    """A viewer that draws when the test says so."""

    def __init__(self, socket: ClientConnection) -> None:
        self.socket = socket

    async def picture(self) -> tuple[tuple, dict, bytes]:
        """The next frame: header, meta, JPEG; probes are sent back on the way."""
        while True:
            message = await asyncio.wait_for(self.socket.recv(), 20)
            if isinstance(message, bytes):
                header = HEADER.unpack_from(message)
                end = HEADER.size + header[-1]
                return header, json.loads(message[HEADER.size : end]), message[end:]
            await self.socket.send(message)

    async def drawn(self, frame_id: int) -> None:
        await self.socket.send(json.dumps({"ack": frame_id}))

    async def nothing_comes(self) -> None:
        with pytest.raises(TimeoutError):
            await asyncio.wait_for(self.socket.recv(), 0.05)


def watching(scenario):
    async def with_watcher(here):
        async with connect(f"ws://{here.host}/ws/video", compression=None) as socket:
            await here.eventually(lambda: here.station.feed.viewers == 1)
            await scenario(here, Watcher(socket))
        await here.eventually(lambda: here.station.feed.viewers == 0)

    return with_watcher


def test_header_names_the_frame_and_its_jpeg_is_the_cameras_own(play):
    async def scenario(here, watcher):
        await here.clock.advance(40 * MS)
        (magic, frame_id, captured_ns, sent_ns, width, height, _), meta, jpeg = await watcher.picture()
        frame = here.station.frames.get(frame_id)
        assert (magic, width, height) == (b"TRV1", 640, 480)
        assert captured_ns == frame.captured_ns
        assert captured_ns <= sent_ns <= here.clock.now_ns()
        assert jpeg == frame.jpeg
        assert meta == {"base": [0.0, 0.0, 0.0], "markers": []}

    play(watching(scenario))


def test_next_frame_comes_only_after_the_acknowledgement_and_is_the_newest(play):
    async def scenario(here, watcher):
        await here.clock.advance(40 * MS)
        (_, first_id, *_), _, _ = await watcher.picture()
        await here.clock.advance(500 * MS)
        await watcher.nothing_comes()
        await watcher.drawn(first_id)
        (_, second_id, *_), _, _ = await watcher.picture()
        assert second_id == here.newest_id > first_id + 10

    play(watching(scenario))


@pytest.mark.parametrize("text", ["", "nonsense", "[]", '{"ack": "1"}', '{"probe": "x"}', "[" * 300, "1"])
def test_wrong_text_is_refused_and_the_pictures_go_on(play, text):
    async def scenario(here, watcher):
        await here.clock.advance(40 * MS)
        (_, frame_id, *_), _, _ = await watcher.picture()
        await watcher.socket.send(text)
        assert "refused" in json.loads(await watcher.socket.recv())
        await watcher.drawn(frame_id)
        await here.clock.advance(40 * MS)
        await watcher.picture()

    play(watching(scenario))


def test_slow_viewer_does_not_hold_up_others(play):
    async def scenario(here, slow):
        await here.clock.advance(40 * MS)
        await slow.picture()
        async with connect(f"ws://{here.host}/ws/video", compression=None) as socket:
            quick, seen = Watcher(socket), []
            for _ in range(10):
                (_, frame_id, *_), _, _ = await quick.picture()
                seen.append(frame_id)
                await quick.drawn(frame_id)
                await here.clock.advance(40 * MS)
        assert len(set(seen)) == 10

    play(watching(scenario))


def test_late_acknowledgements_bring_smaller_pictures(play):
    async def scenario(here, watcher):
        shapes = []
        for _ in range(14):
            await here.clock.advance(100 * MS)
            (_, frame_id, _, _, width, height, _), _, jpeg = await watcher.picture()
            decoded = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
            assert decoded.shape[:2] == (height, width)
            shapes.append((width, height))
            await here.clock.advance(100 * MS)
            await watcher.drawn(frame_id)
        assert shapes[0] == (640, 480)
        assert shapes[-1] == (320, 240)

    play(watching(scenario))


@pytest.mark.parametrize("level", range(len(LADDER)))
def test_each_quality_is_encoded_once_for_all_viewers(level, monkeypatch):
    import tapreach.server.frame_packet as module

    calls, plain = [], module.reencoded
    monkeypatch.setattr(module, "reencoded", lambda *given: calls.append(1) or plain(*given))
    frame = Frame(1, SECOND, SECOND, ImageSize(640, 480), jpeg_of(640, 480))

    async def scenario():
        packet = FramePacket(frame, b"{}")
        return await asyncio.gather(*(packet.encoded(level) for _ in range(5)))

    encodings = asyncio.run(scenario())
    assert len({encoded.jpeg for encoded in encodings}) == 1
    assert len(calls) == (0 if level == 0 else 1)
    assert len(encodings[0].jpeg) <= len(frame.jpeg)


def test_snapshot_is_the_newest_frame(play):
    async def scenario(here):
        await here.clock.advance(100 * MS)
        async with httpx.AsyncClient() as client:
            response = await client.get(f"http://{here.host}/snapshot.jpg")
        assert response.content == here.station.frames.newest.jpeg
        assert response.headers["content-type"] == "image/jpeg"
        assert int(response.headers["x-frame-id"]) == here.newest_id
        assert response.headers["cache-control"] == "no-store"

    play(scenario)


def test_mjpeg_sends_the_head_of_the_next_part_with_each_picture(play):
    async def scenario(here):
        await here.clock.advance(40 * MS)
        head = f"--{BOUNDARY}\r\nContent-Type: image/jpeg\r\n\r\n".encode()
        url = f"http://{here.host}/stream.mjpg"
        async with httpx.AsyncClient() as client, client.stream("GET", url) as response:
            assert response.headers["content-type"] == f"multipart/x-mixed-replace; boundary={BOUNDARY}"
            got, wanted = b"", head + here.station.frames.newest.jpeg + b"\r\n" + head
            async for chunk in response.aiter_raw():
                got += chunk
                if len(got) >= len(wanted):
                    break
            assert got == wanted
        await here.eventually(lambda: here.station.feed.viewers == 0)

    play(scenario)
