"""Servos by the lines of ros_arduino_bridge: whole degrees, a step at a time, so that they do not leap."""

from collections.abc import Callable

from tapreach.drivers.arduino.ros_lines import RosLines
from tapreach.drivers.arduino.servos import ServoMap
from tapreach.robot.arm_section import ArmSection
from tapreach.robot.clock import MS, SECOND, Clock
from tapreach.robot.interface import Listeners, Unsubscribe
from tapreach.robot.messages import ArmPose, ArmState

PERIOD_NS = 50 * MS
PULSE_AT_0_DEG, PULSE_AT_180_DEG = 544.0, 2400.0
"""Of the Servo library that this firmware uses [µs]."""
US_PER_DEG = (PULSE_AT_180_DEG - PULSE_AT_0_DEG) / 180.0


def servo_degrees(pulse_us: float) -> int:
    """Return the whole degrees, 0 to 180, that make that library's pulse nearest to this."""
    return round(max(0.0, min(180.0, (pulse_us - PULSE_AT_0_DEG) / US_PER_DEG)))


class RosArm:
    """See Arm. The firmware sets servos at once; the way there is walked here, at the robot file's speed.

    Where the arm is before its first target is not known: it counts as stowed.
    """

    def __init__(
        self, section: ArmSection, clock: Clock, lines: RosLines, require_link: Callable[[], None]
    ) -> None:
        self._map = ServoMap(section)
        self._clock, self._lines, self._require_link = clock, lines, require_link
        self._listeners = Listeners()
        self._pose = self._target = section.stowed.pose()
        pulses = [float(pulse) for pulse in self._map.pulses_us(self._pose)]
        self._pulses, self._goals = pulses, list(pulses)
        self._said: list[int | None] = [None] * 4
        self._is_sent = False
        self._ticked_ns = clock.now_ns()

    def move(self, target: ArmPose) -> ArmPose:
        """See Arm."""
        self._require_link()
        self._target, self._is_sent = self._map.limited(target), True
        self._goals = [float(pulse) for pulse in self._map.pulses_us(self._target)]
        return self._target

    def subscribe(self, listener: Callable[[ArmState], None]) -> Unsubscribe:
        """See Arm."""
        return self._listeners.subscribe(listener)

    def tick(self) -> None:
        """Walk on and tell."""
        now_ns = self._clock.now_ns()
        if now_ns - self._ticked_ns < PERIOD_NS:
            return
        elapsed = min(now_ns - self._ticked_ns, 2 * PERIOD_NS) / SECOND
        self._ticked_ns = now_ns
        if self._is_sent:
            self._walk(elapsed)
        a, b, c, d = self._pulses
        is_moving = self._pulses != self._goals
        pose = self._map.pose((a, b, c, d)) if is_moving else self._target
        self._listeners.tell(ArmState(now_ns, pose, self._target, is_moving))

    def _walk(self, elapsed: float) -> None:
        for index, speed in enumerate(self._map.speeds_us_per_s()):
            way = self._goals[index] - self._pulses[index]
            self._pulses[index] += max(-speed * elapsed, min(speed * elapsed, way))
            self._say(index, servo_degrees(self._pulses[index]))

    def _say(self, index: int, degrees: int) -> None:
        if self._said[index] != degrees:
            self._said[index] = degrees
            self._lines.ask(f"s {index} {degrees}", lambda line: self._hear(index, line))

    def _hear(self, index: int, line: str) -> None:
        if line != "OK":
            self._said[index] = None  # said again in the next period
            self._lines.doubt()
