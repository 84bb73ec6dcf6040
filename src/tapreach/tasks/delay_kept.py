"""What is known of the camera's delay, for as long as the program runs: tasks measure it, all use it."""

import math
from dataclasses import dataclass

from tapreach.estimation.camera_delay import CameraDelay
from tapreach.robot.clock import SECOND


@dataclass
class DelayKept:
    """The delay beyond what the robot file says (`camera.delay_ms`, which the driver has taken off already).

    known: None as long as nobody has measured it; pictures are then taken at their word.
    """

    known: CameraDelay | None = None

    def taken_ns(self, captured_ns: int) -> int:
        """Return when a picture was truly taken, given its time stamp [ns]."""
        return captured_ns if self.known is None else captured_ns - round(self.known.delay * SECOND)

    def timing_sigma(self, filed_ms: float) -> float:
        """Return how far the time of a single picture may be off, one sigma [s]; filed_ms: by the robot file,
        which counts until it was measured.
        """
        if self.known is None:
            return filed_ms / 1000.0
        return math.hypot(self.known.sigma, self.known.scatter)
