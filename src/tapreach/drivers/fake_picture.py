"""The fake robot's view: a floor grid and a few coloured boxes, drawn with the robot's own camera model."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.geometry.camera import Camera
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import CameraSection

Points = NDArray[np.float64]
Picture = NDArray[np.uint8]
Colour = tuple[int, int, int]

NEAREST = 0.03
"""What is nearer to the camera than this [m] is cut off."""
SKY, FLOOR, LINE = (205, 195, 180), (150, 160, 165), (95, 105, 110)
JPEG_QUALITY = 80


@dataclass(frozen=True)
class Box:
    """An upright box on the floor: middle, edge lengths [m], colour (blue, green, red)."""

    x: float
    y: float
    length: float
    width: float
    height: float
    colour: Colour

    def faces_in_world(self) -> Points:
        """Return the five faces that can be seen, (5, 4, 3): front, back, right, left, top."""
        x = self.x + self.length * np.array([-0.5, 0.5])
        y = self.y + self.width * np.array([-0.5, 0.5])
        corners = np.array([[x[i], y[j], k * self.height] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
        return corners[[[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [1, 3, 7, 5]]]


BOXES = (
    Box(0.9, 0.05, 0.07, 0.07, 0.12, (40, 40, 200)),
    Box(1.3, -0.35, 0.12, 0.20, 0.15, (190, 90, 30)),
    Box(1.8, 0.45, 0.15, 0.15, 0.25, (60, 150, 50)),
    Box(-1.2, 0.3, 0.15, 0.25, 0.20, (40, 170, 220)),
)


def floor_grid(extent: float = 4.0, spacing: float = 0.25, piece: float = 0.5) -> Points:
    """Return short segments of a square grid on the floor around the world's origin, (n, 2, 3)."""
    lines = np.arange(-extent, extent + 1e-9, spacing)
    starts = np.arange(-extent, extent - 1e-9, piece)
    across, along = (grid.ravel() for grid in np.meshgrid(lines, starts))
    flat = np.zeros_like(along)
    ahead = np.stack([[along, across, flat], [along + piece, across, flat]])
    aside = ahead[:, [1, 0, 2]]
    return np.concatenate([ahead, aside], axis=2).transpose(2, 0, 1)


class FakePicture:
    """Draws what the camera of a robot file sees from a pose; no shadows, no textures, no noise."""

    def __init__(self, section: CameraSection, boxes: tuple[Box, ...] = BOXES) -> None:
        self._camera: Camera = section.model()
        self._camera_from_base = section.mount.base_from_camera().inv()
        self._grid_in_world = floor_grid()
        self._faces_in_world = np.concatenate([box.faces_in_world() for box in boxes])
        self._colours = [box.colour for box in boxes for _ in range(5)]
        self._background = self._sky_and_floor()

    def jpeg(self, world_from_base: PlanarPose, label: str) -> bytes:
        """Return the picture from `world_from_base` with `label` in its corner, as JPEG."""
        picture = self._background.copy()
        camera_from_world = self._camera_from_base * world_from_base.to_rigid().inv()
        self._draw_grid(picture, camera_from_world.apply(self._grid_in_world.reshape(-1, 3)))
        self._draw_boxes(picture, camera_from_world.apply(self._faces_in_world.reshape(-1, 3)))
        cv2.putText(picture, label, (8, 20), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (40, 40, 40), 1)
        _, encoded = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
        return encoded.tobytes()

    def _sky_and_floor(self) -> Picture:
        size = self._camera.size
        picture = np.empty((size.height, size.width, 3), np.uint8)
        picture[:] = SKY
        picture[self._row_of_horizon() :] = FLOOR
        return picture

    def _row_of_horizon(self) -> int:
        # The horizon is where level directions straight ahead fall; the camera does not roll in flight.
        ahead_in_camera = self._camera_from_base.rotation.apply([1.0, 0.0, 0.0])
        projection = self._camera.project([ahead_in_camera])
        if projection.is_valid[0]:
            return int(np.clip(round(projection.pixels[0, 1]), 0, self._camera.size.height))
        return 0 if ahead_in_camera[1] < 0 else self._camera.size.height

    def _draw_grid(self, picture: Picture, points_in_camera: Points) -> None:
        segments = points_in_camera.reshape(-1, 2, 3)
        segments = segments[segments[:, :, 2].max(axis=1) > NEAREST]
        pixels = self._pixels(_clipped_near(segments).reshape(-1, 3)).reshape(-1, 2, 2)
        limit = 8 * np.array([self._camera.size.width, self._camera.size.height])
        pixels = pixels[np.all((pixels.max(axis=1) >= 0) & (pixels.min(axis=1) <= limit), axis=1)]
        cv2.polylines(picture, list(pixels), False, LINE, 1, cv2.LINE_AA, 3)

    def _draw_boxes(self, picture: Picture, points_in_camera: Points) -> None:
        faces = points_in_camera.reshape(-1, 4, 3)
        distances = np.linalg.norm(faces.mean(axis=1), axis=1)
        for index in np.argsort(-distances):
            if faces[index, :, 2].min() > NEAREST:
                shade = (0.75, 0.75, 0.55, 0.65, 1.0)[index % 5]
                colour = tuple(shade * part for part in self._colours[index])
                cv2.fillConvexPoly(picture, self._pixels(faces[index]), colour, cv2.LINE_AA, 3)

    def _pixels(self, points_in_camera: Points) -> NDArray[np.int32]:
        # Three bits behind the point, as cv2's shift wants; far off the picture is as good as infinity.
        pixels = self._camera.project(points_in_camera).pixels
        return np.asarray(np.clip(np.rint(pixels * 8.0), -60000, 60000), dtype=np.int32)


def _clipped_near(segments: Points) -> Points:
    """Return segments (n, 2, 3), at least one end in front, with the part nearer than NEAREST cut off."""
    start, end = segments[:, 0], segments[:, 1]
    way = end[:, 2] - start[:, 2]
    share = (NEAREST - start[:, 2]) / np.where(way == 0.0, 1.0, way)
    cut = start + np.clip(share, 0.0, 1.0)[:, None] * (end - start)
    start = np.where((start[:, 2] < NEAREST)[:, None], cut, start)
    end = np.where((end[:, 2] < NEAREST)[:, None], cut, end)
    return np.stack([start, end], axis=1)
