"""Makes the simulated robot that a robot file describes."""

from tapreach.drivers.sim.options import resolve_scene, simulation_section
from tapreach.drivers.sim.robot import SimRobot
from tapreach.robot.clock import Clock
from tapreach.robot.config import RobotDescription


def make_sim_robot(description: RobotDescription, clock: Clock) -> SimRobot:
    """Return the robot in the scene and with the faults of the table [simulation]. Raises ConfigError."""
    scene, faults = resolve_scene(description)
    return SimRobot(description, scene, clock, faults, simulation_section(description).seed or 0)
