"""gtsam as a peer, where it is installed: its triangulation, and the most probable answer by its graph."""

import importlib
import importlib.util
from collections.abc import Sequence
from typing import Any

import numpy as np

from tapreach.bench.accuracy_peers import Answer, Job, Peer, from_point
from tapreach.bench.accuracy_trials import Cell
from tapreach.estimation.observation import Observation
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose

_OUT_OF_PLANE = 1e-5
"""Sigma of what wheels cannot do; with 1e-7 gtsam's marginals are indeterminate."""
_POINT = 1000


def gtsam_peers() -> dict[str, Peer]:
    """Return its two ways by name; none where gtsam is not installed."""
    if importlib.util.find_spec("gtsam") is None:
        return {}
    return {"gtsam MAP": gtsam_map, "gtsam triangulation": gtsam_triangulation}


def gtsam_triangulation(observations: Sequence[Observation], cell: Cell) -> Job:
    """`triangulatePoint3` of all views with refinement, poses as the odometry says."""
    gtsam = importlib.import_module("gtsam")
    poses = [gtsam.Pose3(view.world_from_camera.as_matrix()) for view in observations]
    pixels = [view.pixel.to_array() for view in observations]
    calibration, noise = _calibration(gtsam, cell, observations[0])
    return Job(
        lambda: gtsam.triangulatePoint3(poses, calibration, pixels, 1e-9, True, noise),
        lambda point: from_point(_in_first(observations, point)),
    )


def gtsam_map(observations: Sequence[Observation], cell: Cell) -> Job:
    """Graph of base poses, odometry and projections; Levenberg-Marquardt, then the point's marginal."""
    gtsam = importlib.import_module("gtsam")
    bases = [gtsam.Pose3(view.world_from_base.as_matrix()) for view in observations]
    cameras = [gtsam.Pose3(view.world_from_camera.as_matrix()) for view in observations]
    mount = gtsam.Pose3(observations[0].base_from_camera.as_matrix())
    pixels = [view.pixel.to_array() for view in observations]
    calibration, tap_noise = _calibration(gtsam, cell, observations[0])
    steps = [
        (bases[i - 1].between(bases[i]), _step_noise(gtsam, observations, i, cell))
        for i in range(1, len(bases))
    ]
    fixed = gtsam.noiseModel.Isotropic.Sigma(6, _OUT_OF_PLANE)

    def run() -> tuple[FloatArray, FloatArray]:
        graph, start = gtsam.NonlinearFactorGraph(), gtsam.Values()
        graph.add(gtsam.PriorFactorPose3(0, bases[0], fixed))
        for i, (step, noise) in enumerate(steps):
            graph.add(gtsam.BetweenFactorPose3(i, i + 1, step, noise))
        for i, pixel in enumerate(pixels):
            start.insert(i, bases[i])
            graph.add(gtsam.GenericProjectionFactorCal3_S2(pixel, tap_noise, i, _POINT, calibration, mount))
        start.insert(_POINT, gtsam.triangulatePoint3(cameras, calibration, pixels, 1e-9, False))
        best = gtsam.LevenbergMarquardtOptimizer(graph, start).optimize()
        return best.atPoint3(_POINT), gtsam.Marginals(graph, best).marginalCovariance(_POINT)

    def read(result: tuple[FloatArray, FloatArray]) -> Answer | None:
        into_first = observations[0].world_from_camera.rotation.as_matrix().T
        return from_point(_in_first(observations, result[0]), into_first @ result[1] @ into_first.T)

    return Job(run, read)


def _calibration(gtsam: Any, cell: Cell, first: Observation) -> tuple[Any, Any]:
    camera = first.camera
    return (
        gtsam.Cal3_S2(camera.fx, camera.fy, 0.0, camera.cx, camera.cy),
        gtsam.noiseModel.Isotropic.Sigma(2, cell.pixel_sigma),
    )


def _step_noise(gtsam: Any, observations: Sequence[Observation], number: int, cell: Cell) -> Any:
    before, after = observations[number - 1].world_from_base, observations[number].world_from_base
    planar = cell.noise.step_covariance(PlanarPose.from_rigid(before.inv() * after))
    covariance = np.eye(6) * _OUT_OF_PLANE**2
    rows = [3, 4, 2]  # gtsam orders rotation, then translation
    covariance[np.ix_(rows, rows)] += planar
    return gtsam.noiseModel.Gaussian.Covariance(covariance)


def _in_first(observations: Sequence[Observation], point: FloatArray) -> FloatArray:
    return np.asarray(observations[0].world_from_camera.inv().apply(point))
