"""The picture of a target while the robot moves: one call of the compute process for each followed frame."""

from collections.abc import Sequence
from dataclasses import dataclass

from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.estimating import LocatedPoint, estimate
from tapreach.tasks.known_place import KnownPlace
from tapreach.tasks.sighting import Passed, Sighting
from tapreach.tasks.target import Target
from tapreach.tasks.target_report import TargetReport


@dataclass(frozen=True, eq=False)
class OnlinePicture:
    """What is known in this frame, and as it is shown. estimate: None from one sighting alone."""

    estimate: LocatedPoint | None
    target: Target


@dataclass(frozen=True)
class Seen:
    """What there is to show in a frame.

    sightings: those that count, in the order of time. newest: the last one. loss: why the place is not seen
    in the newest frame, '' while it is. here: the base by the wheels. known: where it was by an earlier look.
    way: see at_present.
    """

    sightings: Sequence[Sighting]
    newest: Sighting
    loss: str
    here: PlanarPose
    known: KnownPlace | None = None
    way: Sequence[Sighting | Passed] = ()


def online_picture(seen: Seen, report: TargetReport) -> OnlinePicture:
    """Return the estimate with the newest sighting, as far as that fits, and the target for the page.

    A single frame that does not fit must not open the way of all before it, so it is left out.
    """
    sightings, newest = list(seen.sightings), seen.newest
    is_unconfirmed = newest.frame_id > sightings[-1].frame_id
    if is_unconfirmed:
        sightings.append(newest)
    found = None
    if len(sightings) > 1 or seen.known is not None:
        found = estimate(sightings, report.description, False, is_unconfirmed, seen.known)
    target = report.target(sightings, found, not seen.loss, seen.loss, seen.here, seen.way)
    return OnlinePicture(found, target)
