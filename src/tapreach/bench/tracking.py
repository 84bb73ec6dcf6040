"""The tracking bench: tapped points followed through rendered films, against the truth and beside OpenCV."""

from collections.abc import Callable

import cv2

from tapreach.bench.report import Report, Section
from tapreach.bench.series import Measurement, run_series
from tapreach.bench.tracking_figures import OURS, beside_section, wanted_section
from tapreach.bench.tracking_motions import Motion
from tapreach.bench.tracking_plan import TrackingPlan, films_of, sim_description
from tapreach.bench.tracking_run import (
    Follow,
    Run,
    follow_by_klt,
    follow_by_klt_from_first,
    follow_by_tracker,
    pictures_of,
)
from tapreach.robot.clock import Clock

_METHOD = (
    "Random points on objects, 4 px and more within their outline, 0.35 to 3.2 m away, in scenes that ship "
    "and in random ones: JPEG 80, exposure noise 0.03, exposure 10 ms, camera 1° and 5 mm off, odometry up "
    "to 3 % off. 10 pictures a second at 0.5 rad/s or 0.25 m/s. A point counts as visible when nothing "
    "stands before it, it is 14 px within the picture and its surface is seen under less than 75°."
)


async def run_tracking(plan: TrackingPlan, on_section: Callable[[Section], None], clock: Clock) -> Report:
    """Draw the films, follow through them, and report."""
    by_tracker: dict[str, dict[Motion, list[Run]]] = {}

    async def wanted() -> Section:
        by_tracker.update(_followed(plan))
        return wanted_section(by_tracker[OURS], _METHOD)

    async def beside() -> Section:
        return beside_section(by_tracker)

    parts = (Measurement("Tapped points followed", wanted), Measurement("Beside OpenCV", beside))
    return await run_series("tracking", "Tracking", plan.is_smoke, parts, on_section, clock, plan.seed)


def _followed(plan: TrackingPlan) -> dict[str, dict[Motion, list[Run]]]:
    trackers: dict[str, Follow] = {
        OURS: follow_by_tracker(sim_description()),
        "KLT": follow_by_klt,
        "KLT from the first": follow_by_klt_from_first,
    }
    films, threads = films_of(plan), cv2.getNumThreads()
    cv2.setNumThreads(1)  # times are those of one core
    found: dict[str, dict[Motion, list[Run]]] = {name: {} for name in trackers}
    try:
        for film in films:
            pictures = pictures_of(film)
            for name, follow in trackers.items():
                runs = found[name].setdefault(film.motion, [])
                runs += [follow(film, pictures, tapped) for tapped in film.taps]
    finally:
        cv2.setNumThreads(threads)
    return found
