"""The lessons with the firmware's own code behind them, and a person at a real terminal."""

import asyncio
import io
import os
import pty

import pytest
from tests.cli.test_teach import SHIPPED, Scripted, motor_answers
from tests.cli.visited_board import STEP_NS, play_clocked, play_visit
from tests.firmware.host.board import HAS_COMPILER, Board
from typer.testing import CliRunner

from tapreach.cli.checkup.board_check import check_board
from tapreach.cli.checkup.check import Verdict
from tapreach.cli.main import app
from tapreach.cli.teaching.person import Terminal
from tapreach.cli.teaching.teach import teach
from tapreach.drivers.arduino.bench import PWM
from tapreach.errors import InputError
from tapreach.robot.config import load_robot
from tapreach.tasks.teaching.lesson import Lesson
from tapreach.tasks.teaching.person import TeachingStopped

needs_compiler = pytest.mark.skipif(not HAS_COMPILER, reason="needs g++ (Debian: apt-get install g++)")


class FirmwareBoard:
    """The compiled firmware as the other end of a line, and the most PWM that it gave."""

    def __init__(self, clock):
        self.board, self.write, self.most_pwm = Board(), lambda data: None, 0

    def take(self, data):
        self.write(self.board.feed(data))

    def step(self):
        self.board.lib.run(STEP_NS // 1000)
        self.most_pwm = max(self.most_pwm, *(abs(pwm) for pwm in self.board.pwm))
        self.write(self.board._listen())


def lesson_with_firmware(lesson, tmp_path, person):
    path = tmp_path / "rover.toml"
    path.write_text(SHIPPED.read_text(encoding="utf-8"), encoding="utf-8")
    boards = []

    async def work(clock, board, opened):
        boards.append(board)
        return await teach(lesson, path, person, clock, opened)

    return play_clocked(work, FirmwareBoard), boards[0], path


@needs_compiler
def test_motors_turn_gently_without_feedback_and_stand_afterwards(tmp_path):
    is_right, board, _ = lesson_with_firmware(Lesson.MOTORS, tmp_path, Scripted(*motor_answers()))
    assert is_right
    assert 0.8 * PWM < board.most_pwm <= PWM + 2
    assert all(100 < angle < 1600 for angle in board.board.angles)
    assert board.board.pwm == (0, 0)


@needs_compiler
def test_doctor_finds_the_firmware_well():
    arm = load_robot(SHIPPED).arm

    async def scenario(visit, board, clock):
        return await check_board(visit, arm, clock)

    checks = play_visit(scenario, FirmwareBoard)
    assert {check.verdict for check in checks} == {Verdict.OK}, checks
    assert checks[2].found == "7.40 V"


@needs_compiler
def test_servo_of_the_firmware_follows_the_steps(tmp_path):
    answers = ["yes", "--", "ok", *["++"] * 6, "ok", "yes", "left", "ok", "skip", "skip", "skip", "yes"]
    done, board, path = lesson_with_firmware(Lesson.SERVOS, tmp_path, Scripted(*answers))
    assert done
    assert board.board.pulses == [1500, 0, 0, 0]
    text = path.read_text(encoding="utf-8")
    assert "low_us = 1450\nhigh_us = 1750\nreversed = false" in text


def at_terminal(typed, work):
    """Run `work(terminal)` with a person who has typed this."""
    master, slave = pty.openpty()
    shown = io.StringIO()
    with os.fdopen(slave, "r") as source, os.fdopen(master, "wb", buffering=0) as keyboard:
        keyboard.write(typed)
        return asyncio.run(work(Terminal("--teach", source, shown))), shown.getvalue()


def test_terminal_takes_one_of_the_answers_and_says_which_there_are():
    async def asked(terminal):
        return await asyncio.wait_for(terminal.ask("Ready?", ("yes", "no")), 10)

    async def twice(terminal):
        return await asyncio.wait_for(terminal.ask("Ready?", ("yes",)), 10)

    assert at_terminal(b" YES \n", asked) == ("yes", "Ready? [yes/no/stop] ")
    with pytest.raises(TeachingStopped):
        at_terminal(b"stop\n", twice)


def test_terminal_asks_again_after_what_is_no_answer():
    async def asked(terminal):
        asking = asyncio.create_task(terminal.ask("Ready?", ("yes",)))
        return await asyncio.wait_for(asking, 10)

    answer, shown = at_terminal(b"maybe\nyes\n", asked)
    assert answer == "yes"
    assert "'maybe' is none of these: yes, stop" in shown


def test_end_of_input_stops():
    async def asked(terminal):
        await asyncio.wait_for(terminal.ask("Ready?", ("yes",)), 10)

    with pytest.raises(TeachingStopped, match="nothing was written"):
        at_terminal(b"\x04", asked)


def test_lesson_without_a_person_is_refused():
    done = CliRunner().invoke(app, ["doctor", "--robot", "rover-pi", "--teach", "motors"])
    assert isinstance(done.exception, InputError)
    assert "needs a person" in str(done.exception)
