"""A robot without physics: bar-coded pictures at a steady rate, wheels that only note what they are told."""

import asyncio
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tapreach.geometry.pixel import ImageSize
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.clock import SECOND, Clock
from tapreach.robot.config import RobotDescription
from tapreach.robot.driver_robot import DriverRobot
from tapreach.robot.interface import Listeners, Unsubscribe
from tapreach.robot.messages import (
    STILL,
    ArmPose,
    ArmState,
    Frame,
    Health,
    LinkStatus,
    Odometry,
    Twist,
)

STATE_RATE_HZ = 50


@dataclass(frozen=True, slots=True)
class SentTwist:
    """What the wheels were told, and when."""

    sent_ns: int
    twist: Twist


class PatternBase:
    """Wheels that obey at once and tell `on_drive` of every call."""

    def __init__(self, clock: Clock, on_drive: Callable[[SentTwist], None]) -> None:
        self._clock = clock
        self._on_drive = on_drive
        self._listeners = Listeners()
        self._twist = STILL

    def drive(self, twist: Twist) -> Twist:
        """See Base."""
        self._twist = twist
        self._on_drive(SentTwist(self._clock.now_ns(), twist))
        return twist

    def subscribe(self, listener: Callable[[Odometry], None]) -> Unsubscribe:
        """See Base."""
        return self._listeners.subscribe(listener)

    def tell(self, now_ns: int) -> None:
        """Report the present twist; the pose stays at the start."""
        self._listeners.tell(Odometry(now_ns, PlanarPose(0.0, 0.0, 0.0), self._twist, 0.0))


class PatternArm:
    """An arm that is where it was sent."""

    def __init__(self, pose: ArmPose) -> None:
        self._pose = pose
        self._listeners = Listeners()

    def move(self, target: ArmPose) -> ArmPose:
        """See Arm."""
        self._pose = target
        return target

    def subscribe(self, listener: Callable[[ArmState], None]) -> Unsubscribe:
        """See Arm."""
        return self._listeners.subscribe(listener)

    def tell(self, now_ns: int) -> None:
        """Report the pose."""
        self._listeners.tell(ArmState(now_ns, self._pose, self._pose, False))


class PatternCamera:
    """Tells the pictures one after the other; frame N shows the bar code N modulo their number."""

    def __init__(self, size: ImageSize, jpegs: Sequence[bytes]) -> None:
        self._size = size
        self._jpegs = jpegs
        self._listeners = Listeners()
        self._frame_id = 0

    def subscribe(self, listener: Callable[[Frame], None]) -> Unsubscribe:
        """See FrameSource."""
        return self._listeners.subscribe(listener)

    def tell(self, now_ns: int) -> None:
        """Deliver the next frame, captured now: the camera's own delay is no part of what is measured."""
        self._frame_id += 1
        jpeg = self._jpegs[self._frame_id % len(self._jpegs)]
        self._listeners.tell(Frame(self._frame_id, now_ns, now_ns, self._size, jpeg))


class PatternRobot(DriverRobot):
    """See Robot. Pictures and states come from the event loop's own timers."""

    def __init__(
        self,
        description: RobotDescription,
        jpegs: Sequence[bytes],
        clock: Clock,
        on_drive: Callable[[SentTwist], None],
    ) -> None:
        super().__init__(description)
        self._clock = clock
        self.base = PatternBase(clock, on_drive)
        self.arm = PatternArm(description.arm.standard.pose())
        self.frames = PatternCamera(description.camera.model().size, jpegs)
        self._timers: list[asyncio.Task[None]] = []

    async def connect(self) -> None:
        """See Robot."""
        self._timers = [
            asyncio.create_task(self._repeat(self.description.camera.rate_hz, self.frames.tell)),
            asyncio.create_task(self._repeat(STATE_RATE_HZ, self._tell_state)),
        ]
        self._set_health(Health(LinkStatus.RUNNING))

    async def close(self) -> None:
        """See Robot."""
        for timer in self._timers:
            timer.cancel()
        self._timers = []

    def _tell_state(self, now_ns: int) -> None:
        self.base.tell(now_ns)
        self.arm.tell(now_ns)

    async def _repeat(self, rate_hz: float, tell: Callable[[int], None]) -> None:
        # Against a fixed schedule, so that lateness does not add up; what was missed is not caught up.
        period_ns = round(SECOND / rate_hz)
        when_ns = self._clock.now_ns()
        while True:
            now_ns = self._clock.now_ns()
            tell(now_ns)
            when_ns = max(when_ns + period_ns, now_ns)
            await self._clock.sleep_until(when_ns)
