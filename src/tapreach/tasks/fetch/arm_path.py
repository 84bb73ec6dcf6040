"""Ways of the arm: level straight lines of the claw, and turns of the joints, clear of floor and base."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from tapreach.control.arm_path_motion import TimedPose, between
from tapreach.geometry.finite import FloatArray, finite_array
from tapreach.robot.messages import ArmPose
from tapreach.tasks.fetch.arm_workspace import MARGIN, ArmWorkspace, Unreachable

SPACING = 0.01
"""Poses of a line are at most this far apart [m]."""
JOINT_SPACING = math.radians(5.0)
TIP_SPEED = 0.15
"""[m/s]"""
JOINT_SHARE = 0.6
"""Share of the servos' greatest speed that a path uses: what is slower than they can be stays in step."""
CLAW_SPEED = 0.06
"""[m/s]"""
_LEAST_S = 0.02
_SAME = math.radians(1.0)
_TURN_OVER = math.radians(40.0)


@dataclass(frozen=True)
class ArmPath:
    """Poses from where it starts to where it ends, and the point between the finger tips at each, (n, 3) in
    the base frame [m].
    """

    poses: tuple[ArmPose, ...]
    tips_in_base: FloatArray

    @property
    def start(self) -> ArmPose:
        """The first pose."""
        return self.poses[0]

    @property
    def end(self) -> ArmPose:
        """The last pose."""
        return self.poses[-1]

    def then(self, other: "ArmPath") -> "ArmPath":
        """Return this path and then `other`, which begins where this one ends."""
        tips = np.concatenate([self.tips_in_base, other.tips_in_base[1:]])
        return ArmPath((*self.poses, *other.poses[1:]), tips)

    def timed(self, arm: ArmWorkspace, tip_speed: float = TIP_SPEED) -> tuple[TimedPose, ...]:
        """Return when to be at each pose so that neither tip [m/s], joint nor claw is too fast.

        It starts and ends slowly: the first and the last piece take twice their time.
        """
        durations = [
            max(_LEAST_S, _duration(first, second, float(np.linalg.norm(tips[1] - tips[0])), arm, tip_speed))
            for (first, second), tips in zip(pairwise(self.poses), pairwise(self.tips_in_base), strict=True)
        ]
        for index in {0, len(durations) - 1} if durations else ():
            durations[index] *= 2.0
        times = np.concatenate([[0.0], np.cumsum(durations)])
        return tuple(TimedPose(float(time), pose) for time, pose in zip(times, self.poses, strict=True))


def straight_path(
    start: ArmPose, tip_goal_in_base: npt.ArrayLike, arm: ArmWorkspace
) -> ArmPath | Unreachable:
    """Return the straight line of the tip from `start` to (3,) in the base frame [m], the opening kept.

    Within the joints' limits and clear of floor and base all the way (where it starts too near to them: never
    nearer). Raises InputError for a goal that is not finite.
    """
    goal = finite_array("tip_goal_in_base", tip_goal_in_base, (3,))
    last = arm.pose_at(goal, start.claw, start)
    if isinstance(last, Unreachable):
        return last
    begin = arm.tip(start)
    count = 1 + math.ceil(float(np.linalg.norm(goal - begin)) / SPACING)
    poses = [start]
    for tip in np.linspace(begin, goal, count + 1)[1:]:
        pose = arm.pose_at(tip, start.claw, poses[-1])
        if isinstance(pose, Unreachable):
            return pose
        if _largest_turn(poses[-1], pose) > _TURN_OVER:
            return Unreachable("the line leads through a place where the arm would have to turn over")
        poses.append(pose)
    return _clear_path(poses, arm)


def joint_path(start: ArmPose, end: ArmPose, arm: ArmWorkspace) -> ArmPath | Unreachable:
    """Return the way on which every joint turns evenly, clear of floor and base; the claw as evenly."""
    if start == end:
        return _clear_path([start], arm)
    count = 1 + math.ceil(_largest_turn(start, end) / JOINT_SPACING)
    poses = [between(start, end, step / count) for step in range(count)]
    return _clear_path([*poses, end], arm)


def path_to(
    start: ArmPose, end: ArmPose, arm: ArmWorkspace, by_way_of: Sequence[ArmPose] = ()
) -> ArmPath | Unreachable:
    """Return a clear way from pose to pose; the claw is narrow on it: it closes before or opens after it.

    The first that is clear of these: all joints evenly; the tip in a straight line; first out, then round;
    first round, then out; over one of `by_way_of`. The reason why none is, is that of the even turn.
    """
    claw = min(start.claw, end.claw)
    begin, goal = replace(start, claw=claw), replace(end, claw=claw)
    direct = joint_path(begin, goal, arm)
    way = direct
    if isinstance(way, Unreachable):
        way = _line_to(begin, goal, arm)
    corners = (replace(goal, rotation=begin.rotation), replace(begin, rotation=goal.rotation))
    for corner in (*corners, *(replace(pose, claw=claw) for pose in by_way_of)):
        if isinstance(way, ArmPath):
            break
        way = _joined(joint_path(begin, corner, arm), joint_path(corner, goal, arm))
    if isinstance(way, Unreachable):
        return direct
    return _joined(joint_path(start, begin, arm), way, joint_path(goal, end, arm))


def _line_to(start: ArmPose, end: ArmPose, arm: ArmWorkspace) -> ArmPath | Unreachable:
    line = straight_path(start, arm.tip(end), arm)
    if isinstance(line, ArmPath) and _largest_turn(line.end, end) > _SAME:
        return Unreachable("the straight line ends with the arm folded otherwise")
    return line if isinstance(line, Unreachable) else ArmPath((*line.poses[:-1], end), line.tips_in_base)


def _joined(*paths: ArmPath | Unreachable) -> ArmPath | Unreachable:
    """Return the paths after each other, or the first that is none."""
    whole: ArmPath | None = None
    for path in paths:
        if isinstance(path, Unreachable):
            return path
        whole = path if whole is None else whole.then(path)
    assert whole is not None
    return whole


def _clear_path(poses: Sequence[ArmPose], arm: ArmWorkspace) -> ArmPath | Unreachable:
    margin = min(MARGIN, arm.clearance(poses[0]).distance)
    hindrance = _first(arm.hindrance(pose, margin) for pose in poses[1:])
    if hindrance:
        return Unreachable(hindrance)
    return ArmPath(tuple(poses), np.array([arm.tip(pose) for pose in poses]))


def _first(reasons: Iterable[str]) -> str:
    return next((reason for reason in reasons if reason), "")


def _duration(first: ArmPose, second: ArmPose, way: float, arm: ArmWorkspace, tip_speed: float) -> float:
    by_joints = _largest_turn(first, second) / (JOINT_SHARE * arm.joint_speed)
    return max(way / tip_speed, by_joints, abs(second.claw - first.claw) / CLAW_SPEED)


def _largest_turn(first: ArmPose, second: ArmPose) -> float:
    return max(
        abs(second.rotation - first.rotation),
        abs(second.shoulder - first.shoulder),
        abs(second.elbow - first.elbow),
    )
