"""Fetching over the socket: who may, what is told, and all that is refused with a reason."""

import asyncio

import pytest

from tapreach.robot.clock import MS

TAP = {"u": 320.0, "v": 300.0}
PAST_LOOKING = {"preview", "confirm", "planned", "refused", "failed"}


async def asked(here, page, **fields):
    """Ask to fetch what is in the newest picture; the clock is turned meanwhile."""
    asking = asyncio.ensure_future(page.ask("fetch", **{"frame_id": here.newest_id, **TAP} | fields))
    while not asking.done():
        await page.act("heartbeat")
        await here.clock.advance(20 * MS)
    return asking.result()


async def looking(here, page, mode: str = "plan"):
    """Ask to fetch and let it begin."""
    assert (await asked(here, page, mode=mode))["ok"]
    await page.until(lambda: page.news.get("fetch", {}).get("phase") == "look")


def test_plan_says_whether_it_can_be_fetched_and_grips_nothing(play):
    async def scenario(here):
        page = await here.driver()
        await looking(here, page)
        assert page.news["fetch"]["next"] == "finds out whether and how it can be fetched"
        while here.station.tasks.is_running:
            await page.act("heartbeat", frame_id=here.newest_id)
            await here.clock.advance(50 * MS)
        await page.until(lambda: page.news["fetch"]["phase"] in ("planned", "refused", "failed"))
        assert page.news["fetch"]["why"]
        assert page.news["fetch"]["verbs"] == []

    play(scenario)


def test_stopped_fetch_says_how_the_robot_stands_and_can_go_on(play):
    async def scenario(here):
        page = await here.driver()
        await looking(here, page, "go")
        await page.ask("stop", reason="button")
        await page.until(lambda: page.news["fetch"]["stopped"])
        told = page.news["fetch"]
        assert told["condition"] == "the robot stands, the arm is folded"
        assert told["may_resume"]
        assert not here.station.tasks.is_running
        await here.beat(page, 100 * MS)
        assert (await page.ask("fetch_resume"))["ok"]
        await page.until(lambda: page.news["fetch"]["stopped"] == "")

    play(scenario)


@pytest.mark.parametrize(
    ("request_", "reason"),
    [
        ({"type": "fetch_confirm"}, "nothing waits to be confirmed"),
        ({"type": "fetch_resume"}, "no stopped fetch to go on with"),
        ({"type": "fetch_verb", "verb": "put_down"}, "nothing is held"),
        ({"type": "fetch", "mode": "go"}, "give the tap"),
        ({"type": "fetch", "mode": "go", "target_id": 7}, "there is no target 7 with a position"),
        ({"type": "fetch", "mode": "go", "frame_id": 999, **TAP}, "there was no picture 999"),
        ({"type": "fetch", "mode": "now", "frame_id": 1, **TAP}, "mode"),
    ],
)
def test_what_cannot_be_done_is_refused_with_the_reason(play, request_, reason):
    async def scenario(here):
        page = await here.driver()
        await page.act("heartbeat", frame_id=here.newest_id)
        answer = await page.ask(**request_)
        assert not answer["ok"]
        assert reason in answer["reason"]
        assert not here.station.tasks.is_running

    play(scenario)


@pytest.mark.parametrize("kind", ["fetch", "fetch_confirm", "fetch_resume"])
def test_a_watcher_cannot_fetch(play, kind):
    async def scenario(here):
        await here.driver("Anna")
        ben = await here.page("Ben")
        fields = {"frame_id": here.newest_id, "mode": "go", **TAP} if kind == "fetch" else {}
        answer = await ben.ask(kind, **fields)
        assert (answer["ok"], "lease" in answer["reason"]) == (False, True)

    play(scenario)
