"""Poses and paths of a grasp: the claw closes, what it holds goes up and towards the base."""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.robot.messages import ArmPose
from tapreach.tasks.fetch.arm_path import ArmPath, straight_path
from tapreach.tasks.fetch.arm_workspace import ArmWorkspace, Unreachable

SQUEEZE = 0.010
"""The claw is sent this much narrower than the thing is [m]: its servo then pulls with nearly all it has."""
SURE = 2.0
"""Sigmas of the width that the claw closes further, lest a thing that is narrower is held loosely."""
LIFT_SPEED = 0.12
"""[m/s]"""
LIFTS = (0.10, 0.08, 0.06, 0.04)
"""Ways up [m], the best first."""
BACKS = (0.04, 0.02, 0.0)
"""Ways towards the base meanwhile [m]: nearer, the servos carry it more easily."""
_OFF_THE_FLOOR = 0.02


def opened(pose: ArmPose, width: float, beside: float, arm: ArmWorkspace) -> ArmPose:
    """Return `pose` with the claw open for a thing of `width` [m] with `beside` [m] to spare on each side, or
    as wide as it goes.
    """
    return replace(pose, claw=min(arm.claw_max, width + 2.0 * beside))


def closed(pose: ArmPose, width: float, width_sd: float = 0.0) -> ArmPose:
    """Return `pose` with the claw closed on a thing of `width` [m], one sigma `width_sd` [m].

    Not simply shut: where the thing is not there after all, the fingers stay apart and the servo at rest; and
    a servo that pulls against a thing has no farther to go than it must.
    """
    return replace(pose, claw=max(0.0, width - SQUEEZE - SURE * width_sd))


def lift_path(start: ArmPose, arm: ArmWorkspace) -> ArmPath | Unreachable:
    """Return the way up with what is held: straight off the floor, then up and towards the base.

    As far up as the arm can, at least 40 mm. The reason why not is that of the least.
    """
    refused = Unreachable("the arm cannot lift from there")
    for rise, back in ((rise, back) for rise in LIFTS for back in BACKS):
        path = _lift(start, rise, back, arm)
        if isinstance(path, ArmPath):
            return path
        refused = Unreachable(f"cannot lift from there: {path.reason}")
    return refused


def _lift(start: ArmPose, rise: float, back: float, arm: ArmWorkspace) -> ArmPath | Unreachable:
    tip = arm.tip(start)
    inwards = -np.array([np.cos(start.rotation), np.sin(start.rotation), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    return _through(start, (tip + _OFF_THE_FLOOR * up, tip + rise * up + back * inwards), arm)


def _through(start: ArmPose, tips: Iterable[FloatArray], arm: ArmWorkspace) -> ArmPath | Unreachable:
    path: ArmPath | None = None
    for tip in tips:
        leg = straight_path(start if path is None else path.end, tip, arm)
        if isinstance(leg, Unreachable):
            return leg
        path = leg if path is None else path.then(leg)
    assert path is not None
    return path
