"""A script at a real server: it looks, locates, fetches and stops, and leaves the robot at rest."""

import asyncio
import socket

import pytest
from tests.client.conftest import PLACE

from tapreach.client import RequestRefused, connect
from tapreach.client.fetching import FetchStatus
from tapreach.errors import InputError, LinkLost, SetupError
from tapreach.robot.clock import MS, SECOND
from tapreach.server.access import AccessPolicy


def test_script_drives_under_its_name_and_sees_the_newest_picture(play, script):
    async def scenario(here):
        async with script(here, name="blob finder") as it:
            assert it.robot.has_lease
            holder = here.station.lease.status.holder_id
            assert here.station.guests.name_of(holder) == "blob finder"
            shot = await it.robot.snapshot()
            assert (shot.frame_id, shot.captured_ns) == (
                here.newest_id,
                here.station.frames.newest.captured_ns,
            )
            height, width, channels = shot.picture().shape
            assert (width, height, channels) == (it.robot.picture_size.width, it.robot.picture_size.height, 3)
        await here.eventually(lambda: here.station.lease.status.holder_id is None)

    play(scenario)


def test_confirmed_fetch_goes_on_and_stop_ends_it_in_a_told_condition(play, script):
    async def scenario(here):
        async with script(here) as it:
            fetching = await it.fetching("confirm")
            phases = [await it.turned(anext(fetching)) for _ in range(3)]
            assert [each.phase for each in phases] == ["look", "preview", "confirm"]
            asked = phases[-1]
            assert asked.may_confirm and asked.verdict in ("yes", "unsure") and len(asked.path) >= 2
            await fetching.confirm()
            assert (await it.turned(anext(fetching))).phase == "zero"
            await it.robot.stop()
            result = await it.turned(fetching.result())
            assert (result.status, result.reason) == (FetchStatus.STOPPED, "stopped (button)")
            assert result.last.phase == "zero" and "stands" in result.last.condition
            assert here.speed == 0.0

    play(scenario)


def test_stopped_fetch_goes_on_and_tells_nothing_of_what_was_before(play, script):
    async def scenario(here):
        async with script(here) as it:
            fetching = await it.fetching()
            await it.robot.stop()
            assert (await it.turned(fetching.result())).last.may_resume
        async with script(here) as it:
            await it.turned(it.robot.link.until(lambda: it.robot.newest_fetch))
            assert it.robot.newest_fetch.stopped
            fetching = await it.turned(it.robot.resume_fetch())
            first = await it.turned(anext(fetching))
            assert (first.phase, first.stopped) == ("look", "")
            await it.robot.stop()
            assert (await it.turned(fetching.result())).status is FetchStatus.STOPPED

    play(scenario)


def test_located_target_comes_with_the_words_of_its_end(play, script):
    async def scenario(here):
        async with script(here) as it:
            shot = await it.robot.snapshot()
            locating = asyncio.ensure_future(it.robot.locate(shot.frame_id, *PLACE))
            await it.turned(here.eventually(lambda: it.task.is_running))
            await it.robot.stop()
            result = await it.turned(locating)
            assert (result.status, result.reason) == ("cancelled", "stopped (button)")
            assert result.target is None or result.target.frame_id == shot.frame_id

    play(scenario)


def test_what_makes_no_sense_is_refused_with_the_reason(play, script):
    async def scenario(here):
        async with script(here) as it:
            with pytest.raises(InputError, match="outside the picture"):
                await it.robot.fetch(1, 640.0, 10.0)
            with pytest.raises(InputError, match="pixel u"):
                await it.robot.locate(1, float("nan"), 10.0)
            with pytest.raises(RequestRefused, match="999"):
                await it.robot.fetch(999, *PLACE)
            with pytest.raises(RequestRefused, match="nothing is held"):
                await it.robot.follow_up("put_down")
            with pytest.raises(RequestRefused, match="no target 7"):
                await it.robot.fetch_target(7)
            with pytest.raises(RequestRefused, match="tap the thing again"):
                await it.robot.resume_fetch()

    play(scenario)


def test_emergency_stop_ends_a_fetch_and_holds_until_it_is_reset(play, script):
    async def scenario(here):
        async with script(here, name="Anna's script") as it:
            fetching = await it.fetching()
            await it.robot.emergency_stop()
            result = await it.turned(fetching.result())
            assert result.status is FetchStatus.STOPPED and "Anna's script" in result.reason
            with pytest.raises(RequestRefused, match="emergency stop"):
                await it.fetching()
            await it.robot.emergency_reset()
            assert not here.station.emergency_stop.is_set

    play(scenario)


def test_error_in_the_script_stops_the_robot_and_frees_it(play, script):
    async def scenario(here):
        with pytest.raises(ZeroDivisionError):
            async with script(here) as it:
                async for _ in await it.fetching():
                    raise ZeroDivisionError
        assert not here.station.tasks.is_running
        assert here.speed == 0.0
        assert here.station.lease.status.holder_id is None

    play(scenario)


def test_broken_link_is_told_to_whoever_waits_and_stops_the_robot(play, script):
    async def scenario(here):
        with pytest.raises(LinkLost):
            async with script(here) as it:
                fetching = await it.fetching()
                it.robot.link._socket.transport.abort()
                await fetching.result()
        await here.eventually(lambda: here.station.lease.status.holder_id is None)
        await here.eventually(lambda: not here.station.tasks.is_running)
        assert here.speed == 0.0

    play(scenario)


def test_driver_who_says_no_is_named(play):
    async def scenario(here):
        page = await here.driver("Berta")
        opening = connect(f"http://{here.host}/", clock=here.clock)
        asking = asyncio.ensure_future(opening.__aenter__())
        await page.until(lambda: page.news["state"]["lease"]["asked_by_id"])
        asker = page.news["state"]["lease"]["asked_by_id"]
        await page.ask("lease_answer", session_id=asker, grant=False)
        while not asking.done():
            await here.beat(page, 200 * MS)
        with pytest.raises(RequestRefused, match="Berta drives"):
            asking.result()

    play(scenario)


def test_silent_driver_is_relieved(play):
    async def scenario(here):
        page = await here.driver("Berta")
        opening = connect(f"http://{here.host}/", clock=here.clock)
        asking = asyncio.ensure_future(opening.__aenter__())
        await page.until(lambda: page.news["state"]["lease"]["asked_by_id"])
        await here.clock.advance(6 * SECOND)
        assert (await asking).has_lease
        await opening.__aexit__(None, None, None)

    play(scenario)


def test_lan_server_lets_in_who_has_the_token(play):
    async def scenario(here):
        with pytest.raises(SetupError, match="token"):
            await opened(f"http://{here.host}/")
        with pytest.raises(SetupError, match="token"):
            await opened(f"http://{here.host}/?token=wrong")
        async with connect(f"http://{here.host}/?token=right", clock=here.clock) as robot:
            await here.clock.advance(SECOND)
            assert (await robot.snapshot()).frame_id == here.newest_id

    play(scenario, policy=AccessPolicy("right"))


def test_no_server_says_how_to_start_one():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        with pytest.raises(SetupError, match="tapreach run"):
            asyncio.run(opened(f"http://127.0.0.1:{free.getsockname()[1]}/"))


async def opened(address):
    async with connect(address):
        raise AssertionError("nobody is there")
