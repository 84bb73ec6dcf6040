"""The servos behind a framed session."""

from collections.abc import Callable

from tapreach.drivers.arduino.servos import Pulses, ServoMap
from tapreach.drivers.arduino.session import Session
from tapreach.drivers.arduino.wire import Result, ServoLimits, Servos, Telemetry
from tapreach.robot.arm_section import ArmSection
from tapreach.robot.clock import MS, Clock
from tapreach.robot.interface import Listeners, Unsubscribe
from tapreach.robot.messages import ArmPose, ArmState

SEND_AGAIN_NS = 100 * MS
ARRIVED_US = 2.0
"""Nearer than this to its pulse a servo is there: the board counts in timer ticks."""


class BoardArm:
    """See Arm. A target is sent again until the board has acknowledged it: no deadman watches servos."""

    def __init__(
        self, section: ArmSection, session: Session, clock: Clock, require_link: Callable[[], None]
    ) -> None:
        self._map = ServoMap(section)
        self._stowed = section.stowed.pose()
        self._session, self._clock, self._require_link = session, clock, require_link
        self._listeners = Listeners()
        self._target: ArmPose | None = None
        self._open: Servos | None = None
        self._sent_ns = 0
        self._pulses: Pulses = (0, 0, 0, 0)
        self._is_taught = False

    def limits(self) -> tuple[ServoLimits, ...]:
        """Return what the board must know of its servos."""
        rest = self._map.pulses_us(self._stowed)
        pairs = enumerate(zip(self._map.servos, rest, strict=True))
        return tuple(ServoLimits(i, servo.low_us, servo.high_us, at) for i, (servo, at) in pairs)

    def move(self, target: ArmPose) -> ArmPose:
        """See Arm. Limits are the joints' and the servos'."""
        self._require_link()
        if self._is_taught:
            return self._hold()
        self._target = self._map.limited(target)
        self._send(Servos(self._map.pulses_us(self._target), self._map.speeds_us_per_s()))
        return self._target

    def begin_teaching(self) -> None:
        """From now on poses mean nothing: who sends the arm somewhere has it hold where it is."""
        self._open = self._target = None
        self._is_taught = True

    def end_teaching(self) -> tuple[ServoLimits, ...]:
        """Poses count again. Return the limits for the board, wide enough that no servo moves for them."""
        self._open = self._target = None
        self._is_taught = False
        pairs = zip(self.limits(), self._pulses, strict=True)
        return tuple(_around(limits, pulse) if pulse else limits for limits, pulse in pairs)

    def subscribe(self, listener: Callable[[ArmState], None]) -> Unsubscribe:
        """See Arm."""
        return self._listeners.subscribe(listener)

    def take(self, telemetry: Telemetry, captured_ns: int) -> None:
        """Take where the pulses are: the servos themselves tell nothing."""
        self._pulses = telemetry.pulse_us
        pose = self._map.pose(telemetry.pulse_us)
        target = self._target if self._target is not None else pose
        wanted = self._map.pulses_us(target)
        is_moving = self._target is not None and self._is_away(telemetry.pulse_us, wanted)
        self._listeners.tell(ArmState(captured_ns, pose, target, is_moving))

    def on_answer(self, message: object, result: Result) -> None:
        """Take the answer to a command; a target that is refused is not sent again."""
        if message == self._open:
            self._open = None
            if result is not Result.OK:
                self._target = None

    def tick(self) -> None:
        """Send again what has not been acknowledged."""
        if self._open is not None and self._clock.now_ns() - self._sent_ns >= SEND_AGAIN_NS:
            self._send(self._open)

    def lose(self) -> None:
        """The board is out of reach: nothing is sent later that was meant for now."""
        self._open = None

    def forget(self) -> None:
        """The board has restarted: its servos have no pulses until they are sent somewhere."""
        self._open = self._target = None

    def _send(self, command: Servos) -> None:
        self._open, self._sent_ns = command, self._clock.now_ns()
        self._session.send(command)

    def _hold(self) -> ArmPose:
        if any(self._pulses):
            self._send(Servos(self._pulses, (0, 0, 0, 0)))
        return self._map.pose(self._pulses)

    def _is_away(self, pulses: tuple[int, int, int, int], wanted: tuple[int, int, int, int]) -> bool:
        return any(abs(pulse - goal) > ARRIVED_US for pulse, goal in zip(pulses, wanted, strict=True))


def _around(limits: ServoLimits, pulse_us: int) -> ServoLimits:
    low_us, high_us = min(limits.low_us, pulse_us), max(limits.high_us, pulse_us)
    return ServoLimits(limits.index, low_us, high_us, limits.rest_us)
