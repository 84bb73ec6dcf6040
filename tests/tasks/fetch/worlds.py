"""Things, obstacles and robots for the tests of planning."""

import math
from collections.abc import Sequence

import numpy as np
from hypothesis import strategies as st

from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.config import RobotDescription
from tapreach.tasks.fetch.approach import Approach
from tapreach.tasks.fetch.body import Body
from tapreach.tasks.fetch.obstacle import Obstacle, out_of
from tapreach.tasks.fetch.thing import Thing, ThingSize
from tasks.rig import sim_description

ROBOT = sim_description()
BODY = Body.of(ROBOT)


def size_at(
    x: float,
    y: float,
    width: float = 0.05,
    height: float = 0.1,
    foot: float = 0.0,
    width_sd: float = 0.002,
    height_sd: float = 0.003,
    place_sd: float = 0.01,
) -> ThingSize:
    axis = np.array([x, y, foot + height / 2.0])
    return ThingSize(width, width_sd, height, height_sd, foot, axis, place_sd**2 * np.eye(3))


def thing_at(x: float, y: float, **size: float) -> Thing:
    known = size_at(x, y, **size)
    return Thing(known.axis_in_world, known.axis_cov_in_world, known)


def obstacle_at(name: str, x: float, y: float, radius: float = 0.08, sd: float = 0.005) -> Obstacle:
    return Obstacle.around(name, (x, y), sd**2 * np.eye(2), radius)


def moved(thing: Thing, pose: PlanarPose) -> Thing:
    """The same thing in a world in which the old one lies at `pose`."""
    turn = pose.to_rigid().as_matrix()[:3, :3]
    size = thing.size
    assert isinstance(size, ThingSize)
    axis = pose.to_rigid().apply(size.axis_in_world)
    cov = turn @ size.axis_cov_in_world @ turn.T
    there = ThingSize(size.width, size.width_sd, size.height, size.height_sd, size.foot, axis, cov)
    point = pose.to_rigid().apply(thing.point_in_world)
    return Thing(point, turn @ thing.point_cov_in_world @ turn.T, there)


def moved_obstacle(obstacle: Obstacle, pose: PlanarPose) -> Obstacle:
    start, end = out_of(pose, np.array([obstacle.start, obstacle.end]))
    return Obstacle(obstacle.name, start, end, obstacle.radius, obstacle.spread)


def mirrored_robot(robot: RobotDescription = ROBOT) -> RobotDescription:
    """The same robot as seen in a mirror along its heading."""
    mount, arm = robot.camera.mount, robot.arm
    low, high = arm.rotation_limits_deg
    flipped = {"left": -mount.left, "yaw_deg": -mount.yaw_deg, "roll_deg": -mount.roll_deg}
    arm_there = {"shoulder_left": -arm.shoulder_left, "rotation_limits_deg": (-high, -low)}
    body = tuple(part.model_copy(update={"y": (-part.y[1], -part.y[0])}) for part in robot.body)
    return robot.model_copy(
        update={
            "camera": robot.camera.model_copy(update={"mount": mount.model_copy(update=flipped)}),
            "arm": arm.model_copy(update=arm_there),
            "body": body,
        }
    )


def poses_along(
    approach: Approach, spacing: float = 0.02, turning: float = math.radians(2.0)
) -> list[PlanarPose]:
    """Poses densely along all legs, turns included."""
    poses, here = [approach.start], approach.start
    for leg in (*approach.legs, approach.last_stretch):
        turned = here.after(PlanarStep(leg.step.turn, 0.0))
        turns = np.linspace(0.0, leg.step.turn, 2 + int(abs(leg.step.turn) / turning))
        ways = np.linspace(0.0, leg.step.advance, 2 + int(abs(leg.step.advance) / spacing))
        poses += [here.after(PlanarStep(float(turn), 0.0)) for turn in turns]
        poses += [turned.after(PlanarStep(0.0, float(way))) for way in ways]
        here = here.after(leg.step)
    return poses


def gap(approach: Approach, obstacle: Obstacle, body: Body = BODY) -> float:
    """The least way between the robot's outline and where the obstacle may stand, on the whole way."""
    core = np.linspace(obstacle.start, obstacle.end, 15)
    edge = _edge(body.outline.corners)
    nearest = min(
        float(np.linalg.norm(out_of(pose, edge)[:, None] - core[None], axis=2).min())
        for pose in poses_along(approach)
    )
    return nearest - obstacle.radius - obstacle.spread


def _edge(corners: np.ndarray) -> np.ndarray:
    sides = zip(corners, np.roll(corners, -1, axis=0), strict=True)
    return np.concatenate([np.linspace(a, b, 12) for a, b in sides])


def random_obstacles(most: int = 5) -> st.SearchStrategy[Sequence[Obstacle]]:
    one = st.builds(
        lambda x, y, radius, sd: obstacle_at("the box", x, y, radius, sd),
        st.floats(-1.0, 2.5),
        st.floats(-1.2, 1.2),
        st.floats(0.02, 0.2),
        st.floats(0.0, 0.03),
    )
    return st.lists(one, max_size=most)
