"""The V4L2 stream over a device made of answers; no camera was at hand, and none is needed here."""

import asyncio
import errno
import os
from pathlib import Path

import cv2
import numpy as np
import pytest
from tests.drivers.camera.fake_video import FakeVideo
from tests.drivers.camera.pictures import jpeg
from tests.drivers.camera.watching import Watched

from tapreach.drivers.camera import v4l2_abi as abi
from tapreach.drivers.camera.stream import STALL_S, Hold
from tapreach.drivers.camera.threaded import ThreadedCamera
from tapreach.drivers.camera.v4l2_device import VideoDevice
from tapreach.drivers.camera.v4l2_stream import V4l2Stream
from tapreach.errors import DriverError, SetupError
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.clock import MS, SECOND, ManualClock, MonotonicClock

SIZE = ImageSize(160, 120)
EXPOSURE_AUTO, EXPOSURE, PRIORITY = 0x009A0901, 0x009A0902, 0x009A0903
FOCUS_AUTO, FOCUS, WHITE_AUTO, WHITE = 0x009A090C, 0x009A090A, 0x0098090C, 0x0098091A
CONTROLS = {
    EXPOSURE_AUTO: 3, EXPOSURE: 157, PRIORITY: 1, FOCUS_AUTO: 1, FOCUS: 30, WHITE_AUTO: 1, WHITE: 4600,
}  # fmt: skip


def opened(device, clock=None, delay_ns=0, hold=None, keeps_settings=False) -> V4l2Stream:
    clock, hold = clock or ManualClock(100 * SECOND), hold or Hold()
    stream = V4l2Stream("/dev/video0", clock, delay_ns, SIZE, 30.0, hold, lambda path: device, keeps_settings)
    stream.open()
    return stream


def test_jpeg_of_the_camera_passes_untouched_with_the_drivers_time_less_the_delay():
    device, clock = FakeVideo(), ManualClock(100 * SECOND)
    stream = opened(device, clock, delay_ns=5 * MS)
    device.fill(jpeg(1) + bytes(100), 100 * SECOND - 40 * MS)
    picture = stream.read()
    assert picture.jpeg == jpeg(1)
    assert picture.captured_ns == 100 * SECOND - 45 * MS
    assert picture.received_ns == 100 * SECOND
    assert device.rate == (1000, 30000)


@pytest.mark.parametrize(
    ("stamp_ns", "flags"),
    [
        (99 * SECOND, 0),
        (99 * SECOND, 0x4000),
        (101 * SECOND, abi.STAMP_MONOTONIC),
        (10 * SECOND, abi.STAMP_MONOTONIC),
    ],
)
def test_stamp_of_another_clock_is_not_taken(stamp_ns, flags):
    device = FakeVideo()
    stream = opened(device)
    device.fill(jpeg(1), stamp_ns, flags)
    assert stream.read().captured_ns == 100 * SECOND


def test_newest_of_the_waiting_pictures_is_read_and_all_buffers_go_back():
    device = FakeVideo()
    stream = opened(device)
    for seed in range(3):
        device.fill(jpeg(seed), 99 * SECOND + seed * MS)
    assert stream.read().jpeg == jpeg(2)
    assert sorted(device.empty) == [0, 1, 2]


def test_broken_pictures_are_counted_and_left_out():
    device = FakeVideo()
    stream = opened(device)
    device.fill(jpeg(1)[:500], 99 * SECOND)
    device.fill(jpeg(2), 99 * SECOND)
    device.fill(jpeg(3), 99 * SECOND, abi.STAMP_MONOTONIC | abi.BUFFER_ERROR)
    assert stream.read().jpeg == jpeg(2)
    assert stream.skipped == 2


def test_raw_pictures_are_coded_here_in_their_colours():
    device = FakeVideo(formats=("YUYV",))
    stream = opened(device)
    device.fill(bytes([81, 90, 81, 240]) * (160 * 120 // 2), 99 * SECOND)  # red by ITU-R BT.601
    picture = cv2.imdecode(np.frombuffer(stream.read().jpeg, np.uint8), cv2.IMREAD_COLOR)
    assert picture.shape == (120, 160, 3)
    assert np.abs(picture.reshape(-1, 3).mean(axis=0) - (0, 0, 255)).max() < 8


@pytest.mark.parametrize(
    ("device", "said"),
    [
        (FakeVideo(formats=("H264", "NV12")), "offers H264, NV12; known here are MJPG, JPEG, YUYV"),
        (FakeVideo(formats=()), "offers no format"),
        (FakeVideo(size=(176, 144)), "asked for MJPG 160 x 120 the camera gives MJPG 176 x 144"),
    ],
)
def test_camera_that_cannot_give_what_the_robot_file_says_is_refused(device, said):
    with pytest.raises(DriverError, match=said):
        opened(device)


def test_device_file_without_pictures_is_named():
    device = FakeVideo()
    device.capabilities = abi.CAN_STREAM
    with pytest.raises(DriverError, match="'Fake camera' gives no pictures here"):
        opened(device)


def test_focus_is_fixed_from_the_beginning_where_it_stands_and_let_go_at_the_end():
    device = FakeVideo(controls=CONTROLS)
    stream = opened(device)
    assert device.written == [(FOCUS_AUTO, 0), (FOCUS, 30)]
    stream.close()
    assert device.controls == CONTROLS
    assert device.is_closed
    assert not device.is_streaming


def test_exposure_and_white_balance_are_held_where_they_stand_and_released():
    device, hold = FakeVideo(controls=CONTROLS), Hold()
    stream = opened(device, hold=hold)
    device.written.clear()
    hold.is_wanted = True
    for _ in range(2):
        device.fill(jpeg(1), 99 * SECOND)
        stream.read()
    held = [(EXPOSURE_AUTO, 1), (EXPOSURE, 157), (PRIORITY, 0), (WHITE_AUTO, 0), (WHITE, 4600)]
    assert device.written == held
    hold.is_wanted = False
    device.fill(jpeg(1), 99 * SECOND)
    stream.read()
    assert device.written[len(held) :] == [(EXPOSURE_AUTO, 3), (PRIORITY, 1), (WHITE_AUTO, 1)]


def test_what_a_camera_has_by_hand_of_itself_stays_so():
    device = FakeVideo(controls={EXPOSURE_AUTO: 1, EXPOSURE: 80})
    hold = Hold(is_wanted=True)
    stream = opened(device, hold=hold)
    device.fill(jpeg(1), 99 * SECOND)
    stream.read()
    stream.close()
    assert device.written == []


LEFT_BEHIND = CONTROLS | {EXPOSURE_AUTO: 1, PRIORITY: 0, FOCUS_AUTO: 0, WHITE_AUTO: 0}
"""By a program that was killed while it held them."""


def test_what_a_killed_program_held_is_automatic_again():
    device = FakeVideo(controls=LEFT_BEHIND, usual=CONTROLS)
    stream = opened(device)
    assert device.controls == CONTROLS | {FOCUS_AUTO: 0}
    stream.close()
    assert device.controls == CONTROLS


def test_what_a_killed_program_held_stays_where_the_robot_file_keeps_settings():
    device = FakeVideo(controls=LEFT_BEHIND, usual=CONTROLS)
    stream = opened(device, keeps_settings=True)
    stream.close()
    assert device.controls == LEFT_BEHIND
    assert device.written == []


@pytest.mark.parametrize(
    ("number", "kind", "said"),
    [
        (errno.ENOENT, DriverError, "is the camera plugged in"),
        (errno.EACCES, SetupError, "group video"),
        (errno.EBUSY, DriverError, "in use by another program"),
        (errno.ENOMEM, DriverError, "Cannot allocate memory"),
    ],
)
def test_device_that_cannot_be_opened_says_what_to_do(number, kind, said):
    def refuse(path):
        raise OSError(number, os.strerror(number))

    stream = V4l2Stream("/dev/video7", ManualClock(), 0, SIZE, 30.0, Hold(), refuse)
    with pytest.raises(kind, match=said):
        stream.open()
    stream.close()


def test_file_that_is_no_camera_is_refused_and_closed_again():
    stream = V4l2Stream("/dev/null", ManualClock(), 0, SIZE, 30.0, Hold())
    before = open_files()
    with pytest.raises(DriverError, match="not a camera"):
        stream.open()
    stream.close()
    assert open_files() == before


def open_files() -> int:
    return sum(1 for _ in Path("/proc/self/fd").iterdir())


def test_waiting_for_a_device_ends_when_it_is_interrupted():
    reading, writing = os.pipe()
    device = VideoDevice(f"/proc/self/fd/{reading}")
    assert not device.wait(0.0)
    device.interrupt()
    assert device.wait(30.0)
    device.close()
    os.close(reading)
    os.close(writing)


def test_camera_that_is_unplugged_is_told_and_found_again_when_it_is_back():
    async def run():
        devices, clock = [], MonotonicClock()

        def plug(path):
            devices.append(FakeVideo(controls=CONTROLS))
            return devices[-1]

        make = lambda: V4l2Stream("/dev/video0", clock, 0, SIZE, 30.0, Hold(), plug)  # noqa: E731
        seen = Watched(ThreadedCamera(make, SIZE, clock))
        seen.camera.start()
        await seen.until(lambda: devices and devices[0].is_streaming)
        devices[0].fill(jpeg(1), clock.now_ns())
        await seen.until(lambda: seen.frames)
        devices[0].unplug()
        await seen.until(lambda: len(devices) > 1 and devices[1].is_streaming)
        assert devices[0].is_closed
        assert seen.statuses[-1].reason == "/dev/video0: the camera is gone"
        devices[1].fill(jpeg(2), clock.now_ns())
        await seen.until(lambda: len(seen.frames) == 2)
        await seen.camera.close()
        assert devices[1].is_closed
        assert [frame.frame_id for frame in seen.frames] == [1, 2]

    asyncio.run(run())


def test_camera_that_gives_nothing_is_a_stall_in_bounded_time():
    class Slept(FakeVideo):
        def wait(self, timeout_s):
            clock.turn(round(timeout_s * SECOND))
            return False

    clock = ManualClock()
    stream = opened(Slept(), clock)
    began_ns = clock.now_ns()
    with pytest.raises(DriverError, match="no picture for 2 s"):
        stream.read()
    assert clock.now_ns() - began_ns <= 2 * STALL_S * SECOND
