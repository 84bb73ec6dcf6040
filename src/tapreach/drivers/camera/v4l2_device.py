"""A video device file: ioctl, mapped buffers, and waiting that can be ended from another thread."""

import fcntl
import mmap
import os
import select
from contextlib import suppress
from ctypes import Structure
from typing import Protocol


class Device(Protocol):
    """What the stream needs of a device; tests hand in one that is made of recorded answers."""

    def ioctl(self, request: int, argument: Structure) -> None:
        """Ask the driver; `argument` is changed in place. Raises OSError."""
        ...

    def map(self, offset: int, length: int) -> "mmap.mmap | bytearray":
        """Return the memory of a buffer."""
        ...

    def wait(self, timeout_s: float) -> bool:
        """Return True as soon as a picture is there or `interrupt` was called, False when time is over."""
        ...

    def interrupt(self) -> None:
        """From any thread: end `wait`."""
        ...

    def close(self) -> None:
        """Let go of the device and of its mapped memory."""
        ...


class VideoDevice:
    """See Device: a character device as /dev/video0. Opens at once; raises OSError."""

    def __init__(self, path: str) -> None:
        self._file = os.open(path, os.O_RDWR | os.O_NONBLOCK | os.O_CLOEXEC)
        self._wake = os.eventfd(0, os.EFD_CLOEXEC | os.EFD_NONBLOCK)
        self._poll = select.poll()
        self._poll.register(self._file, select.POLLIN)
        self._poll.register(self._wake, select.POLLIN)
        self._maps: list[mmap.mmap] = []

    def ioctl(self, request: int, argument: Structure) -> None:
        """See Device."""
        fcntl.ioctl(self._file, request, argument)

    def map(self, offset: int, length: int) -> mmap.mmap:
        """See Device."""
        mapped = mmap.mmap(
            self._file, length, mmap.MAP_SHARED, mmap.PROT_READ | mmap.PROT_WRITE, offset=offset
        )
        self._maps.append(mapped)
        return mapped

    def wait(self, timeout_s: float) -> bool:
        """See Device. An unplugged camera ends it too: what is asked next raises."""
        return bool(self._poll.poll(round(timeout_s * 1000)))

    def interrupt(self) -> None:
        """See Device."""
        with suppress(OSError):
            os.eventfd_write(self._wake, 1)

    def close(self) -> None:
        """See Device."""
        for mapped in self._maps:
            mapped.close()
        os.close(self._file)
        os.close(self._wake)
