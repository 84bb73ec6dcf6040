"""A board of ros_arduino_bridge: what its firmware lacks is kept here."""

import asyncio

import pytest
from tests.drivers.arduino.memory import ClockedRobot, drive, play_on

from tapreach.drivers.arduino.ros_lines import counts_of
from tapreach.robot.clock import MS, SECOND, ManualClock
from tapreach.robot.messages import STILL, LinkStatus, Twist

RATE_HZ = 30.0


class RosPeer:
    """Answers lines, and drives on for 2 s after the last m, as that firmware does."""

    def __init__(self, clock):
        self._clock, self._text = clock, b""
        self.write = lambda data: None
        self.ticks, self.wanted, self.heard, self.servos = [0.0, 0.0], (0, 0), [], {}
        self._stepped_ns = self._m_ns = clock.now_ns()
        self.is_mute, self.spoiled = False, []

    def take(self, data):
        *lines, self._text = (self._text + data).split(b"\r")
        for line in lines:
            answer = self.spoiled.pop() if self.spoiled else self._answer(line.decode().split())
            if not self.is_mute:
                self.write(answer.encode() + b"\r\n")

    def _answer(self, words):
        if words[:1] == ["e"]:
            return f"{int(self.ticks[0])} {int(self.ticks[1])}"
        if words[:1] == ["m"]:
            self.wanted, self._m_ns = (int(words[1]), int(words[2])), self._clock.now_ns()
            self.heard.append((self._m_ns, self.wanted))
            return "OK"
        if words[:1] == ["s"]:
            self.servos[int(words[1])] = int(words[2])
            return "OK"
        return "Invalid Command"

    def step(self):
        now_ns = self._clock.now_ns()
        elapsed, self._stepped_ns = (now_ns - self._stepped_ns) / SECOND, now_ns
        if now_ns - self._m_ns > 2 * SECOND:
            self.wanted = (0, 0)
        self.ticks = [t + w * RATE_HZ * elapsed for t, w in zip(self.ticks, self.wanted, strict=True)]


def play(scenario):
    async def run():
        clock = ManualClock()
        await play_on(ClockedRobot(RosPeer(clock), clock, "ros-arduino"), scenario)

    asyncio.run(run())


def test_wheels_speed_up_by_ramps_and_odometry_counts():
    async def scenario(robot):
        await drive(robot, Twist(0.25, 0.0), SECOND)
        speeds = [wanted[0] for _, wanted in robot.board.heard if wanted != (0, 0)]
        assert speeds == sorted(speeds)
        assert speeds[0] < 0.4 * speeds[-1]
        assert robot.base.drive(Twist(0.25, 0.0)).linear == pytest.approx(0.25, abs=0.003)
        assert robot.odometry[-1].world_from_base.x == pytest.approx(0.25 - 0.25**2 / 1.6, abs=0.04)

    play(scenario)


def test_silent_host_stops_the_wheels_within_the_deadman_and_a_zero_comes_first():
    async def scenario(robot):
        await drive(robot, Twist(0.2, 0.0), 500 * MS)
        assert robot.board.wanted[0] > 0
        last_ns = robot.clock.now_ns()
        await robot.pass_time(400 * MS)
        at_ns, wanted = robot.board.heard[-1]
        assert wanted == (0, 0)
        assert at_ns - last_ns <= 160 * MS
        assert robot.base.drive(Twist(0.2, 0.0)) == STILL
        robot.base.drive(STILL)
        await drive(robot, Twist(0.2, 0.0), 200 * MS)
        assert robot.board.wanted[0] > 0

    play(scenario)


def test_garbled_counts_never_become_odometry():
    async def scenario(robot):
        await drive(robot, Twist(0.2, 0.0), 300 * MS)
        assert robot.odometry[-1].world_from_base.x > 0.01
        robot.board.spoiled += ["", "OK", "12", "999999 0", "Invalid Command"]
        await drive(robot, STILL, 3 * SECOND)
        assert all(abs(reading.world_from_base.x) < 0.2 for reading in robot.odometry)

    play(scenario)


def test_servos_walk_in_whole_degrees_and_arrive():
    async def scenario(robot):
        sent = robot.arm.move(robot.description.arm.standard.pose())
        await robot.until(lambda: robot.arms[-1].target == sent and not robot.arms[-1].is_moving)
        await robot.pass_time(SECOND)
        assert robot.board.servos[0] == 93  # 1500 us

    play(scenario)


def test_board_that_falls_mute_is_lost_and_comes_back():
    async def scenario(robot):
        robot.board.is_mute = True
        await robot.pass_time(2 * SECOND)
        assert robot.health.status is LinkStatus.LOST
        assert "ros_arduino_bridge" in robot.health.reason
        robot.board.is_mute = False
        await robot.until(lambda: robot.health.is_running)

    play(scenario)


@pytest.mark.parametrize("line", ["", "OK", "1", "1 2 3", "1  2", "a b", "1.0 2"])
def test_what_is_no_pair_of_counts_is_not_taken_for_one(line):
    assert counts_of(line) is None
