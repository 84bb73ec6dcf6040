import asyncio
import os
import signal
import sys

import pytest

from tapreach.bench.child import started
from tapreach.bench.proc import identify, is_alive
from tapreach.errors import SetupError


def test_child_that_ends_at_once_is_an_error_and_not_a_wait():
    async def begin():
        async with started("tapreach.bench.mjpeg_peer", "not a width"):
            pass

    with pytest.raises(SetupError, match="ended before it was ready"):
        asyncio.run(begin())


def test_child_ends_with_the_block():
    async def serve():
        async with started("tapreach.bench.mjpeg_peer", 160, 120, 30, 1) as child:
            return identify(child.pid), child.port

    who, port = asyncio.run(serve())
    assert port > 0
    assert not is_alive(who)


def test_child_ends_when_its_parent_is_killed():
    script = (
        "import asyncio, sys\n"
        "from tapreach.bench.child import started\n"
        "async def main():\n"
        "    async with started('tapreach.bench.mjpeg_peer', 160, 120, 30, 1) as child:\n"
        "        print(child.pid, flush=True)\n"
        "        await asyncio.sleep(60)\n"
        "asyncio.run(main())\n"
    )

    async def kill_parent():
        parent = await asyncio.create_subprocess_exec(sys.executable, "-c", script, stdout=-1)
        child = identify(int(await parent.stdout.readline()))
        parent.send_signal(signal.SIGKILL)
        await parent.wait()
        fd = os.pidfd_open(child.pid) if is_alive(child) else None
        if fd is not None:
            gone = asyncio.Event()
            asyncio.get_running_loop().add_reader(fd, gone.set)
            await asyncio.wait_for(gone.wait(), 30)
            asyncio.get_running_loop().remove_reader(fd)
            os.close(fd)
        return is_alive(child)

    assert asyncio.run(kill_parent()) is False
