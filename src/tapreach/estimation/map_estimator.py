"""The estimator: observations and what is known of the motion, to a point with an honest region.

It finds the most probable target together with the errors of the poses, instead of trusting the poses; this
is what keeps the reported region honest (docs/estimation.md).
"""

import math
from collections.abc import Collection, Sequence

import numpy as np

from tapreach.errors import InputError
from tapreach.estimation.advice import advice_to_halve
from tapreach.estimation.depth_knowledge import DepthKnowledge, depth_knowledge
from tapreach.estimation.map_solver import Solution, covariance_of
from tapreach.estimation.motion_prior import Motion, MountNoise, camera_errors
from tapreach.estimation.nuisances import NuisancePriors
from tapreach.estimation.observation import Observation
from tapreach.estimation.outlier import solve_without_outliers
from tapreach.estimation.point_estimate import PointEstimate, Status
from tapreach.estimation.point_in_frames import TargetInFrames
from tapreach.estimation.range_posterior import RangePrior
from tapreach.estimation.tap_noise import TapNoise
from tapreach.estimation.verdict import reason_without_baseline, verdict
from tapreach.estimation.view_model import ViewModel, view_model
from tapreach.geometry.finite import FloatArray

_WITHOUT_RANGE = {Status.BEHIND, Status.INCONSISTENT}


def estimate_point(
    observations: Sequence[Observation],
    motion: Motion = None,
    *,
    mount_noise: MountNoise | None = None,
    nuisances: NuisancePriors | None = None,
    tap_noise: TapNoise | None = None,
    range_prior: RangePrior | None = None,
    trusted: Collection[int] = (),
    with_advice: bool = True,
) -> PointEstimate:
    """Estimate where the target of the observations is.

    observations: any number, in the order of time; one alone is degenerate, as its depth is unknown.
    motion: what is known of the poses world_from_base: None for exact, OdometryNoise for poses along a drive,
    or their covariance [m², m·rad, rad²] in tangent order (translation, rotation), right perturbation: joint
    (6n, 6n) or independent (n, 6, 6). mount_noise: of the camera on the base, one error shared by all views.
    nuisances: further things shared by all views that may be off. tap_noise: how the errors of the taps hang
    together; None for independent ones. Single taps far off need no option: they are tested, named and left
    out. range_prior: ranges that are possible at all. trusted: numbers of views that are never left
    out, such as the one by which the target was named. with_advice: look for the next move too (some ms).

    Never fails on geometry: a singular or contradictory set of views is a result with its status and reason.
    Raises InputError where there is no observation or a covariance cannot be one.
    """
    if not observations:
        raise InputError("there are no observations; give at least one, and two or more for a depth")
    taps = tap_noise or TapNoise()
    errors = camera_errors(observations, motion, mount_noise, nuisances, taps.shared_bias_px)
    model = view_model(observations, errors, taps.correlation)
    reason = reason_without_baseline(model)
    if reason is not None:
        return _unknown(Status.DEGENERATE, reason, model)
    solved = solve_without_outliers(model, trusted)
    if solved is None:
        return _unknown(Status.INCONSISTENT, "no point lies in front of all the cameras", model)
    model, solution = solved
    depth = depth_knowledge(model, solution, range_prior or RangePrior())
    advice = ""
    if with_advice:
        point = _likely_point(observations, solution, depth)
        relative_sd = depth.sd * depth.likely_range() / depth.slant
        advice = advice_to_halve(observations, motion, mount_noise, point, relative_sd, nuisances, taps)
    return _answer(observations, model, solution, depth, advice)


def _answer(
    observations: Sequence[Observation],
    model: ViewModel,
    solution: Solution,
    depth: DepthKnowledge,
    advice: str,
) -> PointEstimate:
    status, reason = verdict(model, solution, depth)
    residuals_px = _residuals_px(model, solution)
    if status is Status.DEGENERATE or math.isinf(depth.sd):  # what contradicts itself may be singular too
        return _unknown(status, reason, model, residuals_px)
    covariance = covariance_of(solution.on_target)
    is_determined = status is Status.DETERMINED
    in_frames = None
    if is_determined:
        first, last = observations[0], observations[-1]
        world_from_first = first.base_matrix @ first.mount_matrix
        in_frames = TargetInFrames(model, solution, covariance, world_from_first, last.mount_matrix)
    return PointEstimate(
        status=status,
        reason=reason,
        advice=advice,
        bearing=solution.x[:2].copy(),
        inverse_depth=depth.inverse_depth,
        bearing_inverse_depth_cov=covariance,
        relative_sd=depth.relative_sd,
        range=depth.slant / depth.inverse_depth if is_determined else None,
        range_interval_95=None if status in _WITHOUT_RANGE else depth.range_interval(),
        residuals_px=residuals_px,
        rejected_views=model.left_out,
        in_frames=in_frames,
    )


def _residuals_px(model: ViewModel, solution: Solution) -> FloatArray:
    if model.used == model.views and model.whitening is None:
        return solution.views.residuals.reshape(-1, 2) * model.sigmas[:, None]
    return model.residuals_px(solution.x)


def _unknown(
    status: Status, reason: str, model: ViewModel, residuals_px: FloatArray | None = None
) -> PointEstimate:
    """Return a result that knows no depth."""
    return PointEstimate(
        status=status,
        reason=reason,
        advice="drive so that the target moves sideways in the picture",
        bearing=None,
        inverse_depth=None,
        bearing_inverse_depth_cov=None,
        relative_sd=float("inf"),
        range=None,
        range_interval_95=None,
        residuals_px=residuals_px if residuals_px is not None else np.zeros((model.views, 2)),
        rejected_views=model.left_out,
        in_frames=None,
    )


def _likely_point(
    observations: Sequence[Observation], solution: Solution, depth: DepthKnowledge
) -> FloatArray:
    """Return a target (3,) in the world to plan with."""
    in_camera = depth.likely_range() / depth.slant * np.array([*solution.x[:2], 1.0])
    return np.asarray(observations[0].world_from_camera.apply(in_camera))
