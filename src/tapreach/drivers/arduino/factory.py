"""Makes the robot of a robot file with driver "arduino"."""

from tapreach.drivers.arduino.parts import NoCamera, RobotCamera
from tapreach.drivers.arduino.robot import ArduinoRobot
from tapreach.robot.clock import Clock
from tapreach.robot.config import RobotDescription


def make_arduino_robot(description: RobotDescription, clock: Clock) -> ArduinoRobot:
    """Return the robot, not yet connected. Raises ConfigError."""
    return ArduinoRobot(description, clock, make_robot_camera)


def make_robot_camera(description: RobotDescription, clock: Clock) -> RobotCamera:
    """Return the camera that [camera] source names; without one there are no pictures."""
    if description.camera.source is None:
        return NoCamera()
    # Loaded where it is used only: it brings what reads cameras.
    from tapreach.drivers.camera.factory import make_camera

    return make_camera(description.camera, clock)
