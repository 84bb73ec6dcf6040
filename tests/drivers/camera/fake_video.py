"""A video device made of answers as the kernel's documentation describes them; no hardware behind it."""

import errno
import os
import threading
from ctypes import Structure

from tapreach.drivers.camera import v4l2_abi as abi


class FakeVideo:
    """See Device. `fill` puts a picture into the oldest empty buffer, as a driver does."""

    def __init__(self, formats=("YUYV", "MJPG"), size=(160, 120), controls=None, usual=None) -> None:
        self.formats, self.size = formats, size
        self.controls = dict(controls or {})
        self.usual = dict(self.controls if usual is None else usual)
        self.capabilities = abi.CAN_CAPTURE | abi.CAN_STREAM
        self.buffers: list[bytearray] = []
        self.empty: list[int] = []
        self.filled: list[tuple[int, int, int, int]] = []
        self.is_streaming = self.is_closed = self.is_gone = False
        self.rate = (0, 0)
        self.written: list[tuple[int, int]] = []
        self._ready = threading.Event()
        self._answers = {
            abi.QUERYCAP: self._querycap, abi.ENUM_FMT: self._enum, abi.S_FMT: self._s_fmt,
            abi.S_PARM: self._s_parm, abi.REQBUFS: self._reqbufs, abi.QUERYBUF: self._querybuf,
            abi.QBUF: self._qbuf, abi.DQBUF: self._dqbuf, abi.STREAMON: self._streamon,
            abi.STREAMOFF: self._streamoff, abi.QUERYCTRL: self._queryctrl, abi.G_CTRL: self._g_ctrl,
            abi.S_CTRL: self._s_ctrl,
        }  # fmt: skip

    def ioctl(self, request: int, argument: Structure) -> None:
        if self.is_gone:
            raise _error(errno.ENODEV)
        self._answers[request](argument)

    def map(self, offset: int, length: int) -> bytearray:
        buffer = self.buffers[offset // 4096]
        assert len(buffer) == length
        return buffer

    def wait(self, timeout_s: float) -> bool:
        return self._ready.wait(timeout_s)

    def interrupt(self) -> None:
        self._ready.set()

    def close(self) -> None:
        self.is_closed = True

    def fill(self, data: bytes, stamp_ns: int, flags: int = abi.STAMP_MONOTONIC) -> None:
        assert self.is_streaming
        index = self.empty.pop(0)
        self.buffers[index][: len(data)] = data
        self.filled.append((index, len(data), stamp_ns, flags))
        self._ready.set()

    def unplug(self) -> None:
        self.is_gone = True
        self._ready.set()

    def _querycap(self, it) -> None:
        it.card, it.capabilities = b"Fake camera", self.capabilities | 0x04200000 | abi.HAS_DEVICE_CAPS
        it.device_caps = self.capabilities

    def _enum(self, it) -> None:
        if it.index >= len(self.formats):
            raise _error(errno.EINVAL)
        it.pixelformat = abi.fourcc(self.formats[it.index])

    def _s_fmt(self, it) -> None:
        if self.is_streaming:
            raise _error(errno.EBUSY)
        it.width, it.height = self.size
        it.sizeimage = it.width * it.height * 2

    def _s_parm(self, it) -> None:
        self.rate = (it.numerator, it.denominator)

    def _reqbufs(self, it) -> None:
        it.count = min(it.count, 3)
        self.buffers = [bytearray(self.size[0] * self.size[1] * 2) for _ in range(it.count)]

    def _querybuf(self, it) -> None:
        it.offset, it.length = it.index * 4096, len(self.buffers[it.index])

    def _qbuf(self, it) -> None:
        assert it.index not in self.empty
        self.empty.append(it.index)

    def _dqbuf(self, it) -> None:
        if not self.filled:
            self._ready.clear()
            raise _error(errno.EAGAIN)
        it.index, it.bytesused, stamp_ns, it.flags = self.filled.pop(0)
        it.seconds, it.microseconds = stamp_ns // 10**9, stamp_ns % 10**9 // 1000

    def _streamon(self, it) -> None:
        assert it.type == abi.CAPTURE
        self.is_streaming = True

    def _streamoff(self, it) -> None:
        self.is_streaming = False

    def _queryctrl(self, it) -> None:
        if it.id not in self.controls:
            raise _error(errno.EINVAL)
        it.default_value = self.usual[it.id]

    def _g_ctrl(self, it) -> None:
        it.value = self.controls[it.id]

    def _s_ctrl(self, it) -> None:
        if it.id not in self.controls:
            raise _error(errno.EINVAL)
        self.written.append((it.id, it.value))
        self.controls[it.id] = it.value


def _error(number: int) -> OSError:
    return OSError(number, os.strerror(number))
