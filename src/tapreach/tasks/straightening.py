"""The poses of sightings with what the background says of their headings."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tapreach.estimation.measured_turn import MeasuredTurn, with_measured_turns
from tapreach.geometry.finite import FloatArray
from tapreach.robot.config import RobotDescription
from tapreach.tasks.robot_noise import odometry_noise
from tapreach.tasks.sighting import Sighting

_HELPS = 0.5
"""The background helps where it brings the error of a heading below this share of the wheels' own."""
_NOT_ASKED = "the background was not looked at"


@dataclass(frozen=True, eq=False)
class Straightened:
    """sightings: their poses as now known, hung on the newest one, which stays as the wheels say.

    covariance: joint, of all poses (6n, 6n) against the first, as `estimate_point` takes it. reason: why the
    background does not help; '' where it does.
    """

    sightings: tuple[Sighting, ...]
    covariance: FloatArray
    reason: str


def straightened(sightings: Sequence[Sighting], description: RobotDescription) -> Straightened:
    """Return sightings, in the order of time, with poses corrected by the turns seen between them."""
    poses = [sighting.world_from_base for sighting in sightings]
    turns = _measured(sightings)
    noise = odometry_noise(description)
    by_wheels = with_measured_turns(poses, noise, [])
    corrected = with_measured_turns(poses, noise, turns)
    carry = poses[-1].compose(corrected.poses[-1].inverse())
    straight = tuple(
        replace(sighting, world_from_base=carry.compose(pose))
        for sighting, pose in zip(sightings, corrected.poses, strict=True)
    )
    heading_sd = [math.sqrt(max(0.0, each.covariance[-1, -1])) for each in (by_wheels, corrected)]
    helps = bool(turns) and heading_sd[1] <= _HELPS * heading_sd[0]
    return Straightened(straight, np.asarray(corrected.covariance), "" if helps else _why_not(sightings))


def _measured(sightings: Sequence[Sighting]) -> list[MeasuredTurn]:
    number = {sighting.frame_id: i for i, sighting in enumerate(sightings)}
    return [
        MeasuredTurn(number[turn.since_id], i, turn.excess, turn.sd)
        for i, sighting in enumerate(sightings)
        if (turn := sighting.turn) is not None and math.isfinite(turn.sd) and turn.since_id in number
    ]


def _why_not(sightings: Sequence[Sighting]) -> str:
    reasons = [each.turn.reason for each in sightings if each.turn is not None and each.turn.reason]
    return reasons[-1] if reasons else _NOT_ASKED
