"""Taps, tasks and guides over the socket: who may, what is shown, and all the ways to end them."""

import asyncio
import json

import pytest
from websockets.asyncio.client import connect

from tapreach.robot.clock import MS, SECOND
from tapreach.server.frame_packet import HEADER

TAP = {"u": 320.0, "v": 300.0}


async def tapped(here, page, purpose: str, **change):
    """Tap the newest picture; the clock is turned meanwhile, since taps may wait for odometry."""
    fields = {"frame_id": here.newest_id, "purpose": purpose, **TAP} | change
    asking = asyncio.ensure_future(page.ask("tap", **fields))
    while not asking.done():
        await page.act("heartbeat")
        await here.clock.advance(20 * MS)
    return asking.result()


async def locating(here, page):
    """Start a locate task and let it begin to move the arm."""
    assert (await tapped(here, page, "locate"))["ok"]
    await page.until(lambda: page.news.get("task", {}).get("state") == "running")
    await here.beat(page, 100 * MS)
    assert here.station.tasks.is_running


def test_floor_tap_shows_a_target_and_marks_it_in_the_next_picture(play):
    async def scenario(here):
        page = await here.driver()
        assert (await tapped(here, page, "floor"))["ok"]
        await page.until(lambda: "target" in page.news)
        target = page.news["target"]
        assert (target["source"], target["status"]) == ("floor", "on_floor")
        assert target["point_in_base"][0] > 0.2
        assert target["range_low"] < target["range"] < target["range_high"]
        assert len(target["region_in_world"]) > 8
        async with connect(f"ws://{here.host}/ws/video", compression=None) as socket:
            message = ""
            while isinstance(message, str):
                await here.clock.advance(40 * MS)
                message = await socket.recv()
        meta = json.loads(message[HEADER.size : HEADER.size + HEADER.unpack_from(message)[-1]])
        (marker,) = meta["markers"]
        assert (marker["u"], marker["v"]) == pytest.approx((320.0, 300.0), abs=0.1)
        assert marker["inside"]
        assert marker["target_id"] == target["target_id"]
        assert any(u > 320 for u, _ in marker["region"])
        assert any(u < 320 for u, _ in marker["region"])

    play(scenario)


def test_locating_shows_its_move_with_what_it_should_bring_until_it_ends(play):
    async def scenario(here):
        page = await here.driver()
        refused = await tapped(here, page, "locate", accuracy=0.0)
        assert not refused["ok"] and "accuracy" in refused["reason"]
        assert (await tapped(here, page, "locate", accuracy=0.05))["ok"]
        await page.until(lambda: page.news.get("move", {}).get("tracks_in_world"))
        move = page.news["move"]
        assert 0.0 < move["expected_relative_sd"] < 0.3 and move["expected_sd"] > 0.0
        assert "driving" in move["words"]
        assert len(here.station.planned_path.lines_in_world) == 3
        await page.ask("task_cancel")
        await page.until(lambda: page.news["move"]["tracks_in_world"] == [])
        assert here.station.planned_path.lines_in_world == []

    play(scenario)


def test_box_on_the_floor_shows_its_size_and_marks_its_corners(play):
    async def scenario(here):
        page = await here.driver()
        box = [290.0, 250.0, 350.0, 330.0]
        assert (await tapped(here, page, "floor", v=290.0, box=box))["ok"]
        await page.until(lambda: "target" in page.news)
        target = page.news["target"]
        assert (target["u"], target["v"]) == (320.0, 330.0)
        assert 0.0 < target["extent"]["width"] < target["extent"]["height"] < 0.3
        assert target["extent"]["width_sigma"] > 0.0

    play(scenario)


@pytest.mark.parametrize(
    ("box", "reason"),
    [
        ([300.0, 280.0, 302.0, 320.0], "2.0 px wide"),
        ([340.0, 280.0, 300.0, 320.0], "left, top, right, bottom"),
        ([10.0, 10.0, 60.0, 60.0], "outside its own box"),
        ([900.0, 10.0, 960.0, 60.0], "at least 4 px"),
    ],
)
def test_box_that_means_nothing_is_refused_with_the_reason(play, box, reason):
    async def scenario(here):
        page = await here.driver()
        answer = await tapped(here, page, "locate", box=box)
        assert not answer["ok"]
        assert reason in answer["reason"]
        assert not here.station.tasks.is_running

    play(scenario)


def test_target_stays_where_it_is_while_the_robot_moves(play):
    async def scenario(here):
        page = await here.driver()
        await tapped(here, page, "floor")
        await page.until(lambda: "target" in page.news)
        before = page.news["target"]
        await here.hold(page, SECOND)
        await page.until(lambda: page.news["target"]["point_in_base"][0] < before["point_in_base"][0] - 0.05)
        assert page.news["target"]["point_in_world"] == before["point_in_world"]

    play(scenario)


def test_cleared_target_is_gone_for_all_and_for_newcomers(play):
    async def scenario(here):
        page, other = await here.driver(), await here.page("Ben")
        await tapped(here, page, "floor")
        await other.until(lambda: "target" in other.news)
        target_id = other.news["target"]["target_id"]
        assert (await page.ask("target_clear", target_id=target_id))["ok"]
        await other.until(lambda: other.news.get("target_gone", {}).get("target_id") == target_id)
        assert not (await page.ask("target_clear", target_id=target_id))["ok"]
        late = await here.page("Cleo")
        await late.until(lambda: "state" in late.news)
        assert "target" not in late.news

    play(scenario)


@pytest.mark.parametrize("purpose", ["floor", "locate"])
@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"frame_id": 999}, "there was no picture 999"),
        ({"u": 5000.0}, "outside the picture"),
        ({"v": -3.0}, "outside the picture"),
    ],
)
def test_tap_that_means_no_place_is_refused_with_the_reason(play, purpose, change, reason):
    async def scenario(here):
        page = await here.driver()
        answer = await tapped(here, page, purpose, **change)
        assert not answer["ok"]
        assert reason in answer["reason"]
        assert not here.station.tasks.is_running

    play(scenario)


def test_tap_of_a_watcher_is_refused(play):
    async def scenario(here):
        await here.driver("Anna")
        ben = await here.page("Ben")
        answer = await ben.ask("tap", frame_id=here.newest_id, purpose="locate", **TAP)
        assert (answer["ok"], "lease" in answer["reason"]) == (False, True)

    play(scenario)


def test_locating_needs_an_operator_who_is_heard(play):
    async def scenario(here):
        page = await here.driver()
        await here.clock.advance(SECOND)
        answer = await page.ask("tap", frame_id=here.newest_id, purpose="locate", **TAP)
        assert (answer["ok"], "not heard" in answer["reason"]) == (False, True)

    play(scenario)


def test_second_task_beside_a_running_one_is_refused(play):
    async def scenario(here):
        page = await here.driver()
        await locating(here, page)
        answer = await page.ask("tap", frame_id=here.newest_id, purpose="locate", **TAP)
        assert (answer["ok"], "still running" in answer["reason"]) == (False, True)

    play(scenario)


async def by_cancel(here, page):
    await page.ask("task_cancel")


async def by_stop(here, page):
    await page.ask("stop", reason="button")


async def by_emergency_stop(here, page):
    other = await here.page("Ben")
    await other.ask("emergency_stop")


async def by_driving(here, page):
    await page.drive(0.1, frame_id=here.newest_id)


async def by_moving_the_arm(here, page):
    await page.act("arm_step", control="left", step_deg=1)


async def by_giving_the_lease_back(here, page):
    await page.ask("lease_release")


async def by_closing_the_page(here, page):
    await page.close()
    await here.eventually(lambda: here.station.lease.status.holder_id is None)


async def by_silence(here, page):
    await here.clock.advance(250 * MS)


async def by_losing_the_robot(here, page):
    here.robot.lose("cable out")


@pytest.mark.parametrize(
    ("end", "reason"),
    [
        (by_cancel, "stopped by Anna"),
        (by_stop, "stopped (button)"),
        (by_emergency_stop, "emergency stop pressed by Ben"),
        (by_driving, "the operator drives"),
        (by_moving_the_arm, "the operator moves the arm"),
        (by_giving_the_lease_back, "the operator has changed"),
        (by_closing_the_page, "the operator has changed"),
        (by_silence, "operator not heard for 200 ms"),
        (by_losing_the_robot, "cable out"),
    ],
    ids=lambda value: value.__name__ if callable(value) else "",
)
def test_running_task_is_ended_at_once_and_everybody_learns_why(play, end, reason):
    async def scenario(here):
        watcher = await here.page("watcher")
        page = await here.driver("Anna")
        await locating(here, page)
        await end(here, page)
        await watcher.until(lambda: watcher.news["task"]["state"] in ("cancelled", "failed"))
        assert reason in watcher.news["task"]["message"]
        assert not here.station.tasks.is_running
        assert here.station.loop.sent.twist.linear in (0.0, pytest.approx(0.0, abs=0.02))

    play(scenario)


def test_guide_leads_on_and_ends_when_the_operator_changes(play):
    async def scenario(here):
        page, other = await here.driver("Anna"), await here.page("Ben")
        assert not (await page.ask("guide_act", act="next"))["ok"]
        assert (await page.ask("guide_start", kind="two_tap"))["ok"]
        await other.until(lambda: other.news.get("guide", {}).get("kind") == "two_tap")
        first = other.news["guide"]
        assert (first["step"], first["steps"] > 2, "next" in first["acts"]) == (1, True, True)
        refused = await page.ask("guide_act", act="advance")
        assert (refused["ok"], "advance" in refused["reason"]) == (False, True)
        assert (await page.ask("guide_act", act="next"))["ok"]
        await other.until(lambda: other.news["guide"]["step"] == 2)
        assert not (await other.ask("guide_act", act="next"))["ok"]
        await page.ask("lease_release")
        await other.until(lambda: other.news["guide"]["kind"] is None)

    play(scenario)
