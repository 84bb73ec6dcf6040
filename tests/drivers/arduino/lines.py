"""Real lines to a peer: a pseudo-terminal that can be unplugged, and a TCP server."""

import asyncio
import os
import tty
from contextlib import suppress
from pathlib import Path
from typing import Any

STEP_S = 0.004


class PtyLine:
    """A pseudo-terminal under a name that stays, as below /dev/serial/by-id/."""

    def __init__(self, board: Any, path: Path) -> None:
        self._board, self.path = board, path
        self._master: int | None = None
        self._steps: asyncio.Task[None] | None = None
        self._slave: int | None = None

    @property
    def address(self) -> str:
        return str(self.path)

    async def open(self) -> None:
        self.plug()
        self._steps = asyncio.create_task(_step(self._board))

    async def close(self) -> None:
        if self._steps is not None:
            self._steps.cancel()
            with suppress(asyncio.CancelledError):
                await self._steps
        self.unplug()

    def plug(self) -> None:
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self.path.unlink(missing_ok=True)
        self.path.symlink_to(os.ttyname(self._slave))
        asyncio.get_running_loop().add_reader(self._master, self._read)
        self._board.write = self.write

    def unplug(self) -> None:
        if self._master is None:
            return
        asyncio.get_running_loop().remove_reader(self._master)
        self._board.write = lambda data: None
        self.path.unlink(missing_ok=True)
        os.close(self._slave)
        os.close(self._master)
        self._master = None

    def write(self, data: bytes) -> None:
        with suppress(BlockingIOError):
            os.write(self._master, data)

    def _read(self) -> None:
        with suppress(BlockingIOError, OSError):
            self._board.take(os.read(self._master, 4096))


class TcpLine:
    """A serial server: one client, bytes as they are."""

    def __init__(self, board: Any) -> None:
        self._board = board
        self._server: asyncio.Server | None = None
        self._writers: list[asyncio.StreamWriter] = []
        self._steps: asyncio.Task[None] | None = None
        self.port = 0

    @property
    def address(self) -> str:
        return f"socket://127.0.0.1:{self.port}"

    async def open(self) -> None:
        self._server = await asyncio.start_server(self._serve, "127.0.0.1", self.port)
        self.port = self._server.sockets[0].getsockname()[1]
        self._steps = asyncio.create_task(_step(self._board))

    async def close(self) -> None:
        assert self._server is not None and self._steps is not None
        self._server.close()
        self.hang_up()
        self._steps.cancel()
        with suppress(asyncio.CancelledError):
            await self._steps

    def hang_up(self) -> None:
        for writer in self._writers:
            writer.close()
        self._writers.clear()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._writers.append(writer)
        self._board.write = writer.write
        with suppress(ConnectionError):
            while data := await reader.read(4096):
                self._board.take(data)
        self._board.write = lambda data: None
        writer.close()


async def _step(board: Any) -> None:
    while True:
        board.step()
        await asyncio.sleep(STEP_S)
