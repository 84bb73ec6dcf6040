"""How well the depth would be known after one more view, for many places of the base at once."""

from collections.abc import Sequence

import numpy as np

from tapreach.estimation.linearised import Linearised
from tapreach.estimation.map_solver import inverse_depth_information
from tapreach.estimation.motion_prior import CameraErrors, Motion, MountNoise, camera_errors_with_next
from tapreach.estimation.observation import Observation
from tapreach.estimation.view_model import ViewModel, camera_ways, pixel_weights, sighted
from tapreach.geometry.finite import FloatArray


def relative_sds_after(
    observations: Sequence[Observation],
    motion: Motion,
    mount_noise: MountNoise | None,
    point_in_world: FloatArray,
    world_from_bases: FloatArray,
) -> FloatArray:
    """Return the bound on sd(1/Z)·Z (c,) with one more view by the last camera from each base (c, 4, 4).

    Infinite where the target would leave the picture, and where the views say nothing about the depth. Poses
    given with a covariance gain one as uncertain as the last, and independent.
    """
    last = observations[-1]
    ways = camera_ways(observations, world_from_bases @ last.base_from_camera.as_matrix())
    into_first = observations[0].world_from_camera.inv().as_matrix()
    x, y, z = into_first[:3, :3] @ point_in_world + into_first[:3, 3]
    points = ways @ [x, y, z, 1.0]
    relative_sds = np.full(len(world_from_bases), np.inf)
    count = len(observations)
    seen = np.flatnonzero(last.camera.project(points[count:]).is_inside)
    if z <= 0.0 or np.any(points[:count, 2] <= 0.0) or len(seen) == 0:
        return relative_sds
    kept = np.concatenate([np.arange(count), count + seen])
    errors = camera_errors_with_next(observations, motion, mount_noise, world_from_bases[seen])
    model = _model(observations, ways[kept], points[kept], errors)
    unknowns = np.zeros((1, model.unknowns))
    unknowns[0, :3] = x / z, y / z, 1.0 / z
    for index, on_target in zip(seen, _with_each(model.linearised(unknowns), count), strict=True):
        on_depth = inverse_depth_information(on_target)
        if on_depth > 1e-12 * on_target[2, 2]:
            relative_sds[index] = z / np.sqrt(on_depth)
    return relative_sds


def _model(
    observations: Sequence[Observation], ways: FloatArray, points: FloatArray, errors: CameraErrors
) -> ViewModel:
    """Return the model of all views, those that may come next as though they had been seen."""
    measured, weights, sigmas = sighted(observations)
    last, coming = observations[-1], points[len(observations) :]
    expected = coming[:, :2] / coming[:, 2:]
    next_weights = pixel_weights(last.camera, expected) / last.pixel_sigma
    return ViewModel(
        ways,
        np.concatenate([measured, expected]),
        np.concatenate([weights, next_weights]),
        np.concatenate([sigmas, np.full(len(coming), last.pixel_sigma)]),
        errors,
        np.ones(len(points), dtype=bool),
    )


def _with_each(views: Linearised, count: int) -> FloatArray:
    """Return the information (c, 3, 3) of the first `count` views with each of the others."""
    coming = np.arange(2 * count, views.residuals.shape[1]).reshape(-1, 2)
    known = np.broadcast_to(np.arange(2 * count), (len(coming), 2 * count))
    rows = np.concatenate([known, coming], axis=1)
    each = np.zeros(len(rows), dtype=np.intp)
    return Linearised(
        views.x[each],
        views.residuals[0][rows],
        views.by_target[0][rows],
        views.by_errors[0][rows],
        views.is_in_front[each],
    ).on_target()
