"""The best an unbiased estimator could do: the Cramér-Rao bound of some views (docs/estimation.md, 7)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tapreach.estimation.map_solver import inverse_depth_information
from tapreach.estimation.motion_prior import Motion, MountNoise, camera_errors
from tapreach.estimation.nuisances import NuisancePriors
from tapreach.estimation.observation import Observation
from tapreach.estimation.tap_noise import TapNoise
from tapreach.estimation.view_model import view_model
from tapreach.geometry.finite import FloatArray, finite_array


@dataclass(frozen=True)
class Bound:
    """Bound on the covariance (3, 3) of bearing and inverse depth in the first camera; None where singular.

    relative_sd: sd(1/Z)·Z; infinite where the views say nothing about the depth.
    """

    covariance: FloatArray | None
    relative_sd: float


def position_bound(
    observations: Sequence[Observation],
    point_in_world: npt.ArrayLike,
    motion: Motion = None,
    mount_noise: MountNoise | None = None,
    nuisances: NuisancePriors | None = None,
    tap_noise: TapNoise | None = None,
) -> Bound | None:
    """Return the bound for a target at `point_in_world` (3,), pose errors marginalised under their priors.

    The pixels of the observations do not matter, but for the lens there. None where the target is behind one
    of the cameras.
    """
    taps = tap_noise or TapNoise()
    errors = camera_errors(observations, motion, mount_noise, nuisances, taps.shared_bias_px)
    model = view_model(observations, errors, taps.correlation)
    camera_from_world = observations[0].world_from_camera.inv()
    x, y, z = camera_from_world.apply(finite_array("point_in_world", point_in_world, (3,)))
    if z <= 0.0:
        return None
    unknowns = np.zeros((1, model.unknowns))
    unknowns[0, :3] = x / z, y / z, 1.0 / z
    views = model.linearised(unknowns)
    if not views.is_in_front[0]:
        return None
    on_target = views.on_target()[0]
    on_depth = inverse_depth_information(on_target)
    if on_depth <= 1e-12 * on_target[2, 2]:
        return Bound(None, float("inf"))
    return Bound(np.asarray(np.linalg.inv(on_target), dtype=np.float64), float(z / np.sqrt(on_depth)))
