"""Follows tapped points through a film: by the tracker as tasks use it, and by OpenCV's KLT beside it."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.bench.tracking_film import Film, Tapped
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.robot.clock import MS, processor_ns
from tapreach.robot.config import RobotDescription
from tapreach.tasks.distance_range import DistanceRange
from tapreach.tasks.sighting import TAP_SIGMA, Sighting
from tapreach.vision.image_io import BrokenPicture, Gray, decode_gray
from tapreach.vision.track import TrackStatus
from tapreach.vision.tracker import PatchTracker

Follow = Callable[[Film, list[Gray], Tapped], "Run"]
_KLT_CRITERIA = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 30, 0.01)
_FORTH_AND_BACK = 1.0


@dataclass(frozen=True, eq=False)
class Run:
    """One tapped point followed through a film; all arrays have a row for each picture after the first.

    pixels: (n, 2), NaN where lost. sigmas: (n,) [px], NaN where none was given. is_sure: (n,). took_ms: (n,)
    of processor time. weakness: what was said at the tap.
    """

    tapped: Tapped
    pixels: FloatArray
    sigmas: FloatArray
    is_sure: NDArray[np.bool_]
    took_ms: FloatArray
    weakness: str = ""


def pictures_of(film: Film) -> list[Gray]:
    """Return the film's pictures in grey."""
    decoded = [decode_gray(jpeg) for jpeg in film.jpegs]
    return [picture for picture in decoded if not isinstance(picture, BrokenPicture)]


def follow_by_tracker(description: RobotDescription) -> Follow:
    """Return what follows as the tasks do: each picture with guesses from odometry and the last sighting."""

    def follow(film: Film, pictures: list[Gray], tapped: Tapped) -> Run:
        tracker = PatchTracker(pictures[0], tapped.pixel.u, tapped.pixel.v)
        last = Sighting(0, 0, tapped.pixel, TAP_SIGMA, 1.0, film.odometry[0])
        reach, rows = DistanceRange(last, description), []
        for pose, picture in zip(film.odometry[1:], pictures[1:], strict=True):
            guesses = reach.guesses(last, pose)
            began = processor_ms()
            track = tracker.follow(picture, guesses)
            took = processor_ms() - began
            if track.pixel is not None:
                last = Sighting(0, 0, track.pixel, track.sigma, track.scale, pose)
                reach.note(last)
            is_sure = track.status is TrackStatus.FOLLOWED
            rows.append((*_or_nan(track.pixel), track.sigma if track.pixel else np.nan, is_sure, took))
        return _run(tapped, rows, tracker.weakness)

    return follow


def follow_by_klt(film: Film, pictures: list[Gray], tapped: Tapped) -> Run:
    """From picture to picture by OpenCV's pyramidal KLT with its forward-backward check; lost stays lost."""
    point: FloatArray | None = tapped.pixel.to_array()
    rows = []
    for before, now in pairwise(pictures):
        began = processor_ms()
        if point is not None:
            point = _klt(before, now, point, point)
        rows.append((*_array_or_nan(point), np.nan, point is not None, processor_ms() - began))
    return _run(tapped, rows)


def follow_by_klt_from_first(film: Film, pictures: list[Gray], tapped: Tapped) -> Run:
    """The tapped picture's window found in each picture by KLT, started where it was found last."""
    start = tapped.pixel.to_array()
    last, rows = start, []
    for now in pictures[1:]:
        began = processor_ms()
        point = _klt(pictures[0], now, start, last)
        last = point if point is not None else last
        rows.append((*_array_or_nan(point), np.nan, point is not None, processor_ms() - began))
    return _run(tapped, rows)


def processor_ms() -> float:
    """Return the processor time of this thread so far [ms]."""
    return processor_ns() / MS


def _klt(before: Gray, now: Gray, point: FloatArray, start: FloatArray) -> FloatArray | None:
    origin, guess = (a.astype(np.float32).reshape(1, 1, 2) for a in (point, start))
    found = _flow(before, now, origin, guess)
    back = _flow(now, before, found, origin) if found is not None else None
    if found is None or back is None or float(np.linalg.norm(back - origin)) > _FORTH_AND_BACK:
        return None
    place = found.reshape(2).astype(np.float64)
    height, width = now.shape
    return place if np.all((place >= 0.0) & (place <= (width - 1, height - 1))) else None


def _flow(
    before: Gray, now: Gray, origin: NDArray[np.float32], guess: NDArray[np.float32]
) -> NDArray[np.float32] | None:
    found, status, _ = cv2.calcOpticalFlowPyrLK(
        before, now, origin, guess.copy(), winSize=(21, 21), maxLevel=3, criteria=_KLT_CRITERIA,
        flags=cv2.OPTFLOW_USE_INITIAL_FLOW,
    )  # fmt: skip
    return np.asarray(found, dtype=np.float32) if status[0, 0] else None


def _or_nan(pixel: Pixel | None) -> tuple[float, float]:
    return (pixel.u, pixel.v) if pixel is not None else (np.nan, np.nan)


def _array_or_nan(point: FloatArray | None) -> tuple[float, float]:
    return (float(point[0]), float(point[1])) if point is not None else (np.nan, np.nan)


def _run(tapped: Tapped, rows: list[tuple[float, float, float, bool, float]], weakness: str = "") -> Run:
    table = np.array(rows, dtype=np.float64)
    return Run(tapped, table[:, :2], table[:, 2], table[:, 3] > 0.0, table[:, 4], weakness)
