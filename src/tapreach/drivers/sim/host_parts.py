"""Base, arm and camera of a simulated robot as the host sees them, whatever carries the messages."""

from collections.abc import Callable

from tapreach.drivers.limits import limited_arm, limited_twist
from tapreach.drivers.sim.host_state import arm_state
from tapreach.drivers.sim.protocol import Drive, Message, MoveArm, Telemetry
from tapreach.drivers.tick_odometry import TickOdometry
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.arm_section import ArmSection
from tapreach.robot.clock import Clock
from tapreach.robot.config import BaseSection, CameraSection
from tapreach.robot.interface import Listeners, Unsubscribe
from tapreach.robot.messages import STILL, ArmPose, ArmState, Frame, Odometry, Twist

Send = Callable[[Message], None]


class HostBase:
    """The wheels: sends twists, hears ticks."""

    def __init__(self, config: BaseSection, send: Send) -> None:
        self._config = config
        self._send = send
        self._odometry = TickOdometry(config)
        self._listeners = Listeners()
        self._board_needs_zero = False

    def drive(self, twist: Twist) -> Twist:
        """See Base. While the board waits for a zero after its deadman, what is sent moves nothing: STILL."""
        sent = limited_twist(twist, self._config)
        self._send(Drive(sent.linear, sent.angular))
        return STILL if self._board_needs_zero and not sent.is_zero else sent

    def subscribe(self, listener: Callable[[Odometry], None]) -> Unsubscribe:
        """See Base."""
        return self._listeners.subscribe(listener)

    def take(self, telemetry: Telemetry) -> None:
        """Take what the board told."""
        self._board_needs_zero = telemetry.needs_zero
        counted = telemetry.left_ticks, telemetry.right_ticks
        self._listeners.tell(self._odometry.update(telemetry.captured_ns, *counted))


class HostArm:
    """The servos."""

    def __init__(self, config: ArmSection, send: Send) -> None:
        self._config = config
        self._send = send
        self._listeners = Listeners()

    def move(self, target: ArmPose) -> ArmPose:
        """See Arm."""
        sent = limited_arm(target, self._config)
        self._send(MoveArm(sent.rotation, sent.shoulder, sent.elbow, sent.claw))
        return sent

    def subscribe(self, listener: Callable[[ArmState], None]) -> Unsubscribe:
        """See Arm."""
        return self._listeners.subscribe(listener)

    def take(self, telemetry: Telemetry) -> None:
        """Take what the board told."""
        self._listeners.tell(arm_state(telemetry))


class HostCamera:
    """The camera: numbers the pictures as they arrive."""

    def __init__(self, config: CameraSection, clock: Clock) -> None:
        self._size = ImageSize(config.width, config.height)
        self._clock = clock
        self._listeners = Listeners()
        self._count = 0

    def subscribe(self, listener: Callable[[Frame], None]) -> Unsubscribe:
        """See FrameSource."""
        return self._listeners.subscribe(listener)

    def take(self, captured_ns: int, jpeg: bytes) -> None:
        """Take a picture that has just arrived."""
        self._count += 1
        self._listeners.tell(Frame(self._count, captured_ns, self._clock.now_ns(), self._size, jpeg))
