"""An operator in Python: says hello, takes the lease, drives; every answer comes back with its round trip."""

import asyncio
import contextlib
import json
from collections.abc import AsyncIterator
from dataclasses import dataclass
from typing import Any

from websockets.asyncio.client import ClientConnection, connect

from tapreach.errors import TapreachError
from tapreach.robot.clock import MS, Clock
from tapreach.robot.messages import Twist

_ANSWERS = ("ack", "pong", "welcome")


@dataclass(frozen=True, slots=True)
class Answer:
    """What the server said to one message."""

    body: dict[str, Any]
    sent_ns: int
    received_ns: int

    @property
    def round_trip_ms(self) -> float:
        """From sending to the answer [ms]."""
        return (self.received_ns - self.sent_ns) / MS

    @property
    def is_ok(self) -> bool:
        """False where the request was refused."""
        return bool(self.body.get("ok", True))


class ControlClient:
    """One session. Messages are numbered here; states and targets are kept as the newest of each type."""

    def __init__(self, connection: ClientConnection, clock: Clock) -> None:
        self._connection = connection
        self._clock = clock
        self._seq = 0
        self._waiting: dict[int, asyncio.Future[Answer]] = {}
        self._sent_ns: dict[int, int] = {}
        self.newest: dict[str, dict[str, Any]] = {}

    async def listen(self) -> None:
        """Read until the socket closes."""
        async for message in self._connection:
            received_ns = self._clock.now_ns()
            body: dict[str, Any] = json.loads(message)
            if body["type"] in _ANSWERS and body["seq"] in self._waiting:
                seq = body["seq"]
                self._waiting.pop(seq).set_result(Answer(body, self._sent_ns.pop(seq), received_ns))
            else:
                self.newest[body["type"]] = body

    async def ask(self, kind: str, **fields: object) -> Answer:
        """Send a message and return its answer."""
        self._seq += 1
        seq = self._seq
        self._waiting[seq] = asyncio.get_running_loop().create_future()
        self._sent_ns[seq] = self._clock.now_ns()
        await self._connection.send(json.dumps({"type": kind, "seq": seq, **fields}))
        return await self._waiting[seq]

    async def drive(self, twist: Twist, frame_id: int | None, late_ms: float = 0.0) -> Answer:
        """Send a drive message that was made `late_ms` ago."""
        client_ms = self._clock.now_ns() / MS - late_ms
        return await self.ask(
            "drive", client_ms=client_ms, frame_id=frame_id, linear=twist.linear, angular=twist.angular
        )

    async def heartbeat(self, frame_id: int | None) -> Answer:
        """Show to be there."""
        return await self.ask("heartbeat", client_ms=self._clock.now_ns() / MS, frame_id=frame_id)


@contextlib.asynccontextmanager
async def operator(port: int, clock: Clock) -> AsyncIterator[ControlClient]:
    """Yield a session that holds the lease. Raises TapreachError when it is not granted."""
    address = f"ws://127.0.0.1:{port}/ws/control"
    async with connect(address, compression=None) as connection:
        client = ControlClient(connection, clock)
        listening = asyncio.create_task(client.listen())
        try:
            await client.ask("hello", name="bench")
            granted = await client.ask("lease_request")
            if not granted.is_ok:
                raise TapreachError(f"the lease was not granted: {granted.body['reason']}")
            yield client
        finally:
            listening.cancel()
            await asyncio.gather(listening, return_exceptions=True)
