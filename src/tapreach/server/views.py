"""From the robot's values (SI, radians) to what the page is told (degrees where a person reads)."""

from math import cos, degrees, radians, sin
from typing import Any

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.gaussian import confidence_ellipse
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import CameraSection
from tapreach.robot.messages import ArmState, Odometry, Twist
from tapreach.server.message_parts import ArmView, CameraView, ExtentView, OdometryView, TwistView
from tapreach.server.messages import TargetView
from tapreach.tasks.extent import Extent
from tapreach.tasks.target import Target

OUTLINE_POINTS = 32


def twist_view(twist: Twist) -> TwistView:
    """Return speeds for the page."""
    return TwistView(linear=twist.linear, angular=twist.angular)


def camera_view(section: CameraSection) -> CameraView:
    """Return lens and mount for the page."""
    lens = section.model()
    return CameraView(
        width=lens.size.width,
        height=lens.size.height,
        fx=lens.fx,
        fy=lens.fy,
        cx=lens.cx,
        cy=lens.cy,
        pitch_deg=section.mount.pitch_deg,
        rate_hz=section.rate_hz,
    )


def odometry_view(reading: Odometry) -> OdometryView:
    """Return odometry for the page."""
    return OdometryView(
        x=reading.world_from_base.x,
        y=reading.world_from_base.y,
        heading_deg=degrees(reading.world_from_base.heading),
        distance=reading.distance,
        linear=reading.twist.linear,
        angular=reading.twist.angular,
    )


def arm_view(state: ArmState) -> ArmView:
    """Return the arm for the page."""
    return ArmView(
        rotation_deg=degrees(state.pose.rotation),
        shoulder_deg=degrees(state.pose.shoulder),
        elbow_deg=degrees(state.pose.elbow),
        claw_mm=1000.0 * state.pose.claw,
        is_moving=state.is_moving,
    )


def target_view(target: Target, world_from_base: PlanarPose) -> TargetView:
    """Return a target for the page, with the robot at `world_from_base`."""
    low, high = target.range_interval or (None, None)
    return TargetView(
        target_id=target.target_id,
        source=target.source.value,
        status=target.status,
        reason=target.reason,
        advice=target.advice,
        frame_id=target.frame_id,
        u=target.u,
        v=target.v,
        range=_finite_or_none(target.range),
        range_low=_finite_or_none(low),
        range_high=_finite_or_none(high),
        rays_in_world=tuple(
            (*map(float, ray.origin[:2]), *map(float, ray.direction[:2])) for ray in target.rays_in_world
        ),
        is_following=target.is_following,
        extent=extent_view(target.extent) if target.extent is not None else None,
        **_position(target, world_from_base),
    )


def extent_view(extent: Extent) -> ExtentView:
    """Return a size for the page."""
    size = extent.size
    return ExtentView(
        width=size.width if size is not None else None,
        height=size.height if size is not None else None,
        width_sigma=size.width_sd if size is not None else None,
        height_sigma=size.height_sd if size is not None else None,
        reason=extent.reason,
    )


def _position(target: Target, world_from_base: PlanarPose) -> dict[str, Any]:
    point, cov = target.point_in_world, target.point_cov_in_world
    base_from_world = world_from_base.to_rigid().inv()
    rotation = base_from_world.rotation.as_matrix()
    variances = None if cov is None else np.clip(np.diag(rotation @ cov @ rotation.T), 0.0, None)
    return {
        "point_in_world": None if point is None else tuple(map(float, point)),
        "point_in_base": None if point is None else tuple(map(float, base_from_world.apply(point))),
        "sigma": None if variances is None else tuple(map(float, np.sqrt(variances))),
        "region_in_world": () if point is None or cov is None else _floor_outline(point, cov),
    }


def _floor_outline(point: FloatArray, cov: FloatArray) -> tuple[tuple[float, float], ...]:
    ellipse = confidence_ellipse(cov[:2, :2])
    angles = [radians(360.0 * i / OUTLINE_POINTS) for i in range(OUTLINE_POINTS)]
    circle = np.array([[cos(angle), sin(angle)] for angle in angles])
    outline = point[:2] + (circle * ellipse.half_axes) @ ellipse.directions.T
    return tuple((float(x), float(y)) for x, y in outline)


def _finite_or_none(value: float | None) -> float | None:
    return value if value is not None and np.isfinite(value) else None
