"""A board with Tapreach firmware: session, wheels, servos, and how it is."""

from collections.abc import Callable, Sequence

from tapreach.drivers.arduino.arm import BoardArm
from tapreach.drivers.arduino.base import BoardBase
from tapreach.drivers.arduino.fault_words import fault_sentence, restart_sentence
from tapreach.drivers.arduino.session import Phase, Session
from tapreach.drivers.arduino.talk import Talk
from tapreach.drivers.arduino.wheels import FIRMWARE_GAINS, Wheels
from tapreach.drivers.arduino.wire import (
    Clear,
    Fault,
    Gains,
    Moved,
    Result,
    Stop,
    Telemetry,
    ToFirmware,
    Welcome,
    Wiring,
)
from tapreach.drivers.arduino.wiring import wiring_of
from tapreach.errors import LinkLost
from tapreach.robot.clock import SECOND, Clock
from tapreach.robot.config import RobotDescription
from tapreach.robot.messages import Health, LinkStatus

RESTART_SHOWN_NS = 1 * SECOND
"""So long a restart stays said, and nothing moves."""
CLEAR_AFTER_NS = 2 * SECOND
"""A fault is cleared when it was said, and nobody wished to move, for so long."""
OF_RESETS = Fault.WATCHDOG_RESET | Fault.BROWN_OUT_RESET
NO_FIRMWARE = "the port is open and no Tapreach firmware answers: run tapreach firmware flash"
NO_FRAMES = "what comes from the board are no frames: check [link] baud and protocol"


class FramedBoard:
    """Speaks the framed protocol. The link tells found, heard and lost; `tick` comes every 20 ms."""

    def __init__(
        self,
        description: RobotDescription,
        clock: Clock,
        write: Callable[[bytes], None],
        tell: Callable[[Health], None],
    ) -> None:
        self._description, self._clock, self._tell = description, clock, tell
        self.session = Session(clock, write, self, self._setup)
        self.talk = Talk(self.session, clock, lambda: self._restart or self._reason)
        self.base = BoardBase(description.base, self.session, clock, self._require_link)
        self.arm = BoardArm(description.arm, self.session, clock, self._require_link)
        self._reason = "not connected"
        self._restart = ""
        self._shown_until_ns = 0
        self._faults = Fault(0)
        self._faulted_ns = self._cleared_ns = 0
        self.battery_mv = 0
        self.lends_gains = False
        """Once a lesson has taken the gains, every opening gives them back."""

    def found(self) -> None:
        """The link is open."""
        self.session.start()

    def heard(self, data: bytes) -> None:
        """Take bytes from the link."""
        self.session.take(data)

    def lost(self, reason: str) -> None:
        """The link is gone."""
        self.session.end()
        self._lose(reason)

    def tick(self) -> str:
        """Do what the time asks for. Returns why the link should be opened anew, or ''."""
        self.session.tick()
        if self.session.phase is Phase.OPEN:
            self.base.tick()
            self.arm.tick()
            self._clear_faults()
            self._tell_health()
        if self.session.is_without_answer:
            return NO_FRAMES if self.session.bad_frames else NO_FIRMWARE
        return ""

    @property
    def is_serving(self) -> bool:
        """True while the board answers."""
        return self.session.phase is Phase.OPEN

    def halt(self) -> None:
        """Wheels off, as far as somebody hears it."""
        if self.session.phase in (Phase.OPEN, Phase.SETTING_UP):
            self.session.send(Stop())

    def on_phase(self, phase: Phase, reason: str) -> None:
        """See SessionEars."""
        if phase is Phase.OPEN:
            self._reason = ""
        else:
            self._lose(self._restart or reason)

    def on_restart(self, welcome: Welcome) -> None:
        """See SessionEars."""
        self._restart = restart_sentence(welcome.reset_cause)
        self._shown_until_ns = self._clock.now_ns() + RESTART_SHOWN_NS
        self.base.rebase()
        self.arm.forget()

    def on_telemetry(self, telemetry: Telemetry, captured_ns: int) -> None:
        """See SessionEars."""
        self.battery_mv = telemetry.battery_mv
        self.talk.on_telemetry(telemetry)
        if telemetry.faults & ~self._faults:
            self._faulted_ns = self._clock.now_ns()
        self._faults = telemetry.faults
        self.base.take(telemetry, captured_ns)
        self.arm.take(telemetry, captured_ns)

    def on_answer(self, message: ToFirmware, result: Result) -> None:
        """See SessionEars."""
        self.talk.on_answer(message, result)
        self.base.on_answer(message, result)
        self.arm.on_answer(message, result)

    def on_moved(self, moved: Moved) -> None:
        """See SessionEars."""
        self.base.on_moved(moved)

    def _setup(self) -> Sequence[ToFirmware]:
        # A reset's own latched fault was said as the reason of the restart; others are said first.
        # The wiring always: the board may still have that of another robot file.
        link = self._description.link
        gains = (self.gains,) if self.lends_gains or (link and link.wheel_control) else ()
        return (self.wiring, *self.arm.limits(), *gains, Clear(OF_RESETS))

    @property
    def wiring(self) -> Wiring:
        """Which parts the board has to turn round, by the robot file."""
        link = self._description.link
        return wiring_of(link.reversed if link else ())

    @property
    def gains(self) -> Gains:
        """The robot file's, or those the firmware starts with."""
        control = self._description.link.wheel_control if self._description.link else None
        if control is None:
            return FIRMWARE_GAINS
        wheels = Wheels(self._description.base)
        parts = (control.kp, control.ki, control.kd, control.feedforward)
        kp, ki, kd, feedforward = (round(256 * part) for part in parts)
        return Gains(kp, ki, kd, feedforward, wheels.fastest, wheels.quickest)

    def _clear_faults(self) -> None:
        now_ns = self._clock.now_ns()
        since_ns = max(self._faulted_ns, self._cleared_ns, self.base.wished_ns)
        if self._faults and now_ns - since_ns >= CLEAR_AFTER_NS:
            self._cleared_ns = now_ns
            self.session.send(Clear(self._faults))

    def _tell_health(self) -> None:
        if self._clock.now_ns() >= self._shown_until_ns:
            self._restart = ""
        sentence = self._restart or fault_sentence(self._faults)
        if sentence:
            self._tell(Health(LinkStatus.LOST, sentence))
        elif self.base.is_known:
            self._tell(Health(LinkStatus.RUNNING))

    def _lose(self, reason: str) -> None:
        self._reason, self._faults = reason, Fault(0)
        self.talk.lose()
        self.base.lose(reason)
        self.arm.lose()
        self._tell(Health(LinkStatus.LOST, reason))

    def _require_link(self) -> None:
        if self.session.phase is not Phase.OPEN or self._restart:
            raise LinkLost(self._restart or self._reason)
