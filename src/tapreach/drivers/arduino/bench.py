"""A framed board on the bench, for lessons: alone on a visit, or under the running robot."""

from collections.abc import Callable

from tapreach.drivers.arduino.fault_words import fault_sentence
from tapreach.drivers.arduino.servo_way import ServoWay
from tapreach.drivers.arduino.servos import Pulses
from tapreach.drivers.arduino.talk import Talk
from tapreach.drivers.arduino.wheels import FIRMWARE_GAINS
from tapreach.drivers.arduino.wire import Fault, Feature, Gains, ServoLimits, Stop
from tapreach.errors import DriverError, LinkLost
from tapreach.robot.clock import MS, SECOND
from tapreach.robot.link_section import LinkSection
from tapreach.robot.own_moves import OwnMove
from tapreach.robot.teachable import CarryOut, ServoIndex, Side, WheelTicks

SPEED, ACCELERATION, PWM = 300, 600, 110
"""[ticks/s], [ticks/s²] and the PWM of 255 that this speed stands for while there is no feedback."""
WITHOUT_FEEDBACK = Gains(0, 0, 0, round(256 * PWM / SPEED), SPEED, ACCELERATION)
SPIN_NS, REST_NS, SETTLE_NS = 1 * SECOND, 500 * MS, 100 * MS


class BoardBench:
    """See Bench.

    begin_spin: begins to turn both wheels at ticks/s. gains: what the board goes by otherwise. rests: the
    pulses of the stowed pose [µs].
    """

    def __init__(
        self,
        talk: Talk,
        begin_spin: Callable[[int, int], OwnMove],
        carry_out: CarryOut,
        gains: Gains,
        rests: Pulses,
    ) -> None:
        self._talk, self._begin_spin, self._carry_out = talk, begin_spin, carry_out
        self._gains, self._rests = gains, rests

    @property
    def counts_turns(self) -> bool:
        """See Bench."""
        welcome = self._talk.session.welcome
        return welcome is None or Feature.STEPPER not in welcome.features

    def ticks(self) -> WheelTicks:
        """See Bench."""
        told = self._talk.telemetry
        if told is None:
            raise LinkLost(self._talk.reason)
        if Fault.ENCODER_ILLEGAL in told.faults:
            raise DriverError(fault_sentence(Fault.ENCODER_ILLEGAL))
        return WheelTicks(told.left, told.right)

    async def pause(self, duration_ns: int) -> None:
        """See Bench."""
        await self._talk.pause(duration_ns)

    async def take_feedback_off(self) -> None:
        """See Bench."""
        await self._talk.require(WITHOUT_FEEDBACK)

    async def give_feedback_back(self) -> bool:
        """See Bench."""
        try:
            self._talk.say(Stop())
            await self._talk.require(self._gains)
        except DriverError:
            return False
        return True

    async def spin(self, side: Side) -> None:
        """See Bench."""
        left, right = (SPEED if side == each else 0 for each in ("left", "right"))
        await self._carry_out(lambda: self._begin_spin(left, right))
        await self._talk.pause(REST_NS)
        told = self._talk.telemetry
        if told is not None and told.faults:
            raise DriverError(f"a fault stands: {fault_sentence(told.faults)}")

    def rest_us(self, index: ServoIndex) -> int:
        """See Bench."""
        return self._rests[index]

    async def limit_servo(self, index: ServoIndex, low_us: int, high_us: int) -> None:
        """See Bench."""
        rest_us = max(low_us, min(high_us, self._rests[index]))
        await self._talk.require(ServoLimits(index, low_us, high_us, rest_us))

    async def send_servo(self, index: ServoIndex, pulse_us: int) -> None:
        """See Bench."""
        await self._carry_out(lambda: ServoWay(index, pulse_us, self._talk), moves_arm=True)
        await self._talk.pause(SETTLE_NS)


def gains_of(link: LinkSection) -> Gains:
    """Return the gains of the robot file, or the firmware's own, with the firmware's limits."""
    control = link.wheel_control
    if control is None:
        return FIRMWARE_GAINS
    kp, ki, kd, feedforward = (
        round(256 * part) for part in (control.kp, control.ki, control.kd, control.feedforward)
    )
    return Gains(kp, ki, kd, feedforward, FIRMWARE_GAINS.max_speed, FIRMWARE_GAINS.max_acceleration)
