"""Teach-in over the control socket, by a turned clock: who may, what stops it, what it writes."""

import asyncio
import contextlib
import re
from collections.abc import AsyncIterator, Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest
from tests.drivers.arduino.memory import ClockedRobot
from tests.drivers.arduino.wired import WiredBoard
from websockets.asyncio.client import connect

from server.conftest import InlineService, Page
from tapreach.drivers.arduino.bench import WITHOUT_FEEDBACK
from tapreach.drivers.arduino.wheels import FIRMWARE_GAINS
from tapreach.drivers.arduino.wire import Gains, ServoLimits, Servos
from tapreach.resources import resource_path
from tapreach.robot.clock import MS, SECOND, ManualClock
from tapreach.robot.config import load_robot
from tapreach.server.access import AccessPolicy
from tapreach.server.serve import listening_socket, serve
from tapreach.server.station import Station

SHIPPED = resource_path("robots") / "rover-pi.toml"
BEAT_NS = 50 * MS


class Teacher:
    """Somebody at a page who drives, is there as long as time passes here, and answers."""

    def __init__(self, station: Station, robot: ClockedRobot, port: int) -> None:
        self.station, self.robot, self.port = station, robot, port
        self.board = robot.board
        self.is_there = True
        self._pages: list[Page] = []

    async def arrive(self) -> None:
        self.page = await self.visitor()
        welcome = await self.page.ask("hello", name="Anna")
        self.offered = welcome["lessons"]
        assert (await self.page.ask("lease_request"))["ok"]
        await self.until(lambda: self.page.news.get("state", {}).get("health") == "running")
        assert (await self.page.act("heartbeat"))["ok"]

    async def visitor(self) -> Page:
        address = f"ws://127.0.0.1:{self.port}/ws/control"
        page = Page(await connect(address, compression=None, close_timeout=1), self.robot.clock)
        self._pages.append(page)
        return page

    async def until(self, holds: Callable[[], object], most_ns: int = 60 * SECOND) -> int:
        """Let time pass until it holds; return how much did."""
        began_ns = self.robot.clock.now_ns()
        while not holds():
            gone_ns = self.robot.clock.now_ns() - began_ns
            assert gone_ns < most_ns, f"waited in vain: {self.lesson}"
            if self.is_there and gone_ns % BEAT_NS == 0:
                await self.page.act("heartbeat")
            await self.robot.pass_time(10 * MS)
        return self.robot.clock.now_ns() - began_ns

    async def waits(self, duration_ns: int) -> None:
        end_ns = self.robot.clock.now_ns() + duration_ns
        await self.until(lambda: self.robot.clock.now_ns() >= end_ns)

    @property
    def lesson(self) -> dict[str, Any]:
        return self.page.news.get("lesson") or {"lesson": None, "question": "", "ended": ""}

    @property
    def is_still(self) -> bool:
        return not any(self.board.speeds)

    @property
    def gains(self) -> list[Gains]:
        return [message for message in self.board.asked if isinstance(message, Gains)]

    async def begins(self, lesson: str) -> None:
        began = await self.page.ask("lesson_start", lesson=lesson)
        assert began["ok"], began
        await self.page.until(lambda: self.lesson["lesson"] == lesson and not self.lesson["ended"])

    async def says(self, *answers: str) -> None:
        for answer in answers:
            await self.until(lambda: self.lesson["question"] or self.lesson["ended"])
            asked = self.lesson["question_id"]
            given = await self.page.ask("lesson_answer", question_id=asked, answer=answer)
            assert given["ok"], f"{given} {self.lesson}"
            await self.page.until(lambda: not self.lesson["question"] or self.lesson["question_id"] > asked)  # noqa: B023

    async def ended(self) -> dict[str, Any]:
        await self.until(lambda: self.lesson["ended"])
        return self.lesson

    async def leave(self) -> None:
        self.is_there = False
        for page in self._pages:
            await page.close()


@contextlib.asynccontextmanager
async def teaching(folder: Path, robot_file: Path | None) -> AsyncIterator[Teacher]:
    clock = ManualClock()
    robot = ClockedRobot(WiredBoard(clock), clock)
    station = Station(robot, clock, folder / "captures", InlineService(), robot_file)
    listener = listening_socket("127.0.0.1", 0)
    ready = asyncio.Event()
    running = asyncio.create_task(serve(station, listener, AccessPolicy(), ready.set))
    waiting = asyncio.create_task(ready.wait())
    await asyncio.wait({running, waiting}, return_when=asyncio.FIRST_COMPLETED)
    if running.done():
        running.result()
    teacher = Teacher(station, robot, listener.getsockname()[1])
    try:
        await teacher.arrive()
        yield teacher
    finally:
        await teacher.leave()
        running.cancel()
        await asyncio.gather(running, waiting, return_exceptions=True)


def play(folder: Path, robot_file: Path | None, scenario: Callable[[Teacher], Awaitable[None]]) -> None:
    async def run() -> None:
        async with teaching(folder, robot_file) as teacher:
            await scenario(teacher)

    asyncio.run(run())


@pytest.fixture
def own_file(tmp_path: Path) -> Path:
    path = tmp_path / "rover.toml"
    path.write_text(SHIPPED.read_text(encoding="utf-8"), encoding="utf-8")
    return path


def test_motors_are_taught_and_the_file_says_what_is_wired_round(tmp_path: Path, own_file: Path) -> None:
    async def scenario(teacher: Teacher) -> None:
        teacher.board.counts = lambda left, right: (left, -right)
        await teacher.begins("motors")
        await teacher.says("yes", "yes", "left", "forward", "yes", "right", "forward")
        await teacher.until(lambda: teacher.lesson["change"])
        assert '+reversed = ["right_encoder"]' in teacher.lesson["change"]
        assert "@@ [link]" in teacher.lesson["change"]
        assert own_file.read_bytes() == SHIPPED.read_bytes()
        await teacher.says("yes")
        end = await teacher.ended()
        assert end["ended"] == "done"
        assert "Start Tapreach again" in end["outcome"]
        assert teacher.gains == [WITHOUT_FEEDBACK, FIRMWARE_GAINS]
        assert teacher.is_still

    play(tmp_path, own_file, scenario)
    assert load_robot(own_file).link.reversed == ("right_encoder",)
    comments = [re.findall("#.*", path.read_text(encoding="utf-8")) for path in (SHIPPED, own_file)]
    assert comments[0] == comments[1]


def test_turns_by_hand_are_counted_while_the_loop_sends_its_zeros(tmp_path: Path, own_file: Path) -> None:
    async def scenario(teacher: Teacher) -> None:
        await teacher.begins("encoders")
        for side in (0, 1):
            await teacher.says("yes")
            await teacher.until(lambda: teacher.lesson["question"])
            teacher.board.ticks[side] += 5000.0
            await teacher.waits(100 * MS)
            await teacher.says("yes")
        await teacher.until(lambda: teacher.lesson["change"])
        assert "+ticks_per_turn = 1000" in teacher.lesson["change"]
        await teacher.says("no")
        end = await teacher.ended()
        assert (end["ended"], end["outcome"]) == ("done", "nothing was written")

    play(tmp_path, own_file, scenario)
    assert own_file.read_bytes() == SHIPPED.read_bytes()


def test_change_by_somebody_else_meanwhile_is_not_written_over(tmp_path: Path, own_file: Path) -> None:
    async def scenario(teacher: Teacher) -> None:
        teacher.board.counts = lambda left, right: (left, -right)
        await teacher.begins("motors")
        await teacher.says("yes", "yes", "left", "forward", "yes", "right", "forward")
        await teacher.until(lambda: teacher.lesson["change"])
        own_file.write_text(own_file.read_text(encoding="utf-8") + "# mine\n", encoding="utf-8")
        await teacher.says("yes")
        end = await teacher.ended()
        assert end["ended"] == "failed"
        assert "changed by somebody else" in end["outcome"]

    play(tmp_path, own_file, scenario)
    assert own_file.read_text(encoding="utf-8") == SHIPPED.read_text(encoding="utf-8") + "# mine\n"


async def press(teacher: Teacher) -> None:
    assert (await teacher.page.ask("emergency_stop"))["ok"]


async def end(teacher: Teacher) -> None:
    assert (await teacher.page.ask("lesson_end"))["ok"]


async def cancel(teacher: Teacher) -> None:
    assert (await teacher.page.ask("task_cancel"))["ok"]


async def give_back(teacher: Teacher) -> None:
    assert (await teacher.page.ask("lease_release"))["ok"]


async def hide(teacher: Teacher) -> None:
    assert (await teacher.page.ask("stop", reason="hidden"))["ok"]


async def fall_silent(teacher: Teacher) -> None:
    teacher.is_there = False


async def vanish(teacher: Teacher) -> None:
    await teacher.leave()


WITHIN_NS = {fall_silent: 250 * MS, vanish: 250 * MS}
"""Silence counts after 200 ms; all others act at once."""


@pytest.mark.parametrize(
    "stop", [press, end, cancel, give_back, hide, fall_silent, vanish], ids=lambda stop: stop.__name__
)
def test_lesson_ends_at_once_with_wheels_at_zero(
    tmp_path: Path, own_file: Path, stop: Callable[[Teacher], Awaitable[None]]
) -> None:
    async def scenario(teacher: Teacher) -> None:
        await teacher.begins("motors")
        await teacher.says("yes", "yes")
        await teacher.until(lambda: not teacher.is_still)
        await stop(teacher)
        assert await teacher.until(lambda: teacher.is_still) <= WITHIN_NS.get(stop, 20 * MS)
        await teacher.until(lambda: not teacher.station.tasks.is_running)
        await teacher.waits(300 * MS)
        assert teacher.is_still
        assert teacher.gains == [WITHOUT_FEEDBACK, FIRMWARE_GAINS]
        if stop is not vanish:
            said = await teacher.ended()
            assert (said["ended"], said["question"]) == ("cancelled", "")

    play(tmp_path, own_file, scenario)
    assert own_file.read_bytes() == SHIPPED.read_bytes()


def test_lesson_that_waits_ends_with_the_operators_control(tmp_path: Path, own_file: Path) -> None:
    async def scenario(teacher: Teacher) -> None:
        await teacher.begins("servos")
        await teacher.until(lambda: teacher.lesson["question"])
        question_id = teacher.lesson["question_id"]
        await give_back(teacher)
        assert (await teacher.ended())["ended"] == "cancelled"
        late = await teacher.page.ask("lesson_answer", question_id=question_id, answer="yes")
        assert not late["ok"]
        assert not any(isinstance(message, Servos) for message in teacher.board.asked)

    play(tmp_path, own_file, scenario)


def test_stopped_servo_holds_and_no_limit_moves_it(tmp_path: Path, own_file: Path) -> None:
    async def scenario(teacher: Teacher) -> None:
        board = teacher.board
        low_us = load_robot(own_file).arm.servos.rotation.low_us
        await teacher.begins("servos")
        await teacher.says("yes")
        for _ in range(30):
            await teacher.until(lambda: teacher.lesson["question"])
            if board.pulses[0] < low_us - 40:
                break
            await teacher.says("--")
        await teacher.says("--")
        await teacher.waits(100 * MS)
        await press(teacher)
        await teacher.ended()
        held_us = board.pulses[0]
        assert held_us < low_us - 40
        await teacher.waits(SECOND)
        assert board.pulses[0] == pytest.approx(held_us, abs=3)
        assert board.pulses[1:] == [0.0, 0.0, 0.0]
        newest = [message for message in board.asked if isinstance(message, ServoLimits)][-4:]
        assert newest[0].low_us <= held_us
        arm = load_robot(own_file).arm.servos
        others = (arm.shoulder, arm.elbow, arm.claw)
        assert [(each.low_us, each.high_us) for each in newest[1:]] == [(s.low_us, s.high_us) for s in others]

    play(tmp_path, own_file, scenario)


def test_only_the_operator_teaches_and_everybody_sees_it(tmp_path: Path, own_file: Path) -> None:
    async def scenario(teacher: Teacher) -> None:
        other = await teacher.visitor()
        welcome = await other.ask("hello", name="Ben")
        assert welcome["lessons"] == ["motors", "encoders", "servos"]
        assert "lease" in (await other.ask("lesson_start", lesson="motors"))["reason"]
        await teacher.begins("motors")
        await teacher.until(lambda: other.news.get("lesson", {}).get("question"))
        asked = other.news["lesson"]
        answer = await other.ask("lesson_answer", question_id=asked["question_id"], answer="yes")
        assert not answer["ok"] and "lease" in answer["reason"]
        assert not (await teacher.page.ask("lesson_start", lesson="servos"))["ok"]
        wrong = await teacher.page.ask("lesson_answer", question_id=asked["question_id"], answer="perhaps")
        assert "none of the answers" in wrong["reason"]
        stale = await teacher.page.ask("lesson_answer", question_id=asked["question_id"] - 1, answer="yes")
        assert "not asked any more" in stale["reason"]
        await end(teacher)
        await teacher.ended()
        await end(teacher)
        await teacher.until(lambda: other.news["lesson"]["lesson"] is None)

    play(tmp_path, own_file, scenario)


def test_shipped_file_is_refused_before_anything_is_sent(tmp_path: Path) -> None:
    async def scenario(teacher: Teacher) -> None:
        refused = await teacher.page.ask("lesson_start", lesson="motors")
        assert not refused["ok"] and "copy it" in refused["reason"]
        assert not teacher.gains

    play(tmp_path, SHIPPED, scenario)


def test_robot_without_a_file_offers_no_lesson(tmp_path: Path) -> None:
    async def scenario(teacher: Teacher) -> None:
        assert teacher.station.tasks.lessons.offered == ()
        assert "cannot be taught" in (await teacher.page.ask("lesson_start", lesson="motors"))["reason"]

    play(tmp_path, None, scenario)
