"""Where the base was when a frame was captured: poses by time, interpolated, in bounded memory."""

from bisect import bisect_left, bisect_right
from collections import deque

from tapreach.errors import InputError, PoseExpired, PoseNotYetKnown
from tapreach.geometry.planar_motion import PlanarPose


class PoseHistory:
    """The newest `capacity` poses world_from_base by their time [ns, monotonic]."""

    def __init__(self, capacity: int = 3000) -> None:
        if capacity < 2:
            raise InputError(f"capacity is {capacity}; a history needs at least 2 poses")
        self._times: deque[int] = deque(maxlen=capacity)
        self._poses: deque[PlanarPose] = deque(maxlen=capacity)

    def __len__(self) -> int:
        return len(self._times)

    def add(self, captured_ns: int, pose: PlanarPose) -> None:
        """Append a pose. Raises InputError where its time is not after the newest one."""
        if self._times and captured_ns <= self._times[-1]:
            raise InputError(f"pose at {captured_ns} ns is not after the newest one at {self._times[-1]} ns")
        self._times.append(captured_ns)
        self._poses.append(pose)

    def newest(self) -> tuple[int, PlanarPose]:
        """Return the newest (captured_ns, pose). Raises PoseNotYetKnown while there is none."""
        if not self._times:
            raise PoseNotYetKnown("no pose has been recorded yet")
        return self._times[-1], self._poses[-1]

    def since(self, captured_ns: int) -> list[tuple[int, PlanarPose]]:
        """Return the poses (captured_ns, pose) recorded at or after a time, oldest first."""
        first = bisect_left(self._times, captured_ns)
        return list(zip(self._times, self._poses, strict=True))[first:]

    def at(self, captured_ns: int) -> PlanarPose:
        """Return the pose at a time, on the arc between its neighbours.

        Raises PoseExpired where the time lies before the oldest pose kept, and PoseNotYetKnown where it lies
        after the newest; both name the difference.
        """
        newest_ns, newest_pose = self.newest()
        if captured_ns > newest_ns:
            late_ms = (captured_ns - newest_ns) / 1e6
            raise PoseNotYetKnown(f"time {captured_ns} ns lies {late_ms:.1f} ms after the newest pose")
        if captured_ns < self._times[0]:
            early_ms = (self._times[0] - captured_ns) / 1e6
            raise PoseExpired(f"time {captured_ns} ns lies {early_ms:.1f} ms before the oldest pose kept")
        after = bisect_right(self._times, captured_ns)
        if after == len(self._times):
            return newest_pose
        start_ns, end_ns = self._times[after - 1], self._times[after]
        return self._poses[after - 1].towards(
            self._poses[after], (captured_ns - start_ns) / (end_ns - start_ns)
        )
