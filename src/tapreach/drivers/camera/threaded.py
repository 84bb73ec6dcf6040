"""A camera read in a thread of its own: newest wins, and what breaks off is opened anew by itself."""

import asyncio
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

from tapreach.drivers.camera.stream import OPEN_S, STALL_S, Hold, Picture, Stream
from tapreach.errors import DriverError, SetupError
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.clock import SECOND, Clock
from tapreach.robot.interface import Listeners, Unsubscribe
from tapreach.robot.messages import Frame

LOST_AFTER_NS = SECOND
"""Without a picture for so long the camera counts as lost (the page says FROZEN after half of it)."""
FIRST_WAIT_S, LONGEST_WAIT_S = 0.25, 4.0


@dataclass(frozen=True, slots=True)
class CameraStatus:
    """Whether pictures come, and the sentence to show when not."""

    is_running: bool
    reason: str = ""


class ThreadedCamera:
    """See FrameSource. `make_stream` is called for each opening; pictures of another size are refused.

    While no pictures come, nothing is told to who subscribed for frames: their age tells, and `status` says
    why. The thread tries again after 0.25 s, 0.5 s, ... 4 s for as long as the camera is not closed.
    """

    def __init__(
        self, make_stream: Callable[[], Stream], size: ImageSize, clock: Clock, hold: Hold | None = None
    ) -> None:
        self._make_stream, self._size, self._clock = make_stream, size, clock
        self._hold = hold or Hold()
        self._holders: set[object] = set()
        self._frames, self._statuses = Listeners(), Listeners()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._thread: threading.Thread | None = None
        self._watch: asyncio.Task[None] | None = None
        self._changed = asyncio.Event()
        self._closing = threading.Event()
        self._lock = threading.Lock()
        self._stream: Stream | None = None
        self._newest: Picture | None = None
        self._skipped = 0
        self._count = 0
        self._seen_ns = 0
        self.status = CameraStatus(False, "the camera has not been opened")

    @property
    def skipped(self) -> int:
        """How many pictures were broken and left out, over all openings."""
        with self._lock:
            return self._skipped + (0 if self._stream is None else self._stream.skipped)

    def subscribe(self, listener: Callable[[Frame], None]) -> Unsubscribe:
        """See FrameSource."""
        return self._frames.subscribe(listener)

    def subscribe_status(self, listener: Callable[[CameraStatus], None]) -> Unsubscribe:
        """Hear whenever pictures begin or cease to come, and why."""
        return self._statuses.subscribe(listener)

    def hold_settings(self) -> Callable[[], None]:
        """See HoldsSettings; a camera whose settings cannot be reached (all but V4L2) goes on as it does."""
        holder = object()
        self._holders.add(holder)
        self._hold.is_wanted = True

        def release() -> None:
            self._holders.discard(holder)
            self._hold.is_wanted = bool(self._holders)

        return release

    async def connect(self, patience_s: float = OPEN_S + STALL_S) -> None:
        """Open the camera and wait for its first picture.

        Raises DriverError or SetupError with what to do, when none has come in `patience_s`; then nothing is
        left running. Who would rather wait for ever calls `start`.
        """
        self.start()
        try:
            async with asyncio.timeout(patience_s):
                while not self.status.is_running:
                    self._changed.clear()
                    await self._changed.wait()
        except TimeoutError:
            reason = self.status.reason
            await self.close()
            raise DriverError(f"no picture within {patience_s:.0f} s: {reason}") from None

    def start(self) -> None:
        """Begin to open the camera, and go on until `close`; in the event loop's thread."""
        if self._thread is not None:
            return
        self._loop = asyncio.get_running_loop()
        self._closing.clear()
        self._set_status(CameraStatus(False, "the camera is being opened"))
        self._thread = threading.Thread(target=self._run, name="camera", daemon=True)
        self._thread.start()
        self._watch = asyncio.create_task(self._watch_age(), name="camera watch")

    async def close(self) -> None:
        """End the thread and let go of the camera; twice does no harm."""
        thread, watch, self._thread, self._watch = self._thread, self._watch, None, None
        self._closing.set()
        with self._lock:
            if self._stream is not None:
                self._stream.interrupt()
        if watch is not None:
            watch.cancel()
            with suppress(asyncio.CancelledError):
                await watch
        if thread is not None:
            await asyncio.to_thread(thread.join)
            self._set_status(CameraStatus(False, "the camera is closed"))

    def _run(self) -> None:
        wait_s = FIRST_WAIT_S
        while not self._closing.is_set():
            got_any, reason = self._one_opening()
            wait_s = FIRST_WAIT_S if got_any else wait_s
            self._call(self._lose, reason)
            self._closing.wait(wait_s)
            wait_s = min(2.0 * wait_s, LONGEST_WAIT_S)

    def _one_opening(self) -> tuple[bool, str]:
        """Read until it breaks off; return whether there were pictures, and why it ended."""
        stream, got_any = self._make_stream(), False
        with self._lock:
            self._stream = stream
        try:
            if not self._closing.is_set():
                stream.open()
            while not self._closing.is_set():
                self._put(self._checked(stream.read()))
                got_any = True
            return got_any, "the camera is closed"
        except (DriverError, SetupError) as error:
            return got_any, str(error)
        finally:
            with self._lock:
                self._stream = None
                self._skipped += stream.skipped
            stream.close()

    def _checked(self, picture: Picture) -> Picture:
        if picture.size != self._size:
            raise DriverError(
                f"the camera sends {picture.size.width} x {picture.size.height}, but the robot file says "
                f"{self._size.width} x {self._size.height}: fx, cx and the like belong to one picture size"
            )
        return picture

    def _put(self, picture: Picture) -> None:
        with self._lock:
            is_first, self._newest = self._newest is None, picture
        if is_first:
            self._call(self._deliver)

    def _call(self, function: Callable[..., None], *arguments: object) -> None:
        assert self._loop is not None
        try:
            self._loop.call_soon_threadsafe(function, *arguments)
        except RuntimeError:  # the loop is closed, nobody listens any more
            self._closing.set()

    def _deliver(self) -> None:
        with self._lock:
            picture, self._newest = self._newest, None
        if picture is None or self._closing.is_set():
            return
        self._count += 1
        self._seen_ns = picture.received_ns
        if not self.status.is_running:
            self._set_status(CameraStatus(True))
        self._frames.tell(
            Frame(self._count, picture.captured_ns, picture.received_ns, picture.size, picture.jpeg)
        )

    def _lose(self, reason: str) -> None:
        if not self._closing.is_set():
            self._set_status(CameraStatus(False, reason))

    def _set_status(self, status: CameraStatus) -> None:
        if status != self.status:
            self.status = status
            self._statuses.tell(status)
        self._changed.set()

    async def _watch_age(self) -> None:
        while True:
            now_ns = self._clock.now_ns()
            if self.status.is_running and now_ns - self._seen_ns >= LOST_AFTER_NS:
                age_ms = (now_ns - self._seen_ns) // 1_000_000
                self._set_status(CameraStatus(False, f"no picture for {age_ms} ms"))
            due_ns = self._seen_ns + LOST_AFTER_NS
            await self._clock.sleep_until(due_ns if due_ns > now_ns else now_ns + LOST_AFTER_NS // 4)
