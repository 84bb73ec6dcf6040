"""The poses of sightings, and the camera's mount, with what the background says of the robot's way."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.estimation.corrected_drive import SeenStep, corrected_drive
from tapreach.estimation.motion_prior import PoseErrors
from tapreach.estimation.odometry_noise import pose_errors
from tapreach.estimation.step_knowledge import NOTHING_SEEN
from tapreach.robot.config import RobotDescription
from tapreach.tasks.robot_noise import mount_noise, odometry_noise
from tapreach.tasks.sighting import Passed, Sighting

_HELPS = 0.7
"""The background helps where it brings the error of a heading below this share of the wheels' own."""
_NOT_ASKED = "the background was not looked at"
_SAYS_LITTLE = "the background shows the turn no better than the wheels"


@dataclass(frozen=True, eq=False)
class Straightened:
    """sightings: their poses as now known, hung on the newest one, which stays as the wheels say.

    base_from_camera: as now known. errors: what is left, against the first pose, as `estimate_point` takes
    it. reason: why the background does not help; '' where it does.
    """

    sightings: tuple[Sighting, ...]
    base_from_camera: RigidTransform
    errors: PoseErrors
    reason: str


def straightened(
    sightings: Sequence[Sighting],
    description: RobotDescription,
    slipped_since: int | None = None,
    by_every_way: bool = False,
) -> Straightened:
    """Return sightings, in the order of time, with poses corrected by what was seen of the way.

    slipped_since: number of the sighting from which on the wheels are not to be trusted. by_every_way: use
    the shorter ways from a key too, which makes the poses on the way sure, and the mount surer than it is.
    """
    poses = [sighting.world_from_base for sighting in sightings]
    known = odometry_noise(description), description.camera.mount.base_from_camera(), mount_noise(description)
    steps = seen_steps(sightings, by_every_way)
    if slipped_since is not None:
        steps.append(_unseen_slip(slipped_since, len(sightings) - 1))
    corrected = corrected_drive(poses, *known, steps)
    carry = poses[-1].compose(corrected.poses[-1].inverse())
    straight = tuple(
        replace(sighting, world_from_base=carry.compose(pose))
        for sighting, pose in zip(sightings, corrected.poses, strict=True)
    )
    by_wheels = float(np.linalg.norm(pose_errors(poses, known[0])[-1, 2]))
    left = float(np.linalg.norm(corrected.errors.by_base[-1, 5]))
    has_slipped = any(step.knowledge.has_slipped for step in steps)
    helps = has_slipped or (bool(steps) and left <= _HELPS * by_wheels)
    reason = "" if helps else _why_not(sightings)
    return Straightened(straight, corrected.base_from_camera, corrected.errors, reason)


def seen_steps(sightings: Sequence[Sighting | Passed], by_every_way: bool = False) -> list[SeenStep]:
    """Return what to believe of the ways seen from each key, by the numbers of the sightings."""
    number = {sighting.frame_id: i for i, sighting in enumerate(sightings)}
    ways: dict[int, list[SeenStep]] = {}
    for i, sighting in enumerate(sightings):
        way = sighting.way
        if way is not None and not way.reason and way.since_id in number:
            ways.setdefault(way.since_id, []).append(SeenStep(number[way.since_id], i, way.knowledge))
    return [step for of_key in ways.values() for step in _believed(of_key, by_every_way)]


def _believed(of_key: list[SeenStep], by_every_way: bool) -> list[SeenStep]:
    """Return the longest way from one key: shorter ones share its errors and say no more of the end.

    A slip that it alone shows may be a background that has gone or is hidden. Then the longest of the others
    is taken, and for the rest of the way neither wheels nor pictures.
    """
    *others, longest = of_key
    is_alone = bool(others) and not any(other.knowledge.has_slipped for other in others)
    if not longest.knowledge.has_slipped or not is_alone:
        return [*(other for other in others if by_every_way and not other.knowledge.has_slipped), longest]
    return [*(others if by_every_way else others[-1:]), _unseen_slip(others[-1].second, longest.second)]


def _unseen_slip(first: int, second: int) -> SeenStep:
    return SeenStep(first, second, replace(NOTHING_SEEN, has_slipped=True))


def _why_not(sightings: Sequence[Sighting]) -> str:
    ways = [each.way for each in sightings if each.way is not None]
    if not ways:
        return _NOT_ASKED
    return next((way.reason for way in reversed(ways) if way.reason), _SAYS_LITTLE)
