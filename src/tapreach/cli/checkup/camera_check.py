"""Do pictures come, how many a second, and how old are they on arrival?"""

import statistics
from collections.abc import Callable
from itertools import pairwise

from tapreach.cli.checkup.check import Check, Verdict, graded, worst
from tapreach.drivers.arduino.parts import RobotCamera
from tapreach.robot.clock import MS, SECOND, Clock
from tapreach.robot.config import CameraSection
from tapreach.robot.interface import FrameSource
from tapreach.robot.messages import Frame

FIRST_NS, LOOK_NS, LOOKED_AT = 6 * SECOND, 4 * SECOND, 60
"""The first picture may take so long; then 60 are looked at, or what comes in 4 s."""
FAILING_NS = 2 * SECOND
"""Where opening it fails, and fails again, so long is enough."""
FEW, FAR_TOO_FEW = 0.8, 0.3  # of the rate in the robot file
OLD_MS, TOO_OLD_MS = 250.0, 500.0
"""Older than 500 ms a picture freezes the page; half of that leaves little for the way to the tablet."""
NO_SOURCE = "name one as [camera] source, such as v4l2:/dev/video0: without pictures nothing can be tapped"


async def check_camera(camera: RobotCamera, section: CameraSection, clock: Clock) -> Check:
    """Open the camera of a robot file, look at its pictures, close it."""
    if section.source is None:
        return Check("camera", Verdict.WARN, "the robot file names no camera", NO_SOURCE)
    camera.start()
    opening, began_ns = camera.status.reason, clock.now_ns()

    def has_failed() -> bool:
        is_failing = not camera.status.is_running and camera.status.reason != opening
        return is_failing and clock.now_ns() - began_ns >= FAILING_NS

    try:
        frames = await _frames(camera, clock, has_failed)
        reason = camera.status.reason
    finally:
        await camera.close()
    if not frames:
        return Check("camera", Verdict.FAIL, "no picture comes", reason or "check the camera's cable")
    return judged_frames(frames, section)


async def check_frames(frames: FrameSource, section: CameraSection, clock: Clock, reason: str) -> Check:
    """Look at the pictures of a robot that is connected already; `reason` says why there may be none."""
    seen = await _frames(frames, clock)
    if not seen:
        return Check("camera", Verdict.FAIL, "no picture comes", reason)
    return judged_frames(seen, section)


def judged_frames(frames: list[Frame], section: CameraSection) -> Check:
    """Return the check of pictures in the order of their arrival; at least one."""
    first = frames[0]
    ages_ms = [(frame.received_ns - frame.captured_ns) / MS for frame in frames]
    age_ms, gap_ms = statistics.median(ages_ms), _longest_gap_ms(frames)
    rate_hz = _rate_hz(frames)
    share = rate_hz / section.rate_hz
    by_rate, by_age = graded(share, FEW, FAR_TOO_FEW), graded(age_ms, OLD_MS, TOO_OLD_MS)
    found = (
        f"{first.size.width}x{first.size.height}, {rate_hz:.1f} pictures/s of {section.rate_hz:g}, "
        f"{age_ms:.0f} ms old on arrival, longest gap {gap_ms:.0f} ms"
    )
    advice = [
        words
        for verdict, words in (
            (by_rate, "fewer pictures than asked for: more light, a smaller picture, or another rate_hz"),
            (by_age, "pictures come late: a cable instead of Wi-Fi, or a smaller picture"),
        )
        if verdict is not Verdict.OK
    ]
    figures: dict[str, float | str] = {"rate_hz": round(rate_hz, 2), "age_ms": round(age_ms, 1)}
    figures |= {"longest_gap_ms": round(gap_ms, 1), "pictures": len(frames)}
    verdict = worst([Check("", by_rate, ""), Check("", by_age, "")])
    return Check("camera", verdict, found, "; ".join(advice), figures)


async def _frames(
    source: FrameSource, clock: Clock, has_failed: Callable[[], bool] = lambda: False
) -> list[Frame]:
    frames: list[Frame] = []
    unsubscribe = source.subscribe(frames.append)
    end_ns = clock.now_ns() + FIRST_NS
    has_begun = False
    while clock.now_ns() < end_ns and len(frames) <= LOOKED_AT and not (has_failed() and not frames):
        if frames and not has_begun:
            has_begun, end_ns = True, clock.now_ns() + LOOK_NS
        await clock.sleep_until(clock.now_ns() + 10 * MS)
    unsubscribe()
    return frames


def _rate_hz(frames: list[Frame]) -> float:
    span_ns = frames[-1].received_ns - frames[0].received_ns
    return (len(frames) - 1) * SECOND / span_ns if span_ns > 0 else 0.0


def _longest_gap_ms(frames: list[Frame]) -> float:
    return max(((b.received_ns - a.received_ns) / MS for a, b in pairwise(frames)), default=0.0)
