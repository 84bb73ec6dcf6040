"""The host's view of the board: limits for what is sent, odometry from ticks, arm state."""

from collections import deque
from math import radians

from tapreach.drivers.sim.protocol import Telemetry
from tapreach.estimation.odometry import WheelOdometry
from tapreach.robot.arm_section import ArmSection
from tapreach.robot.config import BaseSection
from tapreach.robot.messages import ArmPose, ArmState, Odometry, Twist

SPEED_WINDOW_NS = 100_000_000


class TickOdometry:
    """Turns ticks into odometry with the robot file's radius and track, as on any real robot."""

    def __init__(self, base: BaseSection) -> None:
        self._wheels = WheelOdometry(base.wheel_radius, base.track_width, base.ticks_per_turn)
        self._distance = 0.0
        self._recent: deque[tuple[int, float, float]] = deque()

    def update(self, telemetry: Telemetry) -> Odometry:
        """Return the odometry now; speeds are means over 100 ms, since ticks are whole."""
        before_ns = self._wheels.reading.captured_ns
        reading = self._wheels.update(telemetry.left_ticks, telemetry.right_ticks, telemetry.captured_ns)
        if before_ns:
            advance = reading.speed * (reading.captured_ns - before_ns) * 1e-9
            self._distance += abs(advance)
            turn = reading.turn_rate * (reading.captured_ns - before_ns) * 1e-9
            self._recent.append((reading.captured_ns, advance, turn))
        while self._recent and self._recent[0][0] <= reading.captured_ns - SPEED_WINDOW_NS:
            self._recent.popleft()
        return Odometry(reading.captured_ns, reading.pose, self._mean_twist(), self._distance)

    def _mean_twist(self) -> Twist:
        span = SPEED_WINDOW_NS * 1e-9
        return Twist(sum(a for _, a, _ in self._recent) / span, sum(t for _, _, t in self._recent) / span)


def arm_state(telemetry: Telemetry) -> ArmState:
    """Return the arm's part of a telemetry."""
    t = telemetry
    return ArmState(
        t.captured_ns,
        ArmPose(t.rotation, t.shoulder, t.elbow, t.claw),
        ArmPose(t.target_rotation, t.target_shoulder, t.target_elbow, t.target_claw),
        t.arm_is_moving,
    )


def limited_twist(twist: Twist, base: BaseSection) -> Twist:
    """Return `twist` scaled into the limits of the base, its curvature kept."""
    excess = max(1.0, abs(twist.linear) / base.max_linear, abs(twist.angular) / base.max_angular)
    return Twist(twist.linear / excess, twist.angular / excess)


def limited_arm(pose: ArmPose, arm: ArmSection) -> ArmPose:
    """Return `pose` with every joint within the limits of the robot file."""
    return ArmPose(
        _within(pose.rotation, arm.rotation_limits_deg),
        _within(pose.shoulder, arm.shoulder_limits_deg),
        _within(pose.elbow, arm.elbow_limits_deg),
        max(0.0, min(arm.claw_max, pose.claw)),
    )


def _within(angle: float, limits_deg: tuple[float, float]) -> float:
    return max(radians(limits_deg[0]), min(radians(limits_deg[1]), angle))
