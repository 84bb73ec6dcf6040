"""How large a target is, as the page shows it."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from tapreach.estimation.box_extent import EDGE_SIGMA, BoxExtent, box_extent
from tapreach.estimation.point_estimate import PointEstimate
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel_box import PixelBox
from tapreach.robot.config import RobotDescription
from tapreach.tasks.sighting import Sighting, ray_of

_AT_BORDER_PX = 2.0


class ExtentSource(StrEnum):
    """Who said where the thing ends: the operator's box, or the picture around a tap."""

    BOX = "box"
    OUTLINE = "outline"


@dataclass(frozen=True)
class Outline:
    """Where a thing ends in the tapped frame, and how sure that is (sigma of each edge [px])."""

    source: ExtentSource
    box: PixelBox
    edge_sigma: float = EDGE_SIGMA
    reason: str = ""
    """What to know of it; '' when nothing."""


@dataclass(frozen=True)
class Extent:
    """Width and height of a target; `size` is None where they cannot be told, and `reason` then says why.

    With a size, `reason` says what to know of it: that it is a guess, or cut off by the picture's edge.
    """

    source: ExtentSource
    size: BoxExtent | None
    reason: str


def extent_of(
    outline: Outline | None, first: Sighting, estimate: PointEstimate | None, description: RobotDescription
) -> Extent | None:
    """Return the extent by the outline in the tapped frame `first`; None before there is a position.

    first: its pose in the world of the estimate, whose reference view it is.
    """
    if outline is None or estimate is None or estimate.point_in_world is None:
        return None
    # The point's own covariance is that of the way from the present base; here the first view counts.
    way = estimate.point_in_world - ray_of(first, description).origin
    covariance = estimate.relative_sd**2 * np.outer(way, way)
    return measured(outline, first, estimate.point_in_world, covariance, description)


def measured(
    outline: Outline,
    first: Sighting,
    point_in_world: FloatArray,
    point_cov_in_world: FloatArray,
    description: RobotDescription,
) -> Extent:
    """Return the extent for a point (3,) [m] on the thing's front, with its covariance (3, 3) [m²]."""
    camera, mount = description.camera.model(), description.camera.mount
    found = box_extent(
        outline.box,
        camera,
        first.world_from_base.to_rigid() * mount.base_from_camera(),
        point_in_world,
        point_cov_in_world,
        edge_sigma=outline.edge_sigma,
    )
    if not isinstance(found, BoxExtent):
        return Extent(outline.source, None, found.reason)
    size = camera.size
    return Extent(outline.source, found, _cut_off(outline.box, size.width, size.height) or outline.reason)


def _cut_off(box: PixelBox, width: int, height: int) -> str:
    """Return at which edges of the picture the thing may go on; '' where at none."""
    gaps = {
        "left": box.left,
        "upper": box.top,
        "right": width - 1.0 - box.right,
        "lower": height - 1.0 - box.bottom,
    }
    cut = [name for name, gap in gaps.items() if gap < _AT_BORDER_PX]
    return f"cut off at the picture's {' and '.join(cut)} edge: at least so large" if cut else ""
