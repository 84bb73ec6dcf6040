"""Which robot, and what the command line changes in its file."""

import json
from collections.abc import Sequence
from pathlib import Path

from tapreach.errors import InputError
from tapreach.resources import resource_path
from tapreach.robot.config import CameraSection, RobotDescription, load_robot


def find_robot_file(name: str) -> Path:
    """Return the file for a shipped robot's name or a path. Raises InputError listing the shipped ones."""
    if Path(name).suffix == ".toml" and Path(name).is_file():
        return Path(name)
    shipped = resource_path("robots")
    candidate = shipped / f"{name}.toml"
    if candidate.is_file():
        return candidate
    known = ", ".join(sorted(path.stem for path in shipped.glob("*.toml")))
    raise InputError(f"there is no robot {name!r}; shipped are {known}; or give the path of a .toml file")


def parse_size(text: str) -> tuple[int, int]:
    """Return width and height of '640x480'. Raises InputError."""
    width, cross, height = text.partition("x")
    if not (cross and width.isdigit() and height.isdigit()):
        raise InputError(f"picture size {text!r} is not like 640x480, 960x720 or 1280x720")
    return int(width), int(height)


def parse_faults(assignments: Sequence[str]) -> dict[str, object]:
    """Return faults of ['slip=0.02', ...]; values are read as JSON. Raises InputError."""
    faults: dict[str, object] = {}
    for assignment in assignments:
        name, _, value = assignment.partition("=")
        try:
            faults[name.strip()] = json.loads(value)
        except json.JSONDecodeError:
            raise InputError(f"fault {assignment!r} is not like slip=0.02") from None
    return faults


def describe_robot(
    robot: str, size: str | None, scene: str | None, seed: int | None, faults: Sequence[str]
) -> RobotDescription:
    """Return the robot file with the command line's changes. Raises ConfigError or InputError."""
    description = load_robot(find_robot_file(robot))
    if size is not None:
        description = resized(description, *parse_size(size))
    changes: dict[str, object] = dict(description.simulation)
    if scene is not None:
        changes |= {"scene": scene, "seed": None}
    if seed is not None:
        changes["seed"] = seed
    if faults:
        listed = changes.get("faults", {})
        changes["faults"] = (listed if isinstance(listed, dict) else {}) | parse_faults(faults)
    if changes and description.driver != "sim":
        raise InputError(f"--scene, --seed and --fault belong to the simulator, not to {robot!r}")
    return description.model_copy(update={"simulation": changes})


def resized(description: RobotDescription, width: int, height: int) -> RobotDescription:
    """Return the description with another picture size of the same lens.

    The width keeps its field of view; a flatter picture loses as much above as below.
    """
    camera = description.camera
    scale = width / camera.width
    lost_rows = (camera.height * scale - height) / 2.0
    changes: dict[str, float] = {"width": width, "height": height, "fx": camera.fx * scale}
    if camera.fy is not None:
        changes["fy"] = camera.fy * scale
    if camera.cx is not None:
        changes["cx"] = (camera.cx + 0.5) * scale - 0.5
    if camera.cy is not None:
        changes["cy"] = (camera.cy + 0.5) * scale - 0.5 - lost_rows
    resized_camera = CameraSection.model_validate(camera.model_dump(exclude_unset=True) | changes)
    return description.model_copy(update={"camera": resized_camera})
