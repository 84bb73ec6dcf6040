"""A USB camera by V4L2: four mapped buffers, the newest picture, the driver's own time stamps.

FFmpeg's v4l2 input waits for pictures without a bound and keeps the time stamps' kind to itself, and the
Python packages for V4L2 are under the GPL; so the few calls that it takes are made here.
"""

import errno
import mmap
from collections.abc import Callable
from contextlib import suppress

from tapreach.drivers.camera.jpeg import BrokenJpeg
from tapreach.drivers.camera.stream import STALL_S, Hold, Picture
from tapreach.drivers.camera.v4l2_abi import (
    BUFFER_ERROR,
    CAPTURE,
    DQBUF,
    MMAP,
    QBUF,
    QUERYBUF,
    REQBUFS,
    STAMP_MASK,
    STAMP_MONOTONIC,
    STREAMOFF,
    STREAMON,
    Buffer,
    BufferType,
    RequestBuffers,
)
from tapreach.drivers.camera.v4l2_controls import FOCUS, VARYING, HeldControls, switch_on
from tapreach.drivers.camera.v4l2_device import Device, VideoDevice
from tapreach.drivers.camera.v4l2_format import as_jpeg, choose_format
from tapreach.errors import DriverError, SetupError
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.clock import SECOND, Clock

BUFFERS = 4
OLDEST_STAMP_NS = 60 * SECOND
ADVICE = {
    errno.ENOENT: "no such device: is the camera plugged in? `ls /dev/v4l/by-id` shows what there is",
    errno.ENODEV: "the camera is gone",
    errno.EACCES: "not allowed: add the user to the group video",
    errno.EBUSY: "in use by another program",
    errno.ENOTTY: "not a camera",
}


class V4l2Stream:
    """See Stream. A picture was taken `delay_ns` before the driver's monotonic stamp, where it gives one.

    The focus is fixed as long as the stream is open, since the focal length changes with it; exposure, gain
    and white balance while `hold.is_wanted`. With `keeps_settings` what was set by hand stays so; else
    what the camera has automatic of itself is switched on at opening.
    """

    def __init__(
        self,
        path: str,
        clock: Clock,
        delay_ns: int,
        size: ImageSize,
        rate_hz: float,
        hold: Hold,
        open_device: Callable[[str], Device] = VideoDevice,
        keeps_settings: bool = False,
    ) -> None:
        self._path, self._clock, self._delay_ns = path, clock, delay_ns
        self._size, self._rate_hz, self._hold = size, rate_hz, hold
        self._open_device, self._keeps_settings = open_device, keeps_settings
        self._device: Device | None = None
        self._memory: list[mmap.mmap | bytearray] = []
        self._format = ""
        self._focus: HeldControls | None = None
        self._held: HeldControls | None = None
        self._is_interrupted = False
        self.skipped = 0

    def open(self) -> None:
        """See Stream."""
        try:
            self._device = self._open_device(self._path)
            self._format = choose_format(self._device, self._size, self._rate_hz)
            if not self._keeps_settings:
                switch_on(self._device, (FOCUS, *VARYING))
            self._focus = HeldControls(self._device)
            self._focus.hold(FOCUS)
            self._begin(self._device)
        except OSError as error:
            raise self._said(error) from None

    def read(self) -> Picture:
        """See Stream."""
        assert self._device is not None
        end_ns = self._clock.now_ns() + round(STALL_S * SECOND)
        try:
            self._follow_hold(self._device)
            while not self._is_interrupted and (left_ns := end_ns - self._clock.now_ns()) > 0:
                if (
                    self._device.wait(left_ns / SECOND)
                    and (picture := self._newest(self._device)) is not None
                ):
                    return picture
        except OSError as error:
            raise self._said(error) from None
        raise DriverError(f"{self._path} has given no picture for {STALL_S:.0f} s")

    def interrupt(self) -> None:
        """See Stream."""
        self._is_interrupted = True
        if self._device is not None:
            self._device.interrupt()

    def close(self) -> None:
        """See Stream."""
        device, self._device = self._device, None
        if device is None:
            return
        for held in (self._held, self._focus):
            if held is not None:
                held.release()
        with suppress(OSError):
            device.ioctl(STREAMOFF, BufferType(CAPTURE))
        self._memory.clear()
        device.close()

    def _begin(self, device: Device) -> None:
        wish = RequestBuffers(count=BUFFERS, type=CAPTURE, memory=MMAP)
        device.ioctl(REQBUFS, wish)
        if wish.count < 2:
            raise DriverError(f"{self._path} gives {wish.count} buffers; it takes 2 or more")
        for index in range(wish.count):
            buffer = Buffer(index=index, type=CAPTURE, memory=MMAP)
            device.ioctl(QUERYBUF, buffer)
            # The union holds an offset of 32 bits for mapped buffers.
            self._memory.append(device.map(buffer.offset & 0xFFFFFFFF, buffer.length))
            device.ioctl(QBUF, buffer)
        device.ioctl(STREAMON, BufferType(CAPTURE))

    def _newest(self, device: Device) -> Picture | None:
        """Take all filled buffers and return the last whole picture in them."""
        newest: Picture | None = None
        for _ in range(len(self._memory)):
            buffer = Buffer(type=CAPTURE, memory=MMAP)
            try:
                device.ioctl(DQBUF, buffer)
            except BlockingIOError:
                break
            now_ns = self._clock.now_ns()
            data = bytes(self._memory[buffer.index][: buffer.bytesused])
            flags, stamp_ns = buffer.flags, buffer.seconds * SECOND + buffer.microseconds * 1000
            device.ioctl(QBUF, buffer)
            newest = self._picture(data, flags, stamp_ns, now_ns) or newest
        return newest

    def _picture(self, data: bytes, flags: int, stamp_ns: int, now_ns: int) -> Picture | None:
        try:
            if flags & BUFFER_ERROR:
                raise BrokenJpeg("the driver says so")
            jpeg, size = as_jpeg(data, self._format, self._size)
        except BrokenJpeg:
            self.skipped += 1
            return None
        is_stamped = flags & STAMP_MASK == STAMP_MONOTONIC and 0 <= now_ns - stamp_ns < OLDEST_STAMP_NS
        return Picture((stamp_ns if is_stamped else now_ns) - self._delay_ns, now_ns, size, jpeg)

    def _follow_hold(self, device: Device) -> None:
        if self._hold.is_wanted and self._held is None:
            self._held = HeldControls(device)
            for automatic in VARYING:
                self._held.hold(automatic)
        elif not self._hold.is_wanted and self._held is not None:
            self._held.release()
            self._held = None

    def _said(self, error: OSError) -> DriverError | SetupError:
        advice = ADVICE.get(error.errno or 0, error.strerror or repr(error))
        kind = SetupError if error.errno == errno.EACCES else DriverError
        return kind(f"{self._path}: {advice}")
