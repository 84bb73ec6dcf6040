"""The paper's two tables, computed anew beside the published figures. Centimetres and degrees, as printed
there.

Source: Chao et al., Sensors 16(4), 2016, Tables 1 and 2.
"""

import math
from dataclasses import dataclass

from tapreach.estimation.two_tap import ScreenOffset, two_tap
from tapreach.geometry.planar_motion import PlanarStep

PIXELS_PER_CM = 48.7
FOCAL_CM = 24.03
POLE_OFFSET_CM = 36.0
TURN_DEG = 12.0
ADVANCE_CM = 20.0


@dataclass(frozen=True)
class FocalRow:
    """A row of Table 1: the printed inputs and f, and f from the printed P_X by f = Q_Z P_X / Q_X."""

    offset_px: float
    offset_cm: float
    depth_cm: float
    published_focal_cm: float

    @property
    def focal_cm(self) -> float:
        """Focal length from the row's own printed inputs [cm]."""
        return self.depth_cm * self.offset_cm / POLE_OFFSET_CM


@dataclass(frozen=True)
class DistanceRow:
    """A row of Table 2: w in pixels and as printed, the printed result and the truth."""

    offset_px: float
    offset_cm: float
    published_beta_deg: float
    published_phi_deg: float
    true_cm: float
    published_cm: float

    @property
    def beta_deg(self) -> float:
        """Eq. (6) from the rounded w."""
        return math.degrees(math.atan2(self.offset_cm, FOCAL_CM))

    @property
    def phi_deg(self) -> float:
        """Eq. (5) from the rounded w."""
        return 90.0 - self.beta_deg + TURN_DEG

    @property
    def distance_cm(self) -> float:
        """OQ1 from the rounded w, as the paper computed it."""
        return _distance_cm(self.offset_cm)

    @property
    def distance_unrounded_cm(self) -> float:
        """OQ1 from the pixels, without rounding w to two decimals."""
        return _distance_cm(self.offset_px / PIXELS_PER_CM)


def _distance_cm(offset_cm: float) -> float:
    step = PlanarStep(math.radians(TURN_DEG), ADVANCE_CM / 100.0)
    estimate = two_tap(ScreenOffset(0.0, 0.0), ScreenOffset(offset_cm, 0.0), FOCAL_CM, step)
    if estimate.position is None:
        return math.inf
    return 100.0 * estimate.position.distance


TABLE_1 = (
    FocalRow(416, 8.54, 100, 23.72),
    FocalRow(280, 5.75, 150, 23.96),
    FocalRow(212, 4.35, 200, 24.17),
    FocalRow(170, 3.49, 250, 24.27),
)
TABLE_2 = (
    DistanceRow(414, 8.50, 19.48, 82.52, 50, 51.23),
    DistanceRow(270, 5.54, 12.98, 89.02, 250, 262.05),
)
