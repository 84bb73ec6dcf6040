"""Other ways to the same target, given the same sightings: each one's own types made ready, then the call."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np

from tapreach.bench.accuracy_trials import Cell
from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.motion_prior import Motion
from tapreach.estimation.observation import Observation
from tapreach.estimation.point_estimate import PointEstimate
from tapreach.estimation.two_tap import TwoTapEstimate, two_tap_from_pixels
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep


@dataclass(frozen=True)
class Answer:
    """target (3,): bearing and inverse depth in the first camera. covariance (3, 3), None where not given."""

    target: FloatArray
    covariance: FloatArray | None = None


@dataclass(frozen=True)
class Job:
    """run: what is timed. read: from its result to an answer, None where there is none."""

    run: Callable[[], Any]
    read: Callable[[Any], Answer | None]


Peer = Callable[[Sequence[Observation], Cell], Job]


def from_point(point: FloatArray, covariance: FloatArray | None = None) -> Answer | None:
    """Return the answer for a point (3,) in the first camera and its covariance; None for one behind."""
    x, y, z = (float(value) for value in point)
    if not z > 0.0:
        return None
    by_point = np.array([[1.0 / z, 0.0, -x / z**2], [0.0, 1.0 / z, -y / z**2], [0.0, 0.0, -1.0 / z**2]])
    spread = None if covariance is None else by_point @ covariance @ by_point.T
    return Answer(np.array([x / z, y / z, 1.0 / z]), spread)


def tapreach(observations: Sequence[Observation], cell: Cell) -> Job:
    """`estimate_point` with the odometry's noise."""
    return _own(observations, cell.noise)


def tapreach_trusting(observations: Sequence[Observation], cell: Cell) -> Job:
    """`estimate_point` that takes the odometry as exact."""
    return _own(observations, None)


def _own(observations: Sequence[Observation], motion: Motion) -> Job:
    def read(estimate: PointEstimate) -> Answer | None:
        if estimate.bearing is None or estimate.inverse_depth is None:
            return None
        return Answer(np.append(estimate.bearing, estimate.inverse_depth), estimate.bearing_inverse_depth_cov)

    return Job(lambda: estimate_point(observations, motion, with_advice=False), read)


def opencv(observations: Sequence[Observation], cell: Cell) -> Job:
    """`cv2.triangulatePoints` of the first and the last view, poses as the odometry says."""
    first, last = observations[0], observations[-1]
    last_from_first = (last.world_from_camera.inv() * first.world_from_camera).as_matrix()[:3]
    views = [np.eye(3, 4), np.ascontiguousarray(last_from_first)]
    rays = [view.camera.normalise(view.pixel.to_array()[None]).T.copy() for view in (first, last)]

    def read(homogeneous: FloatArray) -> Answer | None:
        point = homogeneous[:, 0]
        return from_point(point[:3] / point[3])

    return Job(lambda: cv2.triangulatePoints(views[0], views[1], rays[0], rays[1]), read)


def paper(observations: Sequence[Observation], cell: Cell) -> Job:
    """The paper's formula on the first and the last view: it knows neither lever nor pitch."""
    first, last = observations[0], observations[-1]
    way = PlanarPose.from_rigid(first.world_from_base.inv() * last.world_from_base)
    step = PlanarStep(way.heading, float(np.hypot(way.x, way.y)))

    def read(estimate: TwoTapEstimate) -> Answer | None:
        if estimate.position is None:
            return None
        right, up, ahead = estimate.position.in_first
        return from_point(np.array([right, -up, ahead]))

    return Job(lambda: two_tap_from_pixels(first.camera, first.pixel, last.pixel, step), read)
