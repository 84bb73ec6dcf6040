"""A move that the board makes by itself, as the page hears of it: how much is done, and when none is."""

from pathlib import Path

from server.conftest import Page
from server.real_drivers import RealRobot
from server.test_dropouts import beat_until, drives_again, play
from tapreach.drivers.arduino.wire import State


def test_state_tells_how_much_of_the_boards_move_is_done_until_it_ends(tmp_path: Path) -> None:
    async def scenario(here: RealRobot, page: Page) -> None:
        await beat_until(here, page, lambda: here.station.frames.newest, None)
        await drives_again(here, page)
        assert page.news["state"]["own_move"] is None
        frame = here.station.frames.newest
        assert frame is not None
        asked = await page.ask("tap", frame_id=frame.frame_id, u=80.0, v=80.0, purpose="locate")
        assert asked["ok"], asked
        told: set[float] = set()

        def is_on_its_way() -> bool:
            done = page.news["state"]["own_move"]
            told.update(() if done is None else (done,))
            return len(told) >= 3

        await beat_until(here, page, is_on_its_way, None)
        assert page.news["task"]["state"] == "running"
        assert 0.0 <= min(told) < max(told) <= 1.0
        await page.ask("stop", reason="button")
        await beat_until(here, page, lambda: page.news["state"]["own_move"] is None, None)
        assert here.board.state is not State.MOVING

    play(tmp_path, scenario)
