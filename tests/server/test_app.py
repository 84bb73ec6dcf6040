"""Files of the page, headers, captures over HTTP, and how a server ends."""

import asyncio
import re
import signal

import httpx
import pytest

from tapreach.errors import SetupError
from tapreach.robot.clock import MS
from tapreach.server.serve import listening_socket


def test_page_and_its_scripts_have_the_right_types_and_are_asked_for_again(play):
    async def scenario(here):
        async with httpx.AsyncClient(base_url=f"http://{here.host}") as client:
            page = await client.get("/")
            script = await client.get("/net/messages.js")
            missing = await client.get("/net/nothing.js")
        assert page.headers["content-type"].startswith("text/html")
        assert script.headers["content-type"].startswith("text/javascript")
        assert script.headers["cache-control"] == "no-cache"
        assert missing.status_code == 404

    play(scenario)


@pytest.mark.parametrize("path", ["/", "/net/messages.js", "/api/captures", "/snapshot.jpg", "/nothing"])
def test_every_answer_forbids_foreign_content(play, path):
    async def scenario(here):
        async with httpx.AsyncClient(base_url=f"http://{here.host}") as client:
            response = await client.get(path)
        policy = response.headers["content-security-policy"]
        assert "default-src 'self'" in policy
        assert "frame-ancestors 'none'" in policy
        assert "unsafe" not in policy
        assert not re.search(r"https?:|\*", policy)
        assert response.headers["x-content-type-options"] == "nosniff"

    play(scenario)


def test_captures_are_listed_downloaded_and_deleted(play):
    async def scenario(here):
        page = await here.driver()
        capture_id = (await page.ask("capture", frame_id=None))["reason"]
        async with httpx.AsyncClient(base_url=f"http://{here.host}/api/") as client:
            (facts,) = (await client.get("captures")).json()
            assert facts["id"] == capture_id
            picture = await client.get(f"captures/{capture_id}.jpg")
            assert picture.content == here.station.frames.newest.jpeg
            assert picture.headers["content-type"] == "image/jpeg"
            assert (await client.get(f"captures/{capture_id}.json")).json() == facts
            page.news.pop("captures_changed")
            assert (await client.delete(f"captures/{capture_id}")).status_code == 200
            await page.until(lambda: "captures_changed" in page.news)
            assert (await client.get("captures")).json() == []
            gone = await client.get(f"captures/{capture_id}.jpg")
            assert (gone.status_code, capture_id in gone.json()["reason"]) == (404, True)

    play(scenario)


@pytest.mark.parametrize("name", ["..%2F..%2Fetc%2Fpasswd", "%2e%2e", "x"])
def test_capture_id_that_leads_elsewhere_is_not_found(play, name):
    async def scenario(here):
        async with httpx.AsyncClient(base_url=f"http://{here.host}/api/") as client:
            for method in ("GET", "DELETE"):
                response = await client.request(method, f"captures/{name}{'.jpg' if method == 'GET' else ''}")
                assert response.status_code in (404, 405)

    play(scenario)


def test_port_that_is_taken_is_a_plain_sentence():
    first = listening_socket("127.0.0.1", 0)
    try:
        with pytest.raises(SetupError, match=r"cannot listen on 127.0.0.1 port \d+: .*; choose another"):
            listening_socket("127.0.0.1", first.getsockname()[1])
    finally:
        first.close()


def test_death_of_the_control_loop_ends_the_server_with_the_wheels_at_rest(play):
    async def scenario(here):
        page = await here.driver()
        await here.hold(page, 500 * MS)

        def broken(*_):
            raise ZeroDivisionError("a bug in the gate")

        here.station.loop._gate.operator = broken
        await here.clock.advance(40 * MS)
        await asyncio.wait_for(page.socket.wait_closed(), 10)
        with pytest.raises(ZeroDivisionError):
            here.station.failed.result()
        assert here.station.loop.sent.twist.is_zero
        await here.eventually(lambda: not here.robot.health.is_running)

    play(scenario)


def test_stopped_server_closes_sockets_and_robot(play):
    seen = {}

    async def scenario(here):
        seen["page"], seen["here"] = await here.driver(), here

    play(scenario)
    assert not seen["here"].robot.health.is_running
    assert seen["page"].socket.close_code is not None


def test_endless_streams_do_not_hold_up_the_end_and_leave_no_error(play, capfd):
    seen = {}

    async def scenario(here):
        async def read_stream():
            url = f"http://{here.host}/stream.mjpg"
            async with httpx.AsyncClient() as client, client.stream("GET", url) as response:
                return len(await response.aread())

        seen["length"] = asyncio.create_task(read_stream())
        await here.eventually(lambda: here.station.feed.viewers == 1)
        await here.clock.advance(40 * MS)
        # serve listens for it, as when somebody presses Ctrl-C or the system shuts down.
        signal.raise_signal(signal.SIGTERM)
        await here.eventually(lambda: not here.robot.health.is_running)

    play(scenario)
    assert seen["length"].result() > 1000
    assert capfd.readouterr().err == ""


def test_robot_that_cannot_be_connected_is_said_by_serve(play, monkeypatch):
    from tapreach.drivers.fake import FakeRobot

    async def fail(_):
        raise SetupError("no cable: plug it in")

    monkeypatch.setattr(FakeRobot, "connect", fail)
    with pytest.raises(SetupError, match="plug it in"):
        play(lambda here: None)
