"""Drivers by name. A driver's code, and what it needs installed, is loaded only when it is chosen."""

from importlib import import_module
from typing import Protocol, cast

from tapreach.errors import ConfigError
from tapreach.robot.clock import Clock
from tapreach.robot.config import RobotDescription
from tapreach.robot.interface import Robot

FACTORIES = {
    "arduino": "tapreach.drivers.arduino.factory:make_arduino_robot",
    "fake": "tapreach.drivers.fake:FakeRobot",
    "sim": "tapreach.drivers.sim.factory:make_sim_robot",
}
"""Name in the robot file: module and what makes the robot."""


class RobotFactory(Protocol):
    """Called to make a robot that is not yet connected."""

    def __call__(self, description: RobotDescription, clock: Clock) -> Robot:
        """Return the robot. Pure: opens nothing."""
        ...


def factory_of(driver: str) -> RobotFactory:
    """Return what makes the robots of a driver. Raises ConfigError that lists the known names."""
    if driver not in FACTORIES:
        raise ConfigError(f"there is no driver {driver!r}; known are {', '.join(sorted(FACTORIES))}")
    module, name = FACTORIES[driver].split(":")
    return cast(RobotFactory, getattr(import_module(module), name))


def make_robot(description: RobotDescription, clock: Clock) -> Robot:
    """Return the robot of a robot file, not yet connected. Raises ConfigError."""
    return factory_of(description.driver)(description, clock)
