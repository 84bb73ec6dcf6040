"""Teach-in: a person who answers, a board whose wheels and servos do what a test builds into it."""

import re
import tomllib
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from tests.cli.visited_board import play_clocked
from tests.drivers.arduino.wired import WiredBoard

from tapreach.cli.teaching.teach import teach
from tapreach.drivers.arduino.bench import PWM, SPEED, WITHOUT_FEEDBACK
from tapreach.drivers.arduino.servo_way import SPEED_US_PER_S
from tapreach.drivers.arduino.wheels import FIRMWARE_GAINS
from tapreach.drivers.arduino.wire import (
    Drive,
    Fault,
    Feature,
    Gains,
    Move,
    Reversed,
    Servos,
    Welcome,
    Wiring,
)
from tapreach.errors import ConfigError, DriverError, InputError, LinkLost
from tapreach.resources import resource_path
from tapreach.robot.config import load_robot
from tapreach.tasks.teaching.file_changes import changed_text, write_text
from tapreach.tasks.teaching.lesson import Lesson
from tapreach.tasks.teaching.person import TeachingStopped
from tapreach.tasks.teaching.servos import STEPS_US

SHIPPED = resource_path("robots") / "rover-pi.toml"
CONTROL_H = Path(__file__).parents[2] / "firmware" / "tapreach" / "control.h"


class Scripted:
    """Answers in order; a callable is asked for its answer with what the robot looks like."""

    def __init__(self, *answers):
        self.answers, self.told, self.asked = list(answers), [], []

    def tell(self, text):
        self.told.append(text)

    def show_change(self, difference):
        self.told.append(difference)

    async def ask(self, question, answers):
        self.asked.append(question)
        answer = self.answers.pop(0)
        answer = answer() if callable(answer) else answer
        if answer == "stop":
            raise TeachingStopped("stopped; nothing was written")
        assert answer in answers, (question, answers)
        return answer

    @property
    def text(self):
        return "\n".join(self.told)


@pytest.fixture
def own_file(tmp_path):
    path = tmp_path / "rover.toml"
    path.write_text(SHIPPED.read_text(encoding="utf-8"), encoding="utf-8")
    return path


def taught(lesson, path, person, build=lambda board: None, board_class=WiredBoard):
    boards = []

    async def work(clock, board, opened):
        boards.append(board)
        build(board)
        return await teach(lesson, path, person, clock, opened)

    try:
        return play_clocked(work, board_class), boards[0]
    finally:
        assert boards and boards[0].speeds == [0.0, 0.0]


def motor_answers(left=("left", "forward"), right=("right", "forward")):
    return ["yes", "yes", *left, "yes", *right]


def test_motors_that_are_right_pass_slowly_and_the_board_gets_its_gains_back(own_file):
    person = Scripted(*motor_answers())
    is_right, board = taught(Lesson.MOTORS, own_file, person)
    assert is_right
    drives = [m for m in board.asked if isinstance(m, Drive)]
    assert {(d.left, d.right) for d in drives} == {(0, 0), (SPEED, 0), (0, SPEED)}
    assert max(abs(ticks) for ticks in board.ticks) < 1.3 * SPEED
    assert [m for m in board.asked if isinstance(m, Gains)] == [WITHOUT_FEEDBACK, FIRMWARE_GAINS]
    assert not any(isinstance(m, Move) for m in board.asked)
    assert own_file.read_bytes() == SHIPPED.read_bytes()


@pytest.mark.parametrize(
    ("counts", "answers", "faults"),
    [
        (lambda a, b: (b, a), {}, ["right encoder counts the left", "left encoder counts the right"]),
        (lambda a, b: (0, b), {}, ["left encoder counts nothing"]),
        (lambda a, b: (a, b), {"left": ("none",)}, ["left motor: no motion"]),
        (
            lambda a, b: (b, a),
            {"left": ("right", "forward"), "right": ("left", "forward")},
            ["the right wheel turns when the left", "the left wheel turns when the right"],
        ),
    ],
)  # fmt: skip
def test_wires_to_change_are_named_and_no_others(own_file, counts, answers, faults):
    person = Scripted(*motor_answers(**answers))
    is_right, _ = taught(Lesson.MOTORS, own_file, person, lambda board: setattr(board, "counts", counts))
    assert not is_right
    named = [line for line in person.told if line.startswith("  - ")]
    assert len(named) == len(faults)
    assert all(fault in line for fault, line in zip(faults, named, strict=True)), named


TURNED_ROUND = [
    (lambda a, b: (-a, b), {}, ["left_encoder"]),
    (lambda a, b: (a, -b), {}, ["right_encoder"]),
    (lambda a, b: (-a, b), {"left": ("left", "back")}, ["left_motor"]),
    (lambda a, b: (a, b), {"right": ("right", "back")}, ["right_motor", "right_encoder"]),
]


@pytest.mark.parametrize(("counts", "answers", "parts"), TURNED_ROUND)
def test_what_is_the_other_way_round_is_written_and_no_comment_is_lost(own_file, counts, answers, parts):
    person = Scripted(*motor_answers(**answers), "yes")
    is_right, _ = taught(Lesson.MOTORS, own_file, person, lambda board: setattr(board, "counts", counts))
    assert is_right
    before, after = SHIPPED.read_text(encoding="utf-8"), own_file.read_text(encoding="utf-8")
    assert list(load_robot(own_file).link.reversed) == parts
    added = [line for line in after.splitlines() if line not in before.splitlines()]
    assert added == ["reversed = [" + ", ".join(f'"{part}"' for part in parts) + "]"]
    assert [line for line in after.splitlines() if line not in added] == before.splitlines()


def test_reversal_of_the_file_is_told_to_the_board_first_and_taken_back_where_it_is_wrong(own_file):
    text = own_file.read_text(encoding="utf-8")
    own_file.write_text(changed_text(text, {("link", "reversed"): ["left_motor"]}, "x"), encoding="utf-8")
    person = Scripted(*motor_answers(left=("left", "back")), "no")
    is_right, board = taught(
        Lesson.MOTORS, own_file, person, lambda board: setattr(board, "counts", lambda a, b: (-a, b))
    )
    assert not is_right
    assert board.asked.index(Wiring(Reversed.LEFT_MOTOR)) < board.asked.index(WITHOUT_FEEDBACK)
    assert '-reversed = ["left_motor"]\n+reversed = []' in person.text
    assert "Swap wires then" in person.text


def test_gains_without_feedback_are_gentle_and_those_given_back_are_the_firmwares():
    assert pytest.approx(PWM, abs=1) == WITHOUT_FEEDBACK.feedforward / 256 * SPEED
    assert (WITHOUT_FEEDBACK.kp, WITHOUT_FEEDBACK.ki, WITHOUT_FEEDBACK.kd) == (0, 0, 0)
    text = CONTROL_H.read_text(encoding="utf-8")
    line = "float kp = {} / 256.0f, ki = {} / 256.0f, kd = {}, feedforward = {} / 256.0f;"
    g = FIRMWARE_GAINS
    assert line.format(g.kp, g.ki, g.kd, g.feedforward) in text
    assert f"max_speed = {g.max_speed};" in text
    assert f"max_acceleration = {g.max_acceleration};" in text


@pytest.mark.parametrize("answers", [["stop"], ["yes", "stop"], ["yes", "yes", "stop"]])
def test_person_who_stops_leaves_wheels_off_and_the_file_alone(own_file, answers):
    with pytest.raises(TeachingStopped):
        taught(Lesson.MOTORS, own_file, Scripted(*answers))
    assert own_file.read_bytes() == SHIPPED.read_bytes()


def test_fault_while_a_wheel_turns_ends_the_test(own_file):
    def build(board):
        board.latch(Fault.STOP_INPUT)

    with pytest.raises(DriverError, match="a fault stands"):
        taught(Lesson.MOTORS, own_file, Scripted("yes", "yes"), build)


def by_hand(board, left=0.0, right=0.0):
    def turn():
        board.ticks[0] += left
        board.ticks[1] += right
        return "yes"

    return turn


def encoder_lesson(path, left, right, *more, build=lambda board: None):
    answers = []
    person = Scripted()

    def prepared(board):
        build(board)
        answers.extend(["yes", by_hand(board, left=left), "yes", by_hand(board, right=right), *more])
        person.answers = answers

    return person, taught(Lesson.ENCODERS, path, person, prepared)


def test_turns_by_hand_become_ticks_in_the_file_and_no_comment_is_lost(own_file):
    _, (is_right, board) = encoder_lesson(own_file, 5003.0, 4997.0, "yes")
    assert is_right
    before, after = SHIPPED.read_text(encoding="utf-8"), own_file.read_text(encoding="utf-8")
    assert after == before.replace("ticks_per_turn = 1320", "ticks_per_turn = 1000")
    assert {type(m) for m in board.asked} & {Drive, Move, Servos, Gains} == set()


def test_no_to_the_change_leaves_the_file(own_file):
    person, _ = encoder_lesson(own_file, 5000.0, 5000.0, "no")
    assert "-ticks_per_turn = 1320\n+ticks_per_turn = 1000" in person.text
    assert own_file.read_bytes() == SHIPPED.read_bytes()


@pytest.mark.parametrize(
    ("left", "right", "message"),
    [
        (-5000.0, 0.0, "left encoder counted back"),
        (3.0, 0.0, "check its supply"),
        (5000.0, 5400.0, "differ too much"),
    ],
)
def test_count_that_makes_no_sense_is_not_written(own_file, left, right, message):
    with pytest.raises(InputError, match=message):
        encoder_lesson(own_file, left, right)
    assert own_file.read_bytes() == SHIPPED.read_bytes()


def test_stepper_board_has_nothing_to_count(own_file):
    class Stepper(WiredBoard):
        def say(self, message):
            is_welcome = isinstance(message, Welcome)
            super().say(replace(message, features=Feature.STEPPER) if is_welcome else message)

    with pytest.raises(InputError, match="micro steps"):
        taught(Lesson.ENCODERS, own_file, Scripted(), board_class=Stepper)


REST = 1300 - 48 * 10
ONE_SERVO = [
    "skip",
    "yes",
    "--",
    "--",
    "ok",
    *["++"] * 8,
    "+",
    "ok",
    "yes",
    "back",
    "+",
    "ok",
    "skip",
    "skip",
]


def test_servo_is_taught_by_small_steps_and_written_with_every_comment(own_file):
    person = Scripted(*ONE_SERVO, "yes")
    is_right, _ = taught(Lesson.SERVOS, own_file, person)
    assert is_right
    before = tomllib.loads(SHIPPED.read_text(encoding="utf-8"))["arm"]["servos"]
    text = own_file.read_text(encoding="utf-8")
    after = tomllib.loads(text)["arm"]["servos"]
    assert {name: after[name] for name in after if name != "shoulder"} == {
        name: before[name] for name in before if name != "shoulder"
    }
    shoulder = after["shoulder"]
    assert (shoulder["low_us"], shoulder["high_us"]) == (REST - 100, REST + 310)
    assert shoulder["reversed"] is True
    middle = round((2 * REST + 210 - 80) / 2)
    assert shoulder["pulse_at_zero_us"] == middle + 80 + 10
    comments = re.findall("#.*", SHIPPED.read_text(encoding="utf-8"))
    assert re.findall("#.*", text) == comments


def test_servo_moves_are_slow_and_near_and_of_one_servo_alone(own_file):
    _, board = taught(Lesson.SERVOS, own_file, Scripted(*ONE_SERVO, "no"))
    asked = [m for m in board.asked if isinstance(m, Servos)]
    assert all(m.pulse_us[0] == m.pulse_us[2] == m.pulse_us[3] == 0 for m in asked)
    assert {m.speed_us_per_s[1] for m in asked} == {SPEED_US_PER_S}
    jogs = [b.pulse_us[1] - a.pulse_us[1] for a, b in pairwise(asked)]
    assert max(abs(step) for step in STEPS_US.values()) == 50
    assert sum(abs(jog) > 50 for jog in jogs) <= 3  # to the middle, the direction, and back to rest
    assert board.limits[1].low_us == REST - 100
    assert not any(isinstance(m, Drive | Move) for m in board.asked)


def test_ends_that_are_too_near_are_refused(own_file):
    with pytest.raises(InputError, match="no way to go"):
        taught(Lesson.SERVOS, own_file, Scripted("yes", "ok", "+", "ok"))
    assert own_file.read_bytes() == SHIPPED.read_bytes()


def test_board_that_vanishes_ends_the_lesson(own_file):
    class Vanishing(WiredBoard):
        def take(self, data):
            self.is_mute = self.is_mute or any(isinstance(m, Gains) for m in self.asked)
            super().take(data)

    person = Scripted("yes", "yes")
    with pytest.raises((LinkLost, DriverError)):
        taught(Lesson.MOTORS, own_file, person, board_class=Vanishing)
    assert "switch it off and on" in person.text


@pytest.mark.parametrize("lesson", Lesson)
def test_shipped_file_and_robot_without_board_are_refused(lesson, tmp_path):
    def ask(path):
        play_clocked(lambda clock, board, opened: teach(lesson, path, Scripted(), clock, opened))

    with pytest.raises(InputError, match="copy it"):
        ask(SHIPPED)
    other = tmp_path / "fake.toml"
    other.write_text((SHIPPED.parent / "fake.toml").read_text(encoding="utf-8"), encoding="utf-8")
    with pytest.raises(InputError, match="nothing to teach"):
        ask(other)


def test_change_that_makes_no_robot_file_is_refused_with_its_line():
    text = SHIPPED.read_text(encoding="utf-8")
    with pytest.raises(ConfigError, match=r"rover.toml:\d+: arm.servos.claw"):
        changed_text(text, {("arm", "servos", "claw", "low_us"): 9000}, "rover.toml")


def test_new_key_comes_into_its_table_and_the_mode_stays(own_file):
    own_file.chmod(0o640)
    changed = changed_text(
        own_file.read_text(encoding="utf-8"), {("arm", "servos", "claw", "reversed"): True}, "x"
    )
    write_text(own_file, changed)
    assert tomllib.loads(own_file.read_text(encoding="utf-8"))["arm"]["servos"]["claw"]["reversed"] is True
    assert own_file.stat().st_mode & 0o777 == 0o640
    assert [p.name for p in own_file.parent.iterdir()] == ["rover.toml"]
