"""The simulator as a process: starts fast, keeps time, never outlives its host, never hangs it."""

import asyncio
import os
import signal
import socket
import subprocess
import sys
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any

import cv2
import numpy as np
import pytest
from sim_world import HALL, ROBOT

from tapreach.drivers.sim.child_frames import FrameSender
from tapreach.drivers.sim.robot import SimRobot
from tapreach.drivers.sim.scene import load_scene
from tapreach.drivers.sim.truth import ask_truth
from tapreach.errors import InputError, LinkLost, SetupError
from tapreach.robot.clock import SECOND, MonotonicClock
from tapreach.robot.messages import ArmState, Frame, Health, LinkStatus, Odometry, Twist

CLOCK = MonotonicClock()


@asynccontextmanager
async def running(**options: Any) -> AsyncIterator[SimRobot]:
    robot = SimRobot(ROBOT, HALL, CLOCK, **options)
    try:
        await robot.connect()
        yield robot
    finally:
        await robot.close()


async def until(subscribe: Callable[..., Any], enough: Callable[[Any], bool], timeout_s: float = 20.0) -> Any:
    """Return the first value for which `enough` holds."""
    found: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
    unsubscribe = subscribe(lambda value: found.done() or not enough(value) or found.set_result(value))
    try:
        return await asyncio.wait_for(found, timeout_s)
    finally:
        unsubscribe()


def is_alive(pid: int) -> bool:
    try:
        with open(f"/proc/{pid}/stat") as file:  # noqa: PTH123
            return file.read().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


async def gone(pid: int, timeout_s: float = 10.0) -> bool:
    deadline = CLOCK.now_ns() + round(timeout_s * SECOND)
    while is_alive(pid) and CLOCK.now_ns() < deadline:
        await asyncio.sleep(0.02)
    return not is_alive(pid)


def test_robot_drives_sees_and_tells() -> None:
    async def scenario() -> None:
        async with running(tells_truth=True) as robot:
            assert robot.health == Health(LinkStatus.RUNNING)
            frame: Frame = await until(robot.frames.subscribe, lambda f: True)
            assert frame.frame_id == 1
            picture = cv2.imdecode(np.frombuffer(frame.jpeg, np.uint8), cv2.IMREAD_COLOR)
            assert picture is not None
            assert picture.shape == (480, 640, 3)
            assert 0 < frame.received_ns - frame.captured_ns < SECOND
            odometry: Odometry = await until(robot.base.subscribe, lambda o: _kept_driving(robot, o, 0.1))
            truth = await ask_truth(robot, odometry.captured_ns)
            assert truth.base_pose.x == pytest.approx(odometry.world_from_base.x, abs=0.01)
            arm: ArmState = await until(robot.arm.subscribe, lambda a: True)
            assert arm.pose == ROBOT.arm.stowed.pose()

    asyncio.run(scenario())


def _kept_driving(robot: SimRobot, odometry: Odometry, x: float) -> bool:
    assert robot.base.drive(Twist(0.2, 0.0)) == Twist(0.2, 0.0)
    return odometry.world_from_base.x > x


def test_drive_returns_the_limited_twist_and_stillness_while_the_board_waits_for_zero() -> None:
    async def scenario() -> None:
        async with running() as robot:
            sent = robot.base.drive(Twist(7.0, 0.35))
            assert sent == Twist(pytest.approx(0.35), pytest.approx(0.0175))
            await until(robot.base.subscribe, lambda o: o.twist.linear > 0.02)
            await until(robot.base.subscribe, lambda o: o.twist == Twist(0.0, 0.0))
            assert robot.base.drive(Twist(0.2, 0.0)) == Twist(0.0, 0.0), "the board's deadman has struck"
            robot.base.drive(Twist(0.0, 0.0))
            await until(robot.base.subscribe, lambda o: not robot.base.drive(Twist(0.2, 0.0)).is_zero)

    asyncio.run(scenario())


def test_killed_simulator_is_a_lost_link_and_a_sentence() -> None:
    async def scenario() -> None:
        async with running() as robot:
            assert robot.process_id is not None
            os.kill(robot.process_id, signal.SIGKILL)
            health: Health = await until(robot.subscribe_health, lambda h: True)
            assert health.status is LinkStatus.LOST
            assert "simulator has ended" in health.reason
            with pytest.raises(LinkLost, match="simulator has ended"):
                robot.base.drive(Twist(0.0, 0.0))

    asyncio.run(scenario())


def test_close_ends_the_process_and_may_be_repeated() -> None:
    async def scenario() -> None:
        async with running() as robot:
            pid = robot.process_id
            assert pid is not None
            await robot.close()
            await robot.close()
            assert not is_alive(pid)
            with pytest.raises(LinkLost):
                robot.base.drive(Twist(0.1, 0.0))

    asyncio.run(scenario())


def test_cancelled_start_leaves_no_process() -> None:
    async def scenario() -> None:
        robot = SimRobot(ROBOT, HALL, CLOCK)
        start = asyncio.create_task(robot.connect())
        while robot.process_id is None:
            await asyncio.sleep(0)
        pid = robot.process_id
        start.cancel()
        with pytest.raises(asyncio.CancelledError):
            await start
        assert not is_alive(pid)

    asyncio.run(scenario())


HOST = """
import asyncio, sys
sys.path.insert(0, {tests!r})
from sim_world import HALL, ROBOT
from tapreach.drivers.sim.robot import SimRobot
from tapreach.robot.clock import MonotonicClock

async def main():
    robot = SimRobot(ROBOT, HALL, MonotonicClock())
    await robot.connect()
    print(robot.process_id, flush=True)
    await asyncio.sleep(60)

asyncio.run(main())
"""


def test_simulator_dies_with_a_killed_host() -> None:
    async def scenario() -> None:
        script = HOST.format(tests=os.path.dirname(__file__))  # noqa: PTH120
        with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as host:
            assert host.stdout is not None
            pid = int(await asyncio.to_thread(host.stdout.readline))
            assert is_alive(pid)
            host.kill()
            host.wait()
        assert await gone(pid)

    asyncio.run(scenario())


def test_missing_opengl_is_a_setup_error_with_the_install_line() -> None:
    async def scenario() -> None:
        robot = SimRobot(ROBOT, HALL, CLOCK, opengl="osmesa-wheel")
        with pytest.raises(SetupError, match=r"apt install .*libegl1 libgl1-mesa-dri"):
            await robot.connect()
        assert robot.process_id is None

    try:
        import lavavu_osmesa  # noqa: F401
    except ImportError:
        asyncio.run(scenario())
    else:
        pytest.skip("lavavu-osmesa is installed: this way to OpenGL works here")


def test_truth_is_refused_to_a_robot_that_was_not_made_for_it() -> None:
    async def scenario() -> None:
        async with running() as robot:
            with pytest.raises(InputError, match="tells_truth"):
                await ask_truth(robot)

    asyncio.run(scenario())


def test_constructor_starts_nothing() -> None:
    robot = SimRobot(ROBOT, load_scene("room"), CLOCK)
    assert robot.process_id is None
    assert robot.health.status is LinkStatus.STARTING
    with pytest.raises(LinkLost):
        robot.base.drive(Twist(0.0, 0.0))


def test_sender_never_waits_for_a_slow_reader() -> None:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        sender = FrameSender(ours)
        taken = [sender.send(b"x" * 1_000_000) for _ in range(12)]
        assert taken[0]
        assert not taken[-1], "pictures are dropped while one is on its way"
        theirs.setblocking(False)
        while not sender.is_free():
            theirs.recv(1 << 20)
        assert sender.send(b"newest")
