"""What came out of one tap, against the truth.

Range: distance from the camera of the tapped frame to the tapped point of the surface. The estimate says how
far along its ray the point lies, so the range error leaves out what a wrong mount does to the direction.
Position error: distance between the point said and the true one in the frame of the base where the robot came
to rest, over the range: what an arm or a drive to it would suffer, wrong mount and odometry since included.

Regions: the range interval; the region of the position in that frame; and the one in (bearing, 1/Z) of the
tapped frame. In the last the bearing cannot err, since the true point is the one under the tapped pixel, so
that it holds more than it says even where the depth is judged rightly; it is reported and held to nothing.
"""

from dataclasses import dataclass

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.gaussian import chi2_limit, squared_mahalanobis

WRONG_SHARE = 0.05
"""Of the range: an answer off by more, and outside its own 99.9 % region, is wrong without saying so."""
REGION, SURE_REGION = chi2_limit(0.95, 3), chi2_limit(0.999, 3)
SURE_DEPTH = chi2_limit(0.999, 1)


@dataclass(frozen=True)
class Outcome:
    """One arm of one tap. Errors and regions are None where no position was given.

    range_error, position_error: over the range; the first with its sign. nees: squared Mahalanobis distance
    in (bearing, 1/Z), 3 degrees of freedom; nees_depth: of 1/Z alone, 1; nees_position: of the point in the
    base's frame, 3. holds_range: the 95 % range interval does. relative_sd: what the estimate says of itself,
    sd(1/Z)·Z. scale: what the wheels said was driven, over what was. track_px: last place followed from the
    true one. seconds: simulated, from the tap to the answer. driven [m]. moved: how far the thing itself was
    pushed [m]. note: the closing sentence, or what was raised.
    """

    tap: int
    arm: str
    scene: str
    thing: str
    distance: float
    status: str
    note: str
    seconds: float
    driven: float
    scale: float
    moved: float
    views: int
    wall_seconds: float
    range_error: float | None = None
    position_error: float | None = None
    nees: float | None = None
    nees_depth: float | None = None
    nees_position: float | None = None
    holds_range: bool | None = None
    relative_sd: float | None = None
    track_px: float | None = None
    rejected: int = 0

    @property
    def is_answered(self) -> bool:
        """True where a position was given."""
        return self.position_error is not None

    @property
    def holds_position(self) -> bool:
        """True where the 95 % region of the position in the base's frame holds the truth."""
        return self.nees_position is not None and self.nees_position <= REGION

    @property
    def holds_bearing_depth(self) -> bool:
        """True where the 95 % region in (bearing, 1/Z) does."""
        return self.nees is not None and self.nees <= REGION

    @property
    def is_far_off(self) -> bool:
        """True where range or position are off by more than 5 % of the range."""
        return max(abs(self.range_error or 0.0), self.position_error or 0.0) > WRONG_SHARE

    @property
    def is_wrong(self) -> bool:
        """True where range or position are off by more than 5 % of the range, and the truth is outside of the
        99.9 % interval of 1/Z or the 99.9 % region of the position that were given with them.
        """
        if self.nees_depth is None or self.nees_position is None:
            return False
        return self.is_far_off and (self.nees_depth > SURE_DEPTH or self.nees_position > SURE_REGION)


def region_distance(bearing_depth: FloatArray, covariance: FloatArray, point_in_camera: FloatArray) -> float:
    """Return the squared Mahalanobis distance of a true point from an estimate (X/Z, Y/Z, 1/Z)."""
    x, y, z = point_in_camera
    return squared_mahalanobis(np.array([x / z, y / z, 1.0 / z]) - bearing_depth, covariance)
