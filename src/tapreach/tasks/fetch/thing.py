"""What is to be fetched, as far as it is known."""

from dataclasses import dataclass

from tapreach.geometry.finite import FloatArray


@dataclass(frozen=True)
class ThingSize:
    """How large the thing is and where its middle is.

    width: across the line of sight, height: foot to top [m], with one sigma each. foot: height of its lowest
    point above the floor [m]. axis_in_world (3,): its middle, half a depth behind its front, at half its
    height [m]; axis_cov_in_world (3, 3) [m²]. caveat: what to know of it, '' for nothing. seen_along:
    direction in the world of the line of sight across which the width was measured [rad]; None stands for
    that from where the base is. goes_on_above: its upper end was not found; `height` is as far as was looked.
    by_picture: the outline was found, not drawn by somebody. told: how often it was measured so, each time
    from elsewhere.
    """

    width: float
    width_sd: float
    height: float
    height_sd: float
    foot: float
    axis_in_world: FloatArray
    axis_cov_in_world: FloatArray
    caveat: str = ""
    seen_along: float | None = None
    by_picture: bool = False
    told: int = 1
    goes_on_above: bool = False


@dataclass(frozen=True)
class NoSize:
    """Why the size cannot be told, in words a person can act on.

    by_one_view: what the view from nearest tells of it, where that is an outline with both sides; one alone
    is often wrong.
    """

    reason: str
    by_one_view: ThingSize | None = None


@dataclass(frozen=True)
class Thing:
    """A located thing in the world of the present odometry: the tapped place (3,) [m] with its covariance
    (3, 3) [m²], and its size.
    """

    point_in_world: FloatArray
    point_cov_in_world: FloatArray
    size: ThingSize | NoSize
