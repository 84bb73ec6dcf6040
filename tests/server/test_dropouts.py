"""A camera or a cable that drops out, through the server: what runs stops, it is said, and it comes back."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from websockets.asyncio.client import connect

from server.conftest import PATIENCE_S, Page
from server.real_drivers import RealRobot, real_robot
from tapreach.robot.clock import SECOND

Scenario = Callable[[RealRobot, Page], Awaitable[None]]


def play(folder: Path, scenario: Scenario) -> None:
    async def run() -> None:
        async with real_robot(folder) as here:
            page = Page(await connect(f"ws://127.0.0.1:{here.port}/ws/control", compression=None), here.clock)
            try:
                await page.ask("hello", name="Anna")
                assert (await page.ask("lease_request"))["ok"]
                await page.until(lambda: health(page) == "running")
                await scenario(here, page)
            finally:
                await page.close()

    asyncio.run(run())


def health(page: Page) -> str | None:
    state = page.news.get("state")
    return state["health"] if state else None


async def beat_until(here: RealRobot, page: Page, holds: Callable[[], object], linear: float | None) -> None:
    """Do as a page does until it holds: 20 times a second the drive button held, or only there."""
    async with asyncio.timeout(PATIENCE_S):
        while not holds():
            newest = here.station.frames.newest
            frame_id = newest.frame_id if newest else None
            if linear is None:
                await page.act("heartbeat", frame_id=frame_id)
            else:
                await page.drive(linear, frame_id=frame_id)
            await asyncio.sleep(0.05)


async def drives_again(here: RealRobot, page: Page) -> None:
    """As a person does it: the button is let go, and pressed again."""
    await page.drive(0.0)
    await beat_until(here, page, lambda: here.is_turning, 0.1)
    await page.drive(0.0)
    await beat_until(here, page, lambda: not here.is_turning, None)


async def break_off(here: RealRobot, how: str) -> None:
    if how == "killed":
        await here.camera.kill()
    else:
        here.camera.is_silent = True


async def mend(here: RealRobot, how: str) -> None:
    if how == "killed":
        await here.camera.start()
    else:
        here.camera.is_silent = False


@pytest.mark.parametrize(("how", "said"), [("killed", "has ended the stream"), ("silent", "no picture for")])
def test_camera_that_drops_out_stops_the_task_and_comes_back_by_itself(
    tmp_path: Path, how: str, said: str
) -> None:
    async def scenario(here: RealRobot, page: Page) -> None:
        await beat_until(here, page, lambda: here.station.frames.newest, None)
        await drives_again(here, page)
        frame = here.station.frames.newest
        assert frame is not None
        asked = await page.ask("tap", frame_id=frame.frame_id, u=80.0, v=80.0, purpose="locate")
        assert asked["ok"], asked
        await beat_until(here, page, lambda: here.is_turning, None)
        began_ns = here.clock.now_ns()
        await break_off(here, how)
        await beat_until(here, page, lambda: page.news["task"]["state"] != "running", None)
        assert here.clock.now_ns() - began_ns < 2 * SECOND
        assert page.news["task"]["state"] == "cancelled"
        assert page.news["task"]["message"].startswith("robot lost: ")
        assert said in page.news["task"]["message"]
        await beat_until(here, page, lambda: not here.is_turning, None)
        await beat_until(here, page, lambda: health(page) == "lost", None)
        last = here.station.frames.newest
        await mend(here, how)
        await beat_until(here, page, lambda: health(page) == "running", None)
        newest = here.station.frames.newest
        assert newest is not None and last is not None and newest.frame_id > last.frame_id
        await drives_again(here, page)

    play(tmp_path, scenario)


def test_board_unplugged_during_a_drive_stops_is_said_and_comes_back_without_a_restart(
    tmp_path: Path,
) -> None:
    async def scenario(here: RealRobot, page: Page) -> None:
        await drives_again(here, page)
        await beat_until(here, page, lambda: here.is_turning, 0.1)
        here.line.unplug()
        await beat_until(here, page, lambda: health(page) == "lost", 0.1)
        assert "was unplugged" in page.news["state"]["health_reason"]
        assert not (await page.drive(0.1, frame_id=None))["ok"] or not page.news["state"]["sent"]["linear"]
        await beat_until(here, page, lambda: not here.is_turning, 0.1)
        here.line.plug()
        await beat_until(here, page, lambda: health(page) == "running", 0.0)
        await drives_again(here, page)

    play(tmp_path, scenario)
