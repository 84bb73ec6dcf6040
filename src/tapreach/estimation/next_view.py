"""How well the depth would be known after one more view or some, for many ways of the base at once."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from tapreach.estimation.linearised import Linearised
from tapreach.estimation.map_solver import inverse_depth_information
from tapreach.estimation.motion_prior import CameraErrors, Motion, MountNoise, camera_errors_with_next
from tapreach.estimation.nuisances import NuisancePriors
from tapreach.estimation.observation import Observation
from tapreach.estimation.tap_noise import TapNoise, whitening
from tapreach.estimation.view_model import ViewModel, camera_ways, pixel_weights, sighted
from tapreach.geometry.finite import FloatArray


def relative_sds_after(
    observations: Sequence[Observation],
    motion: Motion,
    mount_noise: MountNoise | None,
    point_in_world: FloatArray,
    world_from_bases: FloatArray,
    pixel_sigmas: npt.ArrayLike | None = None,
    nuisances: NuisancePriors | None = None,
    tap_noise: TapNoise | None = None,
) -> FloatArray:
    """Return the bound on sd(1/Z)·Z (c,) with more views by the last camera, from each of c ways of the base.

    world_from_bases: one view each (c, 4, 4), or v along each way (c, v, 4, 4). pixel_sigmas (v,) [px]: of
    those; as the last observation's when left out. Infinite where the target would be out of the picture in
    one of them, and where the views say nothing about the depth. Poses given with a covariance gain ones as
    uncertain as the last, and independent.
    """
    last = observations[-1]
    ways = world_from_bases.reshape(len(world_from_bases), -1, 4, 4)
    length = ways.shape[1]
    mount = last.base_from_camera.as_matrix()
    cameras = camera_ways(observations, ways.reshape(-1, 4, 4) @ mount)
    into_first = observations[0].world_from_camera.inv().as_matrix()
    x, y, z = into_first[:3, :3] @ point_in_world + into_first[:3, 3]
    points = cameras @ [x, y, z, 1.0]
    relative_sds = np.full(len(ways), np.inf)
    count = len(observations)
    coming = last.camera.project(points[count:])
    is_seen = coming.is_inside.reshape(-1, length).all(axis=1)
    seen = np.flatnonzero(is_seen)
    if z <= 0.0 or np.any(points[:count, 2] <= 0.0) or len(seen) == 0:
        return relative_sds
    further = np.flatnonzero(np.repeat(is_seen, length))
    kept = np.concatenate([np.arange(count), count + further])
    taps = tap_noise or TapNoise()
    errors = camera_errors_with_next(
        observations,
        motion,
        mount_noise,
        ways[seen],
        coming.pixels[further],
        nuisances,
        taps.shared_bias_px,
    )
    sigmas = np.tile(np.broadcast_to(_sigmas(last, pixel_sigmas), length), len(seen))
    model = _model(observations, cameras[kept], points[kept], sigmas, errors)
    unknowns = np.zeros((1, model.unknowns))
    unknowns[0, :3] = x / z, y / z, 1.0 / z
    found = _with_each(model.linearised(unknowns), count, length, taps.correlation)
    for index, on_target in zip(seen, found, strict=True):
        on_depth = inverse_depth_information(on_target)
        if on_depth > 1e-12 * on_target[2, 2]:
            relative_sds[index] = z / np.sqrt(on_depth)
    return relative_sds


def _sigmas(last: Observation, pixel_sigmas: npt.ArrayLike | None) -> FloatArray:
    return np.asarray(last.pixel_sigma if pixel_sigmas is None else pixel_sigmas, dtype=np.float64)


def _model(
    observations: Sequence[Observation],
    cameras: FloatArray,
    points: FloatArray,
    next_sigmas: FloatArray,
    errors: CameraErrors,
) -> ViewModel:
    """Return the model of all views, those that may come next as though they had been seen."""
    measured, weights, sigmas = sighted(observations)
    coming = points[len(observations) :]
    expected = coming[:, :2] / coming[:, 2:]
    next_weights = pixel_weights(observations[-1].camera, expected) / next_sigmas[:, None, None]
    return ViewModel(
        cameras,
        np.concatenate([measured, expected]),
        np.concatenate([weights, next_weights]),
        np.concatenate([sigmas, next_sigmas]),
        errors,
        np.ones(len(points), dtype=bool),
    )


def _with_each(views: Linearised, count: int, length: int, correlation: float) -> FloatArray:
    """Return the information (c, 3, 3) of the first `count` views with each `length` of the others."""
    white: FloatArray = np.eye(2 * (count + length))
    if correlation != 0.0:
        independent = whitening(correlation, np.ones(count + length, dtype=bool))
        white = np.asarray(np.kron(independent, np.eye(2)), dtype=np.float64)
    coming = np.arange(2 * count, views.residuals.shape[1]).reshape(-1, 2 * length)
    known = np.broadcast_to(np.arange(2 * count), (len(coming), 2 * count))
    rows = np.concatenate([known, coming], axis=1)
    each = np.zeros(len(rows), dtype=np.intp)
    return Linearised(
        views.x[each],
        views.residuals[0][rows] @ white.T,
        white @ views.by_target[0][rows],
        white @ views.by_errors[0][rows],
        views.is_in_front[each],
    ).on_target()
