"""Instant position of something that stands on the floor: one tap, one view, no motion."""

import math
from dataclasses import replace
from math import radians

import numpy as np

from tapreach.estimation import floor_guess as on_floor
from tapreach.geometry.pixel import Pixel, require_inside
from tapreach.robot.config import RobotDescription
from tapreach.tasks.extent import measured
from tapreach.tasks.frame_pose import pose_at
from tapreach.tasks.sighting import Sighting, ray_of
from tapreach.tasks.target import Target, TargetSource
from tapreach.tasks.target_report import floor_distance
from tapreach.tasks.task import Tap, TaskContext

TAP_SIGMA = 3.0
"""How well a finger finds where a thing stands on the floor [px]."""
_SURE = 1.96


async def floor_guess(context: TaskContext, tap: Tap, target_id: int) -> Target:
    """Return where the tapped place is if it is on the floor: of a box, the middle of its lower edge.

    Raises FrameError, PoseError, InputError.
    """
    frame = context.frames.get(tap.frame_id)
    box = tap.box.within(frame.size) if tap.box is not None else None
    pixel = require_inside(Pixel(tap.u, tap.v), frame.size) if box is None else box.foot
    world_from_base = await pose_at(context, frame.captured_ns)
    sighting = Sighting(frame.frame_id, frame.captured_ns, pixel, TAP_SIGMA, 1.0, world_from_base)
    target = target_on_floor(sighting, target_id, context.description)
    if box is None or target.point_in_world is None or target.point_cov_in_world is None:
        return target
    size = measured(box, sighting, target.point_in_world, target.point_cov_in_world, context.description)
    return replace(target, extent=size)


def guess_of(sighting: Sighting, description: RobotDescription) -> on_floor.FloorGuess:
    """Return where a sighting's line of sight meets the floor, with the mount's uncertainty of the
    robot file.
    """
    mount = description.camera.mount
    return on_floor.floor_guess(
        sighting.pixel,
        description.camera.model(),
        mount.base_from_camera(),
        pixel_sigma=sighting.sigma,
        angle_sigma=radians(mount.angle_sigma_deg),
        height_sigma=mount.position_sigma,
    )


def target_on_floor(sighting: Sighting, target_id: int, description: RobotDescription) -> Target:
    """Return the target of one sighting, supposed to be on the floor."""
    guess = guess_of(sighting, description)
    world_from_base = sighting.world_from_base.to_rigid()
    point, covariance = None, None
    if guess.point_in_base is not None and guess.point_cov_in_base is not None:
        rotation = world_from_base.rotation.as_matrix()
        point = np.asarray(world_from_base.apply(guess.point_in_base))
        covariance = rotation @ guess.point_cov_in_base @ rotation.T
    return Target(
        target_id=target_id,
        source=TargetSource.FLOOR,
        status=guess.status,
        reason=guess.reason,
        advice="" if point is not None else "locate it: the robot moves to find out",
        frame_id=sighting.frame_id,
        u=sighting.pixel.u,
        v=sighting.pixel.v,
        point_in_world=point,
        point_cov_in_world=covariance,
        range=floor_distance(sighting.world_from_base, point) if point is not None else None,
        range_interval=_range_interval(guess, sighting, description),
        rays_in_world=(ray_of(sighting, description),),
    )


def _range_interval(
    guess: on_floor.FloorGuess, sighting: Sighting, description: RobotDescription
) -> tuple[float, float] | None:
    """Tilt the line of sight by 95 % of its uncertainty both ways: a fair interval also where it is
    lopsided.
    """
    if guess.point_in_base is None:
        return None
    mount = description.camera.mount
    tilt = _SURE * math.hypot(radians(mount.angle_sigma_deg), sighting.sigma / description.camera.model().fy)
    from_base = math.hypot(guess.point_in_base[0], guess.point_in_base[1])
    from_camera = mount.up / math.tan(guess.depression)
    ends = [mount.up / math.tan(guess.depression + way) for way in (tilt, -tilt)]
    return from_base + ends[0] - from_camera, from_base + ends[1] - from_camera
