"""A script is there while it is there: 20 heartbeats a second, none made up, none for a script that hangs."""

import asyncio
import contextlib
import json

import pytest
from websockets.asyncio.server import serve

from tapreach.client.address import ServerAddress
from tapreach.client.control_link import open_link
from tapreach.client.presence import Presence
from tapreach.client.remote_robot import connect
from tapreach.errors import SetupError, TapreachError
from tapreach.robot.clock import MS, SECOND, ManualClock

TIMEOUT_NS = 200 * MS


def test_script_is_present_as_long_as_it_is_connected(play, script):
    async def scenario(here):
        async with script(here) as it:
            for _ in range(100):
                await it.turn(20 * MS)
                assert here.station.deadman.is_alive

    play(scenario)


def test_script_that_attends_by_itself_is_present_only_then(play, script):
    async def scenario(here):
        async with script(here, is_attended=False) as it:
            assert not here.station.deadman.is_alive
            async with it.robot.presence.attended():
                await it.turn(SECOND)
                assert here.station.deadman.is_alive
            await it.turn(TIMEOUT_NS)
            assert not here.station.deadman.is_alive

    play(scenario)


def test_fetch_ends_when_the_script_is_not_there_any_more(play, script):
    async def scenario(here):
        async with script(here, is_attended=False) as it:
            async with it.robot.presence.attended():
                fetching = await it.fetching()
            result = await it.turned(fetching.result())
            assert (result.status, result.reason) == ("stopped", "operator not heard for 200 ms")

    play(scenario)


def test_heartbeats_come_twenty_times_a_second_and_not_at_once_after_a_hang():
    async def scenario(heard, address, clock):
        async with open_link(address, clock) as link:
            presence = Presence(link)
            async with presence.attended():
                beating = asyncio.create_task(presence.beat())
                assert await beats(heard, link, clock, SECOND) == pytest.approx(20, abs=2)
                clock.turn(2 * SECOND)
                assert await beats(heard, link, clock, 100 * MS) <= 3
                sent_ms = [each["client_ms"] for each in heard if each["type"] == "heartbeat"]
                assert sent_ms == sorted(sent_ms)
                beating.cancel()
                await asyncio.gather(beating, return_exceptions=True)

    against(scenario)


def test_server_of_another_version_is_named():
    async def scenario(heard, address, clock):
        with pytest.raises(SetupError, match="version 99"):
            async with connect(address.page, clock=clock):
                raise AssertionError("it must not be driven")

    against(scenario)


def test_server_that_talks_nonsense_ends_the_link_with_a_sentence():
    async def scenario(heard, address, clock):
        async with open_link(address, clock) as link:
            with pytest.raises(TapreachError, match="cannot be read"):
                await link.ask("nonsense")

    against(scenario)


async def beats(heard, link, clock, duration_ns):
    """How many heartbeats arrive while the clock is turned."""
    before = len(heard)
    for _ in range(duration_ns // (10 * MS)):
        await clock.advance(10 * MS)
        await link.ask("turned")
    return sum(each["type"] == "heartbeat" for each in heard[before:])


def against(scenario):
    """Run a scenario against a server that writes down what it hears and says yes to everything."""

    async def main():
        heard = []

        async def answer(socket):
            with contextlib.suppress(Exception):
                async for text in socket:
                    heard.append(json.loads(text))
                    await socket.send(answer_to(heard[-1]))

        async with serve(answer, "127.0.0.1", 0) as server:
            port = server.sockets[0].getsockname()[1]
            await scenario(heard, ServerAddress("127.0.0.1", port), ManualClock())

    asyncio.run(main())


def answer_to(request):
    if request["type"] == "nonsense":
        return "<html>"
    if request["type"] == "hello":
        camera = {"width": 640, "height": 480}
        greeting = {"protocol_version": 99, "session_id": 1, "robot": "x", "camera": camera}
        return json.dumps({"type": "welcome", "seq": request["seq"], **greeting})
    return json.dumps({"type": "ack", "seq": request["seq"], "ok": True})
