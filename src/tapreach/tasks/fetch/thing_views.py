"""The views in which a thing was followed, and what each of them shows of it with the help of the others."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tapreach.estimation.thing_raster import PlacedView, UprightRaster
from tapreach.estimation.thing_size import Silhouette, silhouette
from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray
from tapreach.robot.config import RobotDescription
from tapreach.tasks.sighting import Sighting
from tapreach.vision.image_io import Color
from tapreach.vision.thing_cut import CutOut, cut_out
from tapreach.vision.thing_parallax import Mask, Parallax, Surface, warped
from tapreach.vision.thing_picture import picture_of_view

_OTHERS, _REFERENCES = 6, 3
_AT_THING = 1.0, 0.97, 1.04
_ELSEWHERE = 0.75, 1.25, 1.5, 2.0, 3.0, 7.0
"""Distances supposed, in distances of the thing; the floor beside them."""
_APART = 0.04
"""References stand so far apart [m]."""
_GAP, _FARTHER = 30.0, 0.3
"""Pixels cut off by the picture that count as much as being so much farther away [m]."""
_BELOW_FLOOR = 0.02
"""An outline may end so far below where the floor should be [m]."""
_NOWHERE = -1e3


@dataclass(frozen=True)
class ThingView:
    """A view with its picture, decoded when first asked for."""

    placed: PlacedView
    jpeg: bytes
    lens: Camera
    gap: float
    """How far the thing's surroundings stay from the edge of the picture, below 0 beyond it [px]."""

    @cached_property
    def picture(self) -> Color:
        """The picture without the lens's distortion, in roots of brightness; black where it is broken."""
        return picture_of_view(self.jpeg, self.lens)


@dataclass(frozen=True)
class Seen:
    """What one view shows, and how surely."""

    silhouette: Silhouette
    cut: CutOut

    @property
    def goes_on_above(self) -> bool:
        """True where the outline has no upper end on the raster."""
        return self.cut.outline.top == 0


def views_of(
    sightings: Sequence[Sighting],
    jpegs: Mapping[int, bytes],
    description: RobotDescription,
    point: FloatArray,
) -> list[ThingView]:
    """Return the views of the sightings that have a picture, in order, for a located point (3,) [m]."""
    lens, mount = description.camera.model(), description.camera.mount.base_from_camera()
    pinhole = Camera(lens.size, lens.fx, lens.fy, lens.cx, lens.cy)
    views = []
    for sighting in sightings:
        if sighting.frame_id not in jpegs:
            continue
        pixel = lens.normalise([sighting.pixel.to_array()])[0] * [lens.fx, lens.fy] + [lens.cx, lens.cy]
        placed = PlacedView(pinhole, sighting.world_from_base.to_rigid() * mount, pixel)
        views.append(ThingView(placed, jpegs[sighting.frame_id], lens, _gap(placed, point)))
    return views


def _gap(view: PlacedView, point: FloatArray) -> float:
    """Return how far a thing of usual size about the point would stay from the edge of the picture [px]."""
    raster = UprightRaster.facing(view, point)
    if raster is None:
        return _NOWHERE
    corners = [
        point + across * raster.left + np.array([0.0, 0.0, height - point[2]])
        for across in (-0.07, 0.07)
        for height in (max(0.0, point[2] - 0.12), point[2] + 0.08)
    ]
    seen = view.camera.project(view.world_from_camera.inv().apply(np.array(corners)))
    if not np.all(seen.is_valid):
        return _NOWHERE
    pixels = seen.pixels
    width, height = view.camera.size.width, view.camera.size.height
    return float(min(pixels.min(), (width - 1 - pixels[:, 0]).min(), (height - 1 - pixels[:, 1]).min()))


def references(views: Sequence[ThingView], point: FloatArray) -> list[int]:
    """Return the views best seen from, best first, each some way from the others."""
    places = [view.placed.world_from_camera.translation for view in views]
    distances = [float(np.linalg.norm((point - place)[:2])) for place in places]
    ranked = sorted(range(len(views)), key=lambda i: -min(views[i].gap, 0.0) / _GAP + distances[i] / _FARTHER)
    chosen: list[int] = []
    for i in ranked:
        if all(np.linalg.norm(places[i] - places[j]) > _APART for j in chosen):
            chosen.append(i)
    return chosen[:_REFERENCES]


def seen_from(
    views: Sequence[ThingView], reference: int, point: FloatArray, point_height_sd: float
) -> Seen | None:
    """Return what one view shows of the thing, with the help of the others."""
    raster = UprightRaster.facing(views[reference].placed, point)
    if raster is None:
        return None
    shape = raster.rows, raster.columns
    here = views[reference]
    picture, is_seen = warped(here.picture, raster.to_plane(here.placed, 1.0), shape)
    others = [view for i, view in enumerate(views) if i != reference]
    others = [others[i] for i in np.unique(np.linspace(0, len(others) - 1, _OTHERS).round().astype(int))]
    parallax = _parallax(raster, picture, is_seen, others)
    last_row = raster.row_at(-_BELOW_FLOOR)
    cut = cut_out(picture, is_seen, parallax, (raster.row, raster.column), last_row, raster.cell)
    outline = cut.outline
    return Seen(silhouette(raster, outline.axis, outline.top, outline.half_widths, point_height_sd), cut)


def _parallax(raster: UprightRaster, picture: Color, is_seen: Mask, others: Sequence[ThingView]) -> Parallax:
    floor = raster.floor_shares()
    placed = [view.placed for view in others]

    def plane(share: float) -> Surface:
        return Surface(share < floor, tuple(raster.to_plane(view, share) for view in placed))

    on_floor = Surface(np.isfinite(floor), tuple(raster.to_floor(view) for view in placed))
    elsewhere = [on_floor, *(plane(share) for share in _ELSEWHERE)]
    at_thing = [plane(share) for share in _AT_THING]
    return Parallax(picture, [view.picture for view in others], at_thing, elsewhere, floor, is_seen)
