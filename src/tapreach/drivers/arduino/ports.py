"""An open serial port: reading in a thread of its own, writing that never waits."""

import os
import selectors
from collections.abc import Callable
from contextlib import suppress
from queue import Empty, Full, Queue
from threading import Event, Thread
from typing import Any, Protocol

import serial

from tapreach.robot.link_section import LinkSection

CHUNK = 4096
POLL_S = 0.1
WAITING = 16
"""Writes that may wait for a port without a descriptor; more are dropped: nothing catches up."""
Hear = Callable[[bytes], None]
End = Callable[[BaseException | None], None]


class Port(Protocol):
    """What a link does with an open port."""

    def write(self, data: bytes) -> None:
        """Send now what the port takes now; the rest is dropped."""
        ...

    def close(self) -> None:
        """Let go of it. May take half a second: not for the event loop."""
        ...


OpenPort = Callable[[LinkSection, Hear, End], Port]


def open_port(section: LinkSection, hear: Hear, end: End) -> Port:
    """Open a link's address; blocks, for a thread. Raises serial.SerialException.

    hear and end are called in the reading thread: hear with what came, end once with why no more will come.
    """
    options: dict[str, Any] = {"exclusive": True} if section.is_device else {}
    opened = serial.serial_for_url(section.address, baudrate=section.baud_rate, timeout=POLL_S, **options)
    try:
        fd = opened.fileno()
    except (AttributeError, OSError):  # rfc2217, which decodes what comes in a thread of its own
        return PlainPort(opened, hear, end)
    return DescriptorPort(opened, fd, hear, end)


class DescriptorPort:
    """A device or socket."""

    def __init__(self, opened: Any, fd: int, hear: Hear, end: End) -> None:
        self._opened, self._fd, self._hear, self._end = opened, fd, hear, end
        self._woken, self._wake = os.pipe()
        os.set_blocking(fd, False)
        self._thread = Thread(target=self._read, name=f"reads {opened.port}", daemon=True)
        self._thread.start()

    def write(self, data: bytes) -> None:
        """See Port. A frame that is cut short is dropped by the board, and moves nothing."""
        try:
            os.write(self._fd, data)
        except BlockingIOError:
            return
        except OSError as error:
            self._end(error)

    def close(self) -> None:
        """See Port."""
        os.write(self._wake, b"x")
        self._thread.join()
        _close(self._opened)
        os.close(self._wake)
        os.close(self._woken)

    def _read(self) -> None:
        with selectors.DefaultSelector() as selector:
            selector.register(self._fd, selectors.EVENT_READ)
            selector.register(self._woken, selectors.EVENT_READ)
            while all(key.fd != self._woken for key, _ in selector.select()):
                try:
                    data = os.read(self._fd, CHUNK)
                except BlockingIOError:
                    continue
                except OSError as error:
                    return self._end(error)
                if not data:
                    return self._end(None)
                self._hear(data)
        return None


class PlainPort:
    """A port that only pyserial can read and write."""

    def __init__(self, opened: Any, hear: Hear, end: End) -> None:
        self._opened, self._hear, self._end = opened, hear, end
        self._closing = Event()
        self._waiting: Queue[bytes] = Queue(WAITING)
        self._threads = [Thread(target=work, daemon=True) for work in (self._read, self._write)]
        for thread in self._threads:
            thread.start()

    def write(self, data: bytes) -> None:
        """See Port."""
        with suppress(Full):
            self._waiting.put_nowait(data)

    def close(self) -> None:
        """See Port."""
        self._closing.set()
        for thread in self._threads:
            thread.join()
        _close(self._opened)

    def _read(self) -> None:
        while not self._closing.is_set():
            try:
                data = self._opened.read(1)
                data += self._opened.read(self._opened.in_waiting)
            except (serial.SerialException, OSError) as error:
                return self._end(error)
            if data:
                self._hear(data)
        return None

    def _write(self) -> None:
        while not self._closing.is_set():
            try:
                self._opened.write(self._waiting.get(timeout=POLL_S))
            except Empty:
                continue
            except (serial.SerialException, OSError) as error:
                return self._end(error)
        return None


def _close(opened: Any) -> None:
    beneath = getattr(opened, "_socket", None)
    with suppress(OSError, serial.SerialException):  # what is gone already need not be closed
        opened.close()
    if beneath is not None:
        beneath.close()  # pyserial forgets to when the other side has closed first
