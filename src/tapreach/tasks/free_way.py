"""Which way back is free: the robot has just come from there."""

from tapreach.errors import PoseExpired, PoseNotYetKnown
from tapreach.estimation.pose_history import PoseHistory
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.clock import MS, SECOND

REMEMBERED_NS = 30 * SECOND
"""What was free longer ago may not be free now."""
_EVERY_NS = 100 * MS
_BESIDE = 0.04
"""A place this far beside the straight way back does not count [m]."""
_AHEAD = 0.02


def way_behind(poses: PoseHistory) -> float:
    """Return how far [m] straight back the base came from in the last 30 s, not leaving that line since."""
    if len(poses) == 0:
        return 0.0
    newest_ns, here = poses.newest()
    farthest = 0.0
    for back in range(0, REMEMBERED_NS, _EVERY_NS):
        try:
            there = here.between(poses.at(newest_ns - back))
        except (PoseExpired, PoseNotYetKnown):
            break
        if not _is_behind(there):
            break
        farthest = max(farthest, -there.x)
    return farthest


def _is_behind(there: PlanarPose) -> bool:
    return abs(there.y) <= _BESIDE and there.x <= _AHEAD
