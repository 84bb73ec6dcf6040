"""All checks of a robot, in the order in which a fault in one explains the next."""

from pathlib import Path

from tapreach.cli.checkup.board_check import check_board
from tapreach.cli.checkup.camera_check import check_camera, check_frames
from tapreach.cli.checkup.check import Check, Verdict
from tapreach.cli.checkup.machine_check import check_disk, check_wifi
from tapreach.drivers.arduino.factory import make_robot_camera
from tapreach.drivers.arduino.parts import CameraFactory, NoCamera
from tapreach.drivers.arduino.robot import ArduinoRobot
from tapreach.drivers.arduino.visit import BoardVisit
from tapreach.drivers.registry import make_robot
from tapreach.errors import TapreachError
from tapreach.robot.clock import SECOND, Clock
from tapreach.robot.config import RobotDescription

LOOK_NS = 1 * SECOND


async def examine(
    description: RobotDescription,
    clock: Clock,
    captures: Path,
    make_camera: CameraFactory = make_robot_camera,
) -> list[Check]:
    """Look at everything of a robot; nothing of it moves. What is broken is a check, never an exception."""
    if description.driver == "arduino":
        camera = check_camera(make_camera(description, clock), description.camera, clock)
        checks = [await camera, *await _board(description, clock)]
    else:
        checks = await _made_robot(description, clock)
    return [*checks, check_wifi(_needs_network(description)), check_disk(captures)]


async def _board(description: RobotDescription, clock: Clock) -> list[Check]:
    assert description.link is not None
    if description.link.protocol != "tapreach":
        return await _bridge(description, clock)
    async with BoardVisit(description.link, clock) as visit:
        return await check_board(visit, description.arm, clock)


async def _bridge(description: RobotDescription, clock: Clock) -> list[Check]:
    """A board of ros_arduino_bridge answers questions and tells nothing of itself."""
    robot = ArduinoRobot(description, clock, lambda *_: NoCamera())
    readings: list[object] = []
    robot.base.subscribe(readings.append)
    await robot.connect()
    try:
        await clock.sleep_until(clock.now_ns() + LOOK_NS)
        health = robot.health
    finally:
        await robot.close()
    if not health.is_running:
        return [Check("link", Verdict.FAIL, "the board does not answer", health.reason)]
    found = f"answers; {len(readings)} encoder readings in {LOOK_NS / SECOND:g} s and while connecting"
    reduced = "ros_arduino_bridge tells nothing of version, battery, servos or faults"
    return [
        Check("link", Verdict.OK, found, "", {"readings": len(readings)}),
        Check("firmware", Verdict.WARN, reduced, "firmware/ does: tapreach firmware flash, if you may"),
    ]


async def _made_robot(description: RobotDescription, clock: Clock) -> list[Check]:
    """A robot that is no hardware: the same questions through its common interface."""
    robot = make_robot(description, clock)
    try:
        await robot.connect()
        camera = await check_frames(robot.frames, description.camera, clock, robot.health.reason)
        health = robot.health
    except TapreachError as error:
        return [Check("link", Verdict.FAIL, "the robot does not start", str(error))]
    finally:
        await robot.close()
    verdict = Verdict.OK if health.is_running else Verdict.FAIL
    found = f"driver {description.driver!r} {'answers' if health.is_running else 'does not answer'}"
    return [camera, Check("link", verdict, found, health.reason)]


def _needs_network(description: RobotDescription) -> bool:
    source = description.camera.source or ""
    is_remote = description.link is not None and not description.link.is_device
    return is_remote or source.startswith(("http:", "rtsp:"))
