"""Upright things on the floor, known exactly: tins, balls, packets; how a camera sees their outline."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import RigidTransform

from tapreach.geometry.camera import Camera
from tapreach.geometry.pixel_box import PixelBox

Points = NDArray[np.float64]


@dataclass(frozen=True)
class Thing:
    """Surface samples (n, 3) in the world [m]."""

    surface: Points

    def box(self, camera: Camera, world_from_camera: RigidTransform) -> PixelBox:
        """The box that just holds it in the picture."""
        pixels = camera.project(world_from_camera.inv().apply(self.surface)).pixels
        return PixelBox(*map(float, pixels.min(axis=0)), *map(float, pixels.max(axis=0)))

    def front(self, camera: Camera, world_from_camera: RigidTransform) -> Points:
        """The place of its surface seen in the middle of that box, (3,)."""
        in_camera = world_from_camera.inv().apply(self.surface)
        pixels = camera.project(in_camera).pixels
        middle = self.box(camera, world_from_camera).middle
        off = np.linalg.norm(pixels - [middle.u, middle.v], axis=1)
        near = np.flatnonzero(off < max(2.0, float(np.sort(off)[8])))
        return np.asarray(self.surface[near[np.argmin(in_camera[near, 2])]])

    def size(self, world_from_camera: RigidTransform) -> tuple[float, float]:
        """Its true width and height in the upright plane that faces the camera [m]."""
        way = self.surface.mean(axis=0) - world_from_camera.translation
        left = np.array([-way[1], way[0], 0.0]) / np.hypot(way[0], way[1])
        return float(np.ptp(self.surface @ left)), float(np.ptp(self.surface[:, 2]))


def tin(middle: Points, radius: float, height: float) -> Thing:
    """A cylinder that stands at `middle` (2,)."""
    angles, heights = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, 120), np.linspace(0.0, height, 40))
    c, s = np.cos(angles.ravel()), np.sin(angles.ravel())
    return Thing(np.stack([middle[0] + radius * c, middle[1] + radius * s, heights.ravel()], axis=1))


def ball(middle: Points, radius: float) -> Thing:
    """A ball that lies at `middle` (2,)."""
    angles, risings = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, 120), np.linspace(-np.pi / 2, np.pi / 2, 60))
    c, s, r = np.cos(angles.ravel()), np.sin(angles.ravel()), radius * np.cos(risings.ravel())
    heights = radius + radius * np.sin(risings.ravel())
    return Thing(np.stack([middle[0] + r * c, middle[1] + r * s, heights], axis=1))


def packet(middle: Points, size: tuple[float, float, float], yaw: float) -> Thing:
    """A cuboid that stands at `middle` (2,), turned by `yaw` [rad]."""
    x, y, z = np.meshgrid(*(np.linspace(0.0, 1.0, 26) for _ in range(3)))
    inside = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
    on_surface = inside[np.any((inside == 0.0) | (inside == 1.0), axis=1)] - [0.5, 0.5, 0.0]
    scaled = on_surface * size
    c, s = np.cos(yaw), np.sin(yaw)
    turned = scaled[:, :2] @ np.array([[c, s], [-s, c]]) + middle
    return Thing(np.column_stack([turned, scaled[:, 2]]))


def random_thing(rng: np.random.Generator) -> Thing:
    """A tin, ball or packet of 4 to 30 cm, 0.5 to 2 m ahead of the world's origin."""
    ahead, aside = rng.uniform(0.5, 2.0), rng.uniform(-0.3, 0.3)
    middle = np.array([ahead, aside * ahead])
    kind, largest = rng.integers(3), min(0.3, 0.25 * ahead)
    if kind == 0:
        return tin(middle, rng.uniform(0.02, largest / 2), rng.uniform(0.04, largest))
    if kind == 1:
        return ball(middle, rng.uniform(0.02, largest / 2))
    sides = rng.uniform(0.04, largest, 3)
    return packet(middle, (float(sides[0]), float(sides[1]), float(sides[2])), rng.uniform(0.0, np.pi))
