"""How much of the tracking bench is run, and the films it is run on."""

from dataclasses import dataclass
from functools import partial

import numpy as np

from tapreach.bench.spread import spread
from tapreach.bench.tracking_film import Film, shoot
from tapreach.bench.tracking_motions import Motion
from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.scene import Scene, load_scene, scene_names
from tapreach.drivers.sim.scene_random import random_scene
from tapreach.drivers.sim.stage import Stage
from tapreach.resources import resource_path
from tapreach.robot.config import RobotDescription, load_robot

FAULTS = SimFaults(
    jpeg_quality=80, exposure_noise=0.03, motion_blur_ms=10.0, mount_pitch_deg=1.0, mount_forward=0.005
)


@dataclass(frozen=True)
class TrackingPlan:
    """scenes: names of those that ship. random_scenes: further ones out of the seed. taps: tapped points of
    each film, one film of each of `motions` in each scene. jobs: processes that draw.
    """

    seed: int
    scenes: tuple[str, ...]
    random_scenes: int = 7
    taps: int = 12
    motions: tuple[Motion, ...] = tuple(Motion)
    jobs: int = 1
    is_smoke: bool = False


def full_plan(seed: int, random_scenes: int, taps: int, jobs: int) -> TrackingPlan:
    """A plan with every scene that ships."""
    return TrackingPlan(seed, tuple(scene_names()), random_scenes, taps, jobs=jobs)


def smoke_plan(seed: int) -> TrackingPlan:
    """A plan that only shows that everything works."""
    return TrackingPlan(seed, ("room",), 0, 3, (Motion.LOCATE,), is_smoke=True)


def sim_description() -> RobotDescription:
    """Return the robot that ships with the simulator."""
    return load_robot(resource_path("robots") / "sim.toml")


def films_of(plan: TrackingPlan) -> list[Film]:
    """Return the films of all scenes. Raises SetupError when nothing can draw."""
    numbers = range(len(plan.scenes) + plan.random_scenes)
    return [film for films in spread(partial(_films, plan), numbers, plan.jobs) for film in films]


def _films(plan: TrackingPlan, number: int) -> list[Film]:
    rng = np.random.default_rng([plan.seed, number])
    name, scene = _scene(plan, number, rng)
    description, films = sim_description(), []
    with Stage(scene, description, FAULTS, int(rng.integers(1 << 31))) as stage:
        for motion in plan.motions:
            film = shoot(stage, name, motion, plan.taps, description, rng)
            films += [film] if film is not None else []
    return films


def _scene(plan: TrackingPlan, number: int, rng: np.random.Generator) -> tuple[str, Scene]:
    if number < len(plan.scenes):
        return plan.scenes[number], load_scene(plan.scenes[number])
    seed = int(rng.integers(1 << 31))
    return f"random {seed}", random_scene(seed)
