"""Calibrate the simulated base as a real one, with a tape measure: `python models/measure_base.py`.

Wheel radius: drive straight and compare the way on the floor with the ticks. Effective track: turn on the
spot by several turns both ways and compare the heading with the ticks. What is random: many short runs, what
the wheels say against the tape measure. The truth of the simulation plays the tape measure. The numbers go
into robots/sim.toml; a test checks that they still fit.
"""

import argparse
import math
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.scene import Room, Scene
from tapreach.drivers.sim.world import World
from tapreach.estimation.odometry import WheelOdometry
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.resources import resource_path
from tapreach.robot.config import RobotDescription, load_robot
from tapreach.robot.messages import Twist

EMPTY_HALL = Scene(title="Empty hall", room=Room(x=(-4.0, 8.0), y=(-4.0, 4.0), skirting=False))


def measure_wheel_radius(description: RobotDescription, speed: float = 0.2, duration_s: float = 6.0) -> float:
    """Return the effective radius [m]: way on the floor over the angle that the wheels turned."""
    world = World(EMPTY_HALL, description, SimFaults())
    left, right, start, _ = *world.board_state().ticks, *_position(world)
    _drive(world, Twist(speed, 0.0), duration_s)
    left_end, right_end = world.board_state().ticks
    way = math.dist(_position(world), (start, 0.0))
    turns = ((left_end - left) + (right_end - right)) / 2 / description.base.ticks_per_turn
    return way / (2 * math.pi * turns)


def measure_track(
    description: RobotDescription, radius: float, rate: float, duration_s: float = 12.0
) -> float:
    """Return the effective track [m]: difference of the wheels' ways over the angle truly turned."""
    ways, angles = 0.0, 0.0
    for sense in (1.0, -1.0):
        world = World(EMPTY_HALL, description, SimFaults())
        before = world.board_state().ticks
        angles += abs(_drive(world, Twist(0.0, sense * rate), duration_s))
        left, right = (e - b for e, b in zip(world.board_state().ticks, before, strict=True))
        ways += abs(right - left) / description.base.ticks_per_turn * 2 * math.pi * radius
    return ways / angles


@dataclass(frozen=True)
class RandomErrors:
    """What is random in runs of the base: one sigma after 1 m or 1 rad, growing with the root."""

    distance_per_sqrt_m: float
    turn_deg_per_sqrt_rad: float
    drift_deg_per_sqrt_m: float
    sideways_per_sqrt_m: float


def measure_random_errors(description: RobotDescription, runs: int, seed: int = 0) -> RandomErrors:
    """Return how far short runs, a turn on the spot and an advance each, differ from what the wheels say."""
    rng = np.random.default_rng(seed)
    rows = []
    for _ in range(runs):
        turn, advance = rng.uniform(0.1, 0.6) * rng.choice((-1.0, 1.0)), rng.uniform(0.1, 0.45)
        turned, driven = _errors_of_run(description, turn, advance)
        by_turn, by_way = 1.0 / math.sqrt(abs(turn)), 1.0 / math.sqrt(advance)
        rows.append((driven.x * by_way, turned.heading * by_turn, driven.heading * by_way, driven.y * by_way))
    distance, turn, drift, sideways = np.sqrt(np.mean(np.square(rows), axis=0))
    return RandomErrors(
        float(distance), math.degrees(float(turn)), math.degrees(float(drift)), float(sideways)
    )


def _errors_of_run(
    description: RobotDescription, turn: float, advance: float
) -> tuple[PlanarPose, PlanarPose]:
    """Return how a turn, and an advance after it, truly ended, as seen from where the wheels say."""
    base, world = description.base, World(EMPTY_HALL, description, SimFaults())
    wheels = WheelOdometry(base.wheel_radius, base.track_width, base.ticks_per_turn)
    at = [(_odometry(wheels, world), _pose(world))]
    turning = Twist(0.0, math.copysign(0.7, turn))
    for twist, duration_s in ((turning, abs(turn) / 0.7), (Twist(0.2, 0.0), advance / 0.2)):
        _drive(world, twist, duration_s)
        at.append((_odometry(wheels, world), _pose(world)))
    turned, driven = (
        before[0].between(after[0]).inverse().compose(before[1].between(after[1]))
        for before, after in pairwise(at)
    )
    return turned, driven


def _odometry(wheels: WheelOdometry, world: World) -> PlanarPose:
    return wheels.update(*world.board_state().ticks, round(world.data.time * 1e9)).pose


def _pose(world: World) -> PlanarPose:
    return PlanarPose(*_position(world), _heading(world))


def _drive(world: World, twist: Twist, duration_s: float) -> float:
    """Drive, stop, and return the heading gained [rad], whole turns included."""
    total, last = 0.0, _heading(world)
    for period in range(round((duration_s + 0.5) / world.period_s)):
        world.drive(twist if period * world.period_s < duration_s else Twist(0.0, 0.0))
        world.step()
        now = _heading(world)
        total += math.remainder(now - last, 2 * math.pi)
        last = now
    return total


def _position(world: World) -> tuple[float, float]:
    x, y, _ = world.data.body("base").xpos
    return float(x), float(y)


def _heading(world: World) -> float:
    matrix = world.data.body("base").xmat
    return math.atan2(matrix[3], matrix[0])


def main() -> None:
    """Print what to write into the robot file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("robot", nargs="?", default=str(resource_path("robots") / "sim.toml"))
    description = load_robot(Path(parser.parse_args().robot))
    radii = [measure_wheel_radius(description, speed) for speed in (0.1, 0.2, 0.3)]
    radius = sum(radii) / len(radii)
    rates = (0.4, 0.7, 1.0)
    tracks = [measure_track(description, radius, rate) for rate in rates]
    print("wheel_radius", *(f"{r:.5f}" for r in radii), "-> mean", f"{radius:.5f}")  # noqa: T201
    print("track_width", *(f"{t:.5f}" for t in tracks), f"at {rates} rad/s -> mean {sum(tracks) / 3:.4f}")  # noqa: T201
    print("random", measure_random_errors(description, 30))  # noqa: T201


if __name__ == "__main__":
    main()
