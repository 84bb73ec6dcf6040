"""How large a target is, as the page shows it: by the box drawn around it, or by the pictures."""

from dataclasses import dataclass

import numpy as np

from tapreach.estimation.box_extent import BoxExtent, box_extent
from tapreach.estimation.point_estimate import PointEstimate
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import ImageSize
from tapreach.geometry.pixel_box import PixelBox
from tapreach.robot.config import RobotDescription
from tapreach.tasks.fetch.thing import NoSize, ThingSize
from tapreach.tasks.sighting import Sighting, ray_of

_AT_BORDER_PX = 2.0


@dataclass(frozen=True)
class Extent:
    """Width and height of a target; `size` is None where they cannot be told, and `reason` then says why.

    With a size, `reason` says what to know of it: that the picture's edge cuts it off.
    """

    size: BoxExtent | None
    reason: str


def extent_of(
    box: PixelBox | None, first: Sighting, estimate: PointEstimate | None, description: RobotDescription
) -> Extent | None:
    """Return the extent by the box drawn in the tapped frame; None without one, or before a position.

    first: that frame, its pose in the world of the estimate, whose reference view it is.
    """
    if box is None or estimate is None or estimate.point_in_world is None:
        return None
    # The point's own covariance is that of the way from the present base; here the first view counts.
    way = estimate.point_in_world - ray_of(first, description).origin
    covariance = estimate.relative_sd**2 * np.outer(way, way)
    return measured(box, first, estimate.point_in_world, covariance, description)


def measured(
    box: PixelBox,
    first: Sighting,
    point_in_world: FloatArray,
    point_cov_in_world: FloatArray,
    description: RobotDescription,
) -> Extent:
    """Return the extent for a point (3,) [m] on the thing's front, with its covariance (3, 3) [m²]."""
    camera, mount = description.camera.model(), description.camera.mount
    world_from_camera = first.world_from_base.to_rigid() * mount.base_from_camera()
    found = box_extent(box, camera, world_from_camera, point_in_world, point_cov_in_world)
    if not isinstance(found, BoxExtent):
        return Extent(None, found.reason)
    return Extent(found, _cut_off(box, camera.size))


def extent_of_thing(size: ThingSize | NoSize, seen: Sighting, description: RobotDescription) -> Extent:
    """Return the extent of what was measured in the pictures, its corners in the plane that faces the view
    `seen`.
    """
    if isinstance(size, NoSize):
        return Extent(None, size.reason)
    way = size.axis_in_world - ray_of(seen, description).origin
    left = np.array([-way[1], way[0], 0.0]) / max(float(np.hypot(way[0], way[1])), 1e-6)
    across, up = 0.5 * size.width * left, np.array([0.0, 0.0, 0.5 * size.height])
    sides = (across + up, up - across, -across - up, across - up)
    corners = np.stack([size.axis_in_world + side for side in sides])
    found = BoxExtent(size.width, size.height, size.width_sd, size.height_sd, corners)
    return Extent(found, size.caveat)


def _cut_off(box: PixelBox, size: ImageSize) -> str:
    """Return at which edges of the picture the thing may go on; '' where at none."""
    gaps = {
        "left": box.left,
        "upper": box.top,
        "right": size.width - 1.0 - box.right,
        "lower": size.height - 1.0 - box.bottom,
    }
    cut = [name for name, gap in gaps.items() if gap < _AT_BORDER_PX]
    return f"cut off at the picture's {' and '.join(cut)} edge: at least so large" if cut else ""
