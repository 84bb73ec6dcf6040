"""A viewer in Python: receives frames, acknowledges each at once, writes down when it came."""

import asyncio
import json
import struct
from dataclasses import dataclass, field

from websockets.asyncio.client import ClientConnection, connect

from tapreach.errors import InputError
from tapreach.robot.clock import MS, SECOND, Clock

_HEADER = struct.Struct("<4sIQQHHI")
_MAGIC = b"TRV1"


@dataclass(frozen=True, slots=True)
class Arrival:
    """One frame at a viewer."""

    frame_id: int
    captured_ns: int
    received_ns: int
    width: int
    size_bytes: int

    @property
    def age_ms(self) -> float:
        """From capture to reception [ms]; both ends are on the same clock."""
        return (self.received_ns - self.captured_ns) / MS


def parse_frame(message: bytes, received_ns: int) -> Arrival:
    """Read the header of a video message. Raises InputError for anything else."""
    if len(message) < _HEADER.size or not message.startswith(_MAGIC):
        raise InputError(f"not a video message: begins with {message[:4]!r}, expected {_MAGIC!r}")
    _, frame_id, captured_ns, _, width, _, meta_length = _HEADER.unpack_from(message)
    return Arrival(frame_id, captured_ns, received_ns, width, len(message) - _HEADER.size - meta_length)


@dataclass
class Viewing:
    """What a viewer has seen so far."""

    arrivals: list[Arrival] = field(default_factory=list)
    first: asyncio.Event = field(default_factory=asyncio.Event)

    @property
    def ages_ms(self) -> list[float]:
        """The age of every frame on arrival [ms]."""
        return [arrival.age_ms for arrival in self.arrivals]

    @property
    def rate_hz(self) -> float:
        """Frames per second between the first and the last; 0 for fewer than two."""
        if len(self.arrivals) < 2:
            return 0.0
        duration_ns = self.arrivals[-1].received_ns - self.arrivals[0].received_ns
        return (len(self.arrivals) - 1) * SECOND / duration_ns

    @property
    def captured_ns(self) -> dict[int, int]:
        """When each frame was captured, by its id."""
        return {arrival.frame_id: arrival.captured_ns for arrival in self.arrivals}

    def since(self, begin_ns: int) -> "Viewing":
        """Return only what arrived at or after `begin_ns`."""
        return Viewing([arrival for arrival in self.arrivals if arrival.received_ns >= begin_ns])


async def view(port: int, viewing: Viewing, clock: Clock) -> None:
    """Watch the video on loopback `port` until cancelled, adding to `viewing`."""
    address = f"ws://127.0.0.1:{port}/ws/video"
    async with connect(address, compression=None, max_size=None, max_queue=2) as socket:
        async for message in socket:
            received_ns = clock.now_ns()
            if isinstance(message, str):
                await _echo_probe(socket, message)
            else:
                arrival = parse_frame(message, received_ns)
                await socket.send(json.dumps({"ack": arrival.frame_id}))
                viewing.arrivals.append(arrival)
                viewing.first.set()


async def _echo_probe(socket: ClientConnection, text: str) -> None:
    # The server measures the empty link's round trip with a small message that is to be sent back at once.
    if "probe" in json.loads(text):
        await socket.send(text)


async def view_many(
    ports: list[int], seconds: float, clock: Clock, settle_seconds: float = 1.0
) -> list[Viewing]:
    """Watch with one viewer per entry of `ports` at once; return what came after the settling time."""
    viewings = [Viewing() for _ in ports]
    tasks = [
        asyncio.create_task(view(port, viewing, clock)) for port, viewing in zip(ports, viewings, strict=True)
    ]
    try:
        await _for_duration(tasks, settle_seconds, clock)
        begin_ns = clock.now_ns()
        await _for_duration(tasks, seconds, clock)
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
    return [viewing.since(begin_ns) for viewing in viewings]


async def _for_duration(tasks: list[asyncio.Task[None]], seconds: float, clock: Clock) -> None:
    # A viewer that ends early has failed: its error is the bench's error.
    timer = asyncio.create_task(clock.sleep_until(clock.now_ns() + round(seconds * SECOND)))
    done, _ = await asyncio.wait([timer, *tasks], return_when=asyncio.FIRST_COMPLETED)
    timer.cancel()
    for task in done - {timer}:
        task.result()
        raise InputError("the server closed the video socket in the middle of the measurement")
