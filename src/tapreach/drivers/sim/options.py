"""Which scene and faults: the command line over the robot file over the scene file."""

from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel, ConfigDict, ValidationError

from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.scene import Scene, load_scene
from tapreach.drivers.sim.scene_random import random_scene
from tapreach.errors import ConfigError
from tapreach.robot.config import RobotDescription


class SimulationSection(BaseModel):
    """The table `[simulation]` of a robot file."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    scene: str = "room"
    seed: int | None = None
    faults: dict[str, Any] = {}


def simulation_section(description: RobotDescription) -> SimulationSection:
    """Return the table [simulation], checked. Raises ConfigError naming the known keys."""
    try:
        return SimulationSection.model_validate(description.simulation)
    except ValidationError as error:
        fault = error.errors()[0]
        key = ".".join(str(part) for part in fault["loc"])
        known = ", ".join(SimulationSection.model_fields)
        raise ConfigError(
            f"[simulation] of the robot file: {key}: {fault['msg']}; known keys: {known}"
        ) from None


def resolve_scene(
    description: RobotDescription,
    scene: str | None = None,
    seed: int | None = None,
    faults: Mapping[str, Any] | None = None,
) -> tuple[Scene, SimFaults]:
    """Return scene and faults to use; arguments that are given win over the robot file.

    A seed makes a random scene of its own and wins over a scene. Raises ConfigError.
    """
    section = simulation_section(description)
    if seed is None and scene is None:
        seed = section.seed
    chosen = load_scene(scene or section.scene) if seed is None else random_scene(seed)
    return chosen, chosen.faults.merged(section.faults).merged(faults or {})
