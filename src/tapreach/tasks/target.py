"""A target as the page shows it: where it is, how sure that is, and from what."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from tapreach.geometry.ray import Ray
from tapreach.tasks.extent import Extent


class TargetSource(StrEnum):
    """What the position rests on."""

    FLOOR = "floor"
    LOCATE = "locate"
    TWO_TAP = "two_tap"


@dataclass(frozen=True)
class Target:
    """A tapped thing. Position and covariance are None until there is an answer; `reason` then says why."""

    target_id: int
    source: TargetSource
    status: str
    reason: str
    advice: str
    frame_id: int
    """The frame that was tapped."""
    u: float
    v: float
    point_in_world: NDArray[np.float64] | None
    """(3,) [m]"""
    point_cov_in_world: NDArray[np.float64] | None
    """(3, 3) [m²], one sigma squared"""
    range: float | None
    """Distance from the present base origin's vertical, on the floor [m]."""
    range_interval: tuple[float, float] | None
    """95 % [m]; the far end may be infinite."""
    rays_in_world: tuple[Ray, ...] = ()
    """Lines of sight used, for the plan view."""
    is_following: bool = False
    """True while the tracker has it in the picture."""
    extent: Extent | None = None
    """How large it is; None where no box was drawn, or before there is a position."""
