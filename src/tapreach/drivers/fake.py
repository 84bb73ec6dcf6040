"""A robot without hardware, physics or noise: it goes where it is sent and sees a drawn world.

For trying the page and the protocol on any machine, and for tests that turn the clock by hand.
"""

import asyncio
import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace

from tapreach.drivers.fake_picture import FakePicture
from tapreach.errors import LinkLost
from tapreach.geometry.pixel import ImageSize
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.arm_section import ArmSection
from tapreach.robot.clock import MS, SECOND, Clock
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

STEP_NS = 10 * MS
DEADMAN_NS = 150 * MS
CLAW_TRAVEL = math.radians(70.0)


class FakeBase:
    """Wheels that turn exactly as told. After the deadman has tripped, a zero must come before they move."""

    def __init__(self, clock: Clock, description: RobotDescription, require_link: Callable[[], None]) -> None:
        self._clock = clock
        self._limits = description.base
        self._require_link = require_link
        self._listeners = Listeners()
        self._heard_ns = clock.now_ns()
        self._twist = STILL
        self._is_tripped = False
        self.odometry = Odometry(clock.now_ns(), PlanarPose(), STILL, 0.0)

    def drive(self, twist: Twist) -> Twist:
        """See Base."""
        self._require_link()
        self._heard_ns = self._clock.now_ns()
        self._is_tripped = self._is_tripped and not twist.is_zero
        self._twist = STILL if self._is_tripped else self._limited(twist)
        return self._twist

    def subscribe(self, listener: Callable[[Odometry], None]) -> Unsubscribe:
        """See Base."""
        return self._listeners.subscribe(listener)

    def halt(self) -> None:
        """Stop as the deadman does."""
        self._twist, self._is_tripped = STILL, True

    def step(self) -> None:
        """Move on to the present time and tell."""
        now_ns, last = self._clock.now_ns(), self.odometry
        if now_ns - self._heard_ns >= DEADMAN_NS:
            self.halt()
        elapsed = (now_ns - last.captured_ns) / SECOND
        distance, turn = self._twist.linear * elapsed, self._twist.angular * elapsed
        pose = last.world_from_base.after_arc(distance, turn)
        self.odometry = Odometry(now_ns, pose, self._twist, last.distance + abs(distance))
        self._listeners.tell(self.odometry)

    def _limited(self, twist: Twist) -> Twist:
        most_linear, most_angular = self._limits.max_linear, self._limits.max_angular
        return Twist(
            max(-most_linear, min(most_linear, twist.linear)),
            max(-most_angular, min(most_angular, twist.angular)),
        )


class FakeArm:
    """Servos that turn at their speed, without load or play."""

    def __init__(self, clock: Clock, section: ArmSection, require_link: Callable[[], None]) -> None:
        self._clock = clock
        self._section = section
        self._require_link = require_link
        self._listeners = Listeners()
        pose = section.stowed.pose()
        self.state = ArmState(clock.now_ns(), pose, pose, False)

    def move(self, target: ArmPose) -> ArmPose:
        """See Arm."""
        self._require_link()
        allowed = self._limited(target)
        self.state = replace(self.state, target=allowed, is_moving=allowed != self.state.pose)
        return allowed

    def subscribe(self, listener: Callable[[ArmState], None]) -> Unsubscribe:
        """See Arm."""
        return self._listeners.subscribe(listener)

    def step(self) -> None:
        """Move on to the present time and tell."""
        now_ns, state = self._clock.now_ns(), self.state
        turn = math.radians(self._section.speed_deg_s) * (now_ns - state.captured_ns) / SECOND
        pose = ArmPose(
            _towards(state.pose.rotation, state.target.rotation, turn),
            _towards(state.pose.shoulder, state.target.shoulder, turn),
            _towards(state.pose.elbow, state.target.elbow, turn),
            _towards(state.pose.claw, state.target.claw, turn * self._section.claw_max / CLAW_TRAVEL),
        )
        self.state = ArmState(now_ns, pose, state.target, pose != state.target)
        self._listeners.tell(self.state)

    def _limited(self, target: ArmPose) -> ArmPose:
        section = self._section
        return ArmPose(
            _within(target.rotation, section.rotation_limits_deg),
            _within(target.shoulder, section.shoulder_limits_deg),
            _within(target.elbow, section.elbow_limits_deg),
            max(0.0, min(section.claw_max, target.claw)),
        )


class FakeCamera:
    """Draws frames; while one is being drawn no other is begun."""

    def __init__(self, clock: Clock, description: RobotDescription) -> None:
        self._clock = clock
        self._section = description.camera
        self._picture: FakePicture | None = None
        self._listeners = Listeners()
        self._frame_id = 0
        self._drawing: asyncio.Task[None] | None = None
        self.is_running = True

    def subscribe(self, listener: Callable[[Frame], None]) -> Unsubscribe:
        """See FrameSource."""
        return self._listeners.subscribe(listener)

    def shoot(self, world_from_base: PlanarPose, in_thread: bool) -> None:
        """Draw a frame as seen from `world_from_base` and tell, at once or when a thread has drawn it."""
        if not self.is_running or (self._drawing is not None and not self._drawing.done()):
            return
        self._frame_id += 1
        if in_thread:
            self._drawing = asyncio.create_task(self._draw_aside(world_from_base, self._clock.now_ns()))
        else:
            captured_ns = self._clock.now_ns()
            self._tell(captured_ns, self._draw(world_from_base))

    async def finish(self) -> None:
        """Wait for the frame being drawn."""
        if self._drawing is not None:
            await self._drawing

    async def _draw_aside(self, world_from_base: PlanarPose, captured_ns: int) -> None:
        self._tell(captured_ns, await asyncio.to_thread(self._draw, world_from_base))

    def _draw(self, world_from_base: PlanarPose) -> bytes:
        self._picture = self._picture or FakePicture(self._section)
        return self._picture.jpeg(world_from_base, f"{self._frame_id}")

    def _tell(self, captured_ns: int, jpeg: bytes) -> None:
        size = ImageSize(self._section.width, self._section.height)
        self._listeners.tell(Frame(self._frame_id, captured_ns, self._clock.now_ns(), size, jpeg))


class FakeRobot(DriverRobot):
    """See Robot. Moves in steps of 10 ms of the given clock.

    `draws_in_thread` keeps drawing out of the event loop; with a clock turned by hand it must be False, so
    that every frame is told at its own time.
    """

    def __init__(self, description: RobotDescription, clock: Clock, draws_in_thread: bool = True) -> None:
        super().__init__(description)
        self._draws_in_thread = draws_in_thread
        self._clock = clock
        self._running: asyncio.Task[None] | None = None
        self.base = FakeBase(clock, description, self._require_link)
        self.arm = FakeArm(clock, description.arm, self._require_link)
        self.frames = FakeCamera(clock, description)

    async def connect(self) -> None:
        """See Robot."""
        self._set_health(Health(LinkStatus.RUNNING))
        self._running = asyncio.create_task(self._run(), name="fake robot")

    async def close(self) -> None:
        """See Robot."""
        self.lose("closed")
        if self._running is not None:
            self._running.cancel()
            with suppress(asyncio.CancelledError):
                await self._running
            self._running = None
        await self.frames.finish()

    def lose(self, reason: str) -> None:
        """Lose the link, as when a cable is pulled: the wheels stop, commands raise LinkLost."""
        if self._health.status is not LinkStatus.LOST:
            self.base.halt()
            self.base.step()
            self._set_health(Health(LinkStatus.LOST, reason))

    def _require_link(self) -> None:
        if not self._health.is_running:
            raise LinkLost(
                f"the fake robot is {self._health.status}: {self._health.reason or 'not connected'}"
            )

    async def _run(self) -> None:
        start_ns, steps, shots = self._clock.now_ns(), 0, 0
        shot_ns = round(SECOND / self.description.camera.rate_hz)
        while self._health.is_running:
            self.base.step()
            self.arm.step()
            if self._clock.now_ns() >= start_ns + shots * shot_ns:
                shots = (self._clock.now_ns() - start_ns) // shot_ns + 1
                self.frames.shoot(self.base.odometry.world_from_base, self._draws_in_thread)
            steps = (self._clock.now_ns() - start_ns) // STEP_NS + 1
            await self._clock.sleep_until(start_ns + steps * STEP_NS)


def _towards(value: float, goal: float, step: float) -> float:
    return goal if abs(goal - value) <= step else value + math.copysign(step, goal - value)


def _within(angle: float, limits_deg: tuple[float, float]) -> float:
    low, high = (math.radians(limit) for limit in limits_deg)
    return max(low, min(high, angle))
