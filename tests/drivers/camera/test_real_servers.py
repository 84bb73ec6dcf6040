"""Against servers as people run them: ustreamer (MJPEG over HTTP) and GStreamer's RTSP server."""

import asyncio
from itertools import pairwise

import cv2
import numpy as np
import pytest
from tests.drivers.camera.real_servers import free_port, rtsp_server, ustreamer
from tests.drivers.camera.watching import section, watched

from tapreach.geometry.pixel import ImageSize
from tapreach.robot.clock import MS, MonotonicClock


def picture_of(frame):
    return cv2.imdecode(np.frombuffer(frame.jpeg, np.uint8), cv2.IMREAD_COLOR)


def test_ustreamer_is_read_and_found_again_after_its_end():
    async def run():
        port = free_port()
        async with watched(section(f"http://127.0.0.1:{port}/stream", 640, 480)) as seen:
            with ustreamer(port):
                await seen.until(lambda: seen.frames)
                assert seen.frames[0].size == ImageSize(640, 480)
                assert picture_of(seen.frames[0]).shape == (480, 640, 3)
            await seen.until(lambda: not seen.camera.status.is_running)
            told = len(seen.frames)
            with ustreamer(port):
                await seen.until(lambda: len(seen.frames) > told)
        assert [frame.frame_id for frame in seen.frames] == list(range(1, len(seen.frames) + 1))
        assert seen.camera.skipped == 0

    asyncio.run(run())


def test_picture_that_ustreamer_shows_instead_of_its_cameras_is_not_taken_for_one():
    async def run():
        port = free_port()
        with ustreamer(port):
            address = f"http://127.0.0.1:{port}/stream?extra_headers=1"
            async with watched(section(address, 640, 480)) as seen:
                await seen.until(lambda: "has no picture of its camera" in seen.camera.status.reason)
                assert seen.frames == []

    asyncio.run(run())


@pytest.mark.parametrize("path", ["mjpeg", "vp8"])
def test_rtsp_camera_is_read(path):
    async def run():
        with rtsp_server() as address:
            async with watched(section(f"{address}/{path}", 320, 240, delay_ms=20.0)) as seen:
                await seen.until(lambda: len(seen.frames) >= 15)
                assert seen.camera.status.is_running
        assert [frame.frame_id for frame in seen.frames] == list(range(1, len(seen.frames) + 1))
        for frame in seen.frames:
            assert frame.received_ns - frame.captured_ns >= 20 * MS
            assert picture_of(frame).shape == (240, 320, 3)
        # The test picture's first bar is white, its last one blue (B, G, R), in both ways to a JPEG.
        top = picture_of(seen.frames[-1])[60]
        assert top[5].min() > 150
        assert int(top[295][0]) - int(top[295][1:].max()) > 80

    asyncio.run(run())


def test_times_of_rtsp_pictures_follow_the_senders_clock_though_they_arrive_unevenly():
    async def run():
        with rtsp_server() as address:
            async with watched(section(f"{address}/mjpeg", 320, 240)) as seen:
                await seen.until(lambda: len(seen.frames) >= 30)
        steps_ms = [(b.captured_ns - a.captured_ns) / MS for a, b in pairwise(seen.frames[10:])]
        # Multiples of the sender's 50 ms: newest wins, so some pictures may be missing.
        apart = [abs(step - 50 * max(1, round(step / 50))) for step in steps_ms]
        assert np.median(apart) < 5

    asyncio.run(run())


def test_rtsp_camera_that_vanishes_is_told_and_closing_takes_bounded_time():
    async def run():
        clock = MonotonicClock()
        with rtsp_server() as address:
            async with watched(section(f"{address}/vp8", 320, 240)) as seen:
                await seen.until(lambda: seen.frames)
                began_ns = clock.now_ns()
                await seen.camera.close()
                assert clock.now_ns() - began_ns < 4_000 * MS
        async with watched(section(f"{address}/vp8", 320, 240)) as seen:
            await seen.until(lambda: "does not answer" in seen.camera.status.reason)
            assert seen.frames == []

    asyncio.run(run())
