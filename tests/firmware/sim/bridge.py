"""The simulated board at a device path or a TCP port, so that the product's own driver talks to it.

In real time a thread keeps the simulation up with the machine's clock; in lock step it moves by `turn` alone.
"""

import os
import pty
import select
import socket
import threading
import time
import tty

from tests.firmware.sim.rover import Rover

TICK_US = 2_000.0
LONGEST_LAG_S = 20.0


class Pty:
    """The end of a pseudo-terminal that is the board; `url` is what a driver opens."""

    def __init__(self) -> None:
        self._ours, self._theirs = pty.openpty()
        tty.setraw(self._ours)
        tty.setraw(self._theirs)
        os.set_blocking(self._ours, False)
        self.url = os.ttyname(self._theirs)

    def read(self) -> bytes:
        try:
            return os.read(self._ours, 4096)
        except (BlockingIOError, OSError):
            return b""

    def write(self, data: bytes) -> None:
        try:
            os.write(self._ours, data)
        except OSError:  # nobody reads, and the line is full: a UART loses it too
            return

    def close(self) -> None:
        os.close(self._ours)
        os.close(self._theirs)


class Tcp:
    """A serial server of one client at a time, on loopback."""

    def __init__(self, port: int = 0) -> None:
        self._server = socket.create_server(("127.0.0.1", port))
        self._server.setblocking(False)
        self._client: socket.socket | None = None
        self.port = self._server.getsockname()[1]
        self.url = f"socket://127.0.0.1:{self.port}"

    def read(self) -> bytes:
        if self._client is None and not self._accepted():
            return b""
        readable, _, _ = select.select([self._client], [], [], 0)
        if not readable:
            return b""
        try:
            data = self._client.recv(4096)
        except OSError:
            data = b""
        if not data:
            self.hang_up()
        return data

    def _accepted(self) -> bool:
        try:
            self._client, _ = self._server.accept()
        except BlockingIOError:
            return False
        self._client.setblocking(False)
        self._client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return True

    def write(self, data: bytes) -> None:
        if self._client is None:
            return
        try:
            self._client.send(data)
        except OSError:
            self.hang_up()

    def hang_up(self) -> None:
        if self._client is not None:
            self._client.close()
            self._client = None

    def close(self) -> None:
        self.hang_up()
        self._server.close()


class Bridge:
    """Joins a rover to a line. `turn` is a step in lock step; `with bridge:` runs it in real time."""

    def __init__(self, rover: Rover, line: Pty | Tcp) -> None:
        self.rover, self.line = rover, line
        self.is_plugged = True
        self.late_ticks = 0
        self.worst_lag_s = 0.0
        """By how much the board's time was behind the machine's at most."""
        self.failure: BaseException | None = None
        self.lock = threading.Lock()
        """Hold it to look at the rover while it runs in real time."""
        self._ending = threading.Event()
        self._thread: threading.Thread | None = None

    @property
    def url(self) -> str:
        return self.line.url

    def turn(self, us: float = TICK_US) -> None:
        """Move simulated time on; bytes pass at its beginning and at its end."""
        arrived = self.line.read()
        if self.is_plugged:
            self.rover.avr.send(arrived)
        self.rover.run(us)
        leaving = self.rover.avr.receive()
        if self.is_plugged and leaving:
            self.line.write(leaving)

    def unplug(self) -> None:
        """Cut the cable: what is sent is lost, on both sides."""
        self.is_plugged = False
        self.rover.avr.unplug()

    def plug(self) -> None:
        self.is_plugged = True

    def __enter__(self) -> "Bridge":
        self._thread = threading.Thread(target=self._keep_up, daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ending.set()
        self._thread.join(5.0)
        self.line.close()
        if self.failure is not None:
            raise self.failure

    def _keep_up(self) -> None:
        due = time.monotonic()
        try:
            while not self._ending.is_set():
                with self.lock:
                    self.turn()
                due = self._wait(due + TICK_US / 1e6)
        except BaseException as failure:
            self.failure = failure

    def _wait(self, due: float) -> float:
        spare = due - time.monotonic()
        if spare > 0:
            self._ending.wait(spare)
            return due
        self.late_ticks += 1
        self.worst_lag_s = max(self.worst_lag_s, -spare)
        # It catches up, so that its clock goes as ours; but after a pause it never was there either.
        return due if spare > -LONGEST_LAG_S else time.monotonic()
