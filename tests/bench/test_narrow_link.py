import asyncio

from tapreach.bench.narrow_link import narrow_link
from tapreach.robot.clock import SECOND, MonotonicClock

CLOCK = MonotonicClock()


async def fetch(payload: bytes, bytes_per_second: float) -> tuple[bytes, float]:
    async def serve(reader, writer):
        await reader.readline()
        writer.write(payload)
        await writer.drain()
        writer.close()

    server = await asyncio.start_server(serve, "127.0.0.1", 0)
    target = server.sockets[0].getsockname()[1]
    async with server, narrow_link(target, bytes_per_second, CLOCK) as port:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        begin_ns = CLOCK.now_ns()
        writer.write(b"please\n")
        received = await reader.read(-1)
        writer.close()
        return received, (CLOCK.now_ns() - begin_ns) / SECOND


def test_everything_arrives_and_no_faster_than_the_link():
    payload = bytes(range(256)) * 400
    received, seconds = asyncio.run(fetch(payload, 400_000))
    assert received == payload
    assert seconds >= len(payload) / 400_000


def test_sender_feels_the_link_instead_of_filling_a_buffer():
    # The sender offers 4 MB; after 0.3 s at 100 kB/s it may be ahead by the kernel's buffers, not by all.
    offered = 0

    async def measure() -> int:
        nonlocal offered

        async def serve(reader, writer):
            nonlocal offered
            await reader.readline()
            writer.transport.set_write_buffer_limits(high=0)
            while offered < 4_000_000:
                writer.write(bytes(10_000))
                await writer.drain()
                offered += 10_000

        server = await asyncio.start_server(serve, "127.0.0.1", 0)
        target = server.sockets[0].getsockname()[1]
        async with server, narrow_link(target, 100_000, CLOCK) as port:
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            writer.write(b"please\n")
            received = 0
            while received < 30_000:
                received += len(await reader.read(4096))
            writer.close()
            return received

    asyncio.run(measure())
    assert offered < 4_000_000
