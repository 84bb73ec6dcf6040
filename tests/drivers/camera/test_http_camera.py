"""A network camera on loopback: what arrives, what is refused, and that it comes back by itself."""

import asyncio
import threading
from base64 import b64encode
from itertools import count

import pytest
from tests.drivers.camera.mjpeg_server import OK, MjpegServer, Visit
from tests.drivers.camera.pictures import jpeg, part
from tests.drivers.camera.watching import section, watched

from tapreach.drivers.camera.factory import make_camera
from tapreach.errors import ConfigError, DriverError
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.clock import MS, SECOND, MonotonicClock

JPEGS = [jpeg(seed) for seed in range(8)]


async def stream_on(visit: Visit) -> None:
    await visit.send(OK)
    for number in count():
        await visit.send(part(JPEGS[number % len(JPEGS)]))
        await asyncio.sleep(0.01)


def play(answer, scenario, source=None, **settings):
    async def run():
        async with MjpegServer(answer).running() as server:
            url = source.format(port=server.port) if source else server.url
            async with watched(section(url, **settings)) as seen:
                await scenario(server, seen)
            async with asyncio.timeout(5):
                while server.open_connections:
                    await asyncio.sleep(0.005)

    asyncio.run(run())


def test_frames_are_numbered_from_one_and_pass_untouched():
    async def scenario(server, seen):
        before_ns = MonotonicClock().now_ns()
        await seen.until(lambda: len(seen.frames) >= 12)
        assert [frame.frame_id for frame in seen.frames] == list(range(1, len(seen.frames) + 1))
        assert {frame.jpeg for frame in seen.frames} <= set(JPEGS)
        assert {frame.size for frame in seen.frames} == {ImageSize(160, 120)}
        for frame in seen.frames:
            assert frame.received_ns - frame.captured_ns == 70 * MS
            assert before_ns - SECOND < frame.received_ns <= MonotonicClock().now_ns()
        assert seen.camera.status.is_running
        assert "GET /?action=stream HTTP/1.1" in server.visits[0].request

    play(stream_on, scenario, delay_ms=70.0)


def test_user_and_password_of_the_source_are_sent_and_never_told():
    async def refuse(visit):
        await visit.send(b"HTTP/1.1 401 Unauthorized\r\nContent-Length: 0\r\n\r\n")

    async def scenario(server, seen):
        await seen.until(lambda: "401" in seen.camera.status.reason)
        assert "secret" not in str(seen.statuses)
        assert f"Basic {b64encode(b'anna:secret@1').decode()}" in server.visits[0].request

    user = "anna:secret%401"
    play(refuse, scenario, f"http://{user}@127.0.0.1:{{port}}/")


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (b"HTTP/1.0 200 OK\r\nContent-Type: text/html\r\n\r\n<html>", "sends text/html, no MJPEG stream"),
        (b"HTTP/1.0 200 OK\r\nContent-Type: image/jpeg\r\n\r\n", "sends image/jpeg"),
        (b"HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace\r\n\r\n", "with a boundary"),
        (b"HTTP/1.0 200 OK\r\n\r\n", "no content type"),
        (b"HTTP/1.0 404 Not Found\r\n\r\n", "answers 404 Not Found"),
        (b"HTTP/1.0 302 Found\r\nLocation: /login\r\n\r\n", "to /login"),
        (b"ICY 200 OK\r\n\r\n", "does not answer"),
        (b"", "does not answer"),
    ],
)
def test_answer_that_is_no_stream_is_named_and_tried_again(answer, said):
    async def scenario(server, seen):
        await seen.until(lambda: said in seen.camera.status.reason and len(server.visits) >= 2)
        assert seen.frames == []

    play(lambda visit: visit.send(answer), scenario)


@pytest.mark.parametrize("how", ["close", "reset", "close mid-part"])
def test_stream_that_breaks_off_is_told_at_once_and_opened_anew(how):
    async def twice(visit):
        if visit.number > 1:
            return await stream_on(visit)
        await visit.send(OK + part(JPEGS[0]))
        await asyncio.sleep(0.1)
        if how == "reset":
            return visit.reset()
        return await visit.send(part(JPEGS[1])[:900] if how == "close mid-part" else b"")

    async def scenario(server, seen):
        await seen.until(lambda: len(seen.frames) >= 5)
        assert [frame.frame_id for frame in seen.frames] == list(range(1, len(seen.frames) + 1))
        running = [status.is_running for status in seen.statuses]
        assert running == [False, True, False, True]
        assert any(words in seen.statuses[2].reason for words in ("ended the stream", "broke off"))

    play(twice, scenario)


def test_stream_that_stalls_is_told_after_a_second_and_opened_anew():
    async def stall_first(visit):
        if visit.number > 1:
            return await stream_on(visit)
        await visit.send(OK + part(JPEGS[0]) + part(JPEGS[1])[:900])
        return await asyncio.sleep(60)

    async def scenario(server, seen):
        await seen.until(lambda: len(seen.frames) >= 3)
        assert [status.is_running for status in seen.statuses] == [False, True, False, False, True]
        assert "no picture for" in seen.statuses[2].reason
        gap_ns = seen.frames[1].received_ns - seen.frames[0].received_ns
        assert 2 * SECOND <= gap_ns <= 6 * SECOND

    play(stall_first, scenario)


def test_bytes_that_drip_without_a_picture_are_a_stall_too():
    async def drip(visit):
        await visit.send(OK + b"--frame\r\n\r\n" + JPEGS[0][:400])
        while True:
            await visit.send(b"\x55")
            await asyncio.sleep(0.02)

    async def scenario(server, seen):
        await seen.until(lambda: "no picture for 2 s" in seen.camera.status.reason)

    play(drip, scenario)


def test_broken_pictures_are_counted_and_left_out():
    async def some_broken(visit):
        await visit.send(OK)
        for number in count():
            await visit.send(part(b"\xff\xd8 no picture") + part(JPEGS[number % 8]))
            await asyncio.sleep(0.01)

    async def scenario(server, seen):
        await seen.until(lambda: len(seen.frames) >= 5)
        assert {frame.jpeg for frame in seen.frames} <= set(JPEGS)
        assert seen.camera.skipped >= 5

    play(some_broken, scenario)


def test_picture_of_another_size_than_the_robot_file_says_is_refused():
    async def scenario(server, seen):
        await seen.until(lambda: "sends 160 x 120" in seen.camera.status.reason)
        assert "robot file says 640 x 480" in seen.camera.status.reason
        assert seen.frames == []

    play(stream_on, scenario, width=640, height=480)


def test_of_many_pictures_that_wait_the_newest_is_told():
    async def burst(visit):
        await visit.send(OK + b"".join(part(data) for data in JPEGS))
        await asyncio.sleep(60)

    async def scenario(server, seen):
        await seen.until(lambda: seen.frames and seen.frames[-1].jpeg == JPEGS[-1])
        assert len(seen.frames) <= 3

    play(burst, scenario)


def test_pictures_that_pile_up_on_the_way_are_known_to_be_old_by_their_stamps():
    async def later_and_later(visit):
        await visit.send(OK)
        for number in count():
            stamp = f"X-Timestamp: {1000.0 + 0.005 * number:.6f}\r\n"
            await visit.send(part(JPEGS[number % 8], extra=stamp))
            await asyncio.sleep(0.07)

    async def scenario(server, seen):
        await seen.until(lambda: len(seen.frames) >= 12)
        ages_ns = [frame.received_ns - frame.captured_ns for frame in seen.frames]
        assert ages_ns[0] == 0
        assert ages_ns[10] > 500 * MS  # the gate calls this one frozen

    play(later_and_later, scenario)


def test_chunked_stream_is_read_as_well():
    async def chunked(visit):
        await visit.send(
            OK.replace(b"\r\n\r\n", b"\r\nTransfer-Encoding: chunked\r\n\r\n").replace(b"1.0", b"1.1")
        )
        for number in count():
            data = part(JPEGS[number % 8])
            for piece in (data[:500], data[500:]):
                await visit.send(f"{len(piece):x}\r\n".encode() + piece + b"\r\n")
            await asyncio.sleep(0.01)

    async def scenario(server, seen):
        await seen.until(lambda: len(seen.frames) >= 5)
        assert {frame.jpeg for frame in seen.frames} <= set(JPEGS)

    play(chunked, scenario)


def test_connect_returns_with_the_first_picture_and_raises_why_there_is_none():
    async def run():
        async with MjpegServer(stream_on).running() as server:
            camera = make_camera(section(server.url), MonotonicClock())
            await camera.connect()
            assert camera.status.is_running
            await camera.close()
            await camera.close()
            assert camera.status.reason == "the camera is closed"
        gone = make_camera(section(server.url), MonotonicClock())
        with pytest.raises(DriverError, match=r"no picture within 1 s: .*does not answer"):
            await gone.connect(patience_s=1.0)
        assert "camera" not in [thread.name for thread in threading.enumerate()]

    asyncio.run(run())


def test_server_that_comes_late_is_found():
    async def run():
        server = MjpegServer(stream_on)
        async with server.running():
            pass
        async with watched(section(server.url)) as seen:
            await seen.until(lambda: "does not answer" in seen.camera.status.reason)
            async with server.running():
                await seen.until(lambda: len(seen.frames) >= 2)

    asyncio.run(run())


def test_camera_without_a_source_says_what_would_be_one():
    with pytest.raises(ConfigError, match="v4l2:/dev/video0"):
        make_camera(section("v4l2:/dev/video0").model_copy(update={"source": None}), MonotonicClock())
