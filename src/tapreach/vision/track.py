"""What the tracker says about one picture, and what its caller may tell it beforehand."""

import math
from dataclasses import dataclass
from enum import StrEnum

from tapreach.geometry.pixel import Pixel


class TrackStatus(StrEnum):
    """How far the answer is to be trusted."""

    FOLLOWED = "followed"
    UNSURE = "unsure"
    LOST = "lost"


@dataclass(frozen=True, slots=True)
class Guess:
    """Where the place may be in the next picture [px], and how much larger than in the tapped frame.

    The caller knows the robot's motion and makes guesses from it: one for each supposed distance lays them
    along the epipolar line. sigma: how well the motion is known, one standard deviation across the line
    [px]; what looks alike but lies beside the line is refused. Infinite: anywhere.
    """

    u: float
    v: float
    scale: float = 1.0
    sigma: float = math.inf


@dataclass(frozen=True, slots=True)
class Track:
    """Where the place is in one picture.

    pixel: None when lost. sigma: one standard deviation of each pixel coordinate [px], 0 when lost.
    scale: size against the tapped frame. score: correlation with the tapped patch, -1 to 1. reason: why it is
    not followed, '' when it is.
    """

    status: TrackStatus
    reason: str
    pixel: Pixel | None
    sigma: float
    scale: float
    score: float

    @property
    def is_seen(self) -> bool:
        """True when there is a pixel, sure or unsure."""
        return self.pixel is not None
