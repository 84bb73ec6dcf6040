"""Everything that runs beside the sockets, composed around one robot."""

import asyncio
from pathlib import Path

from tapreach.control.authority import Authority
from tapreach.control.deadman import Deadman
from tapreach.control.emergency_stop import EmergencyStop
from tapreach.control.lease import Lease
from tapreach.control.loop import ControlLoop
from tapreach.control.loop_pilot import LoopPilot
from tapreach.errors import FrameError, InputError, PoseNotYetKnown, TapreachError
from tapreach.estimation.pose_history import PoseHistory
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.recording.captures import CaptureContext, CaptureFolder
from tapreach.robot.clock import MS, Clock
from tapreach.robot.frame_store import FrameStore
from tapreach.robot.interface import Robot, Unsubscribe
from tapreach.robot.messages import Frame, Health, Odometry
from tapreach.server.guests import Guests
from tapreach.server.hub import Hub
from tapreach.server.markers import MarkerProjection
from tapreach.server.messages import CapturesChanged
from tapreach.server.planned_path import PlannedPath
from tapreach.server.state_view import StateView
from tapreach.server.targets import Targets
from tapreach.server.task_desk import ComputeService, TaskDesk
from tapreach.server.video_feed import VideoFeed
from tapreach.tasks.compute import ComputeProcess
from tapreach.tasks.delay_kept import DelayKept

STATE_PERIOD_NS = 100 * MS
POSE_LAG_NS = 50 * MS
"""A frame that is newer than the newest odometry by less than this takes the newest pose."""


class Station:
    """The robot, who may move it, and what is shown of it. One per process."""

    def __init__(
        self,
        robot: Robot,
        clock: Clock,
        captures: Path,
        compute: ComputeService | None = None,
        robot_file: Path | None = None,
    ) -> None:
        """`captures`: folder for stored frames. `compute`: a process of its own when left out.

        `robot_file`: where lessons write what the robot was taught; without one there are none.
        """
        self.robot = robot
        self.robot_file = robot_file
        self.clock = clock
        self.frames = FrameStore()
        self.poses = PoseHistory()
        self.camera_delay = DelayKept()
        self.captures = CaptureFolder(captures)
        self.guests = Guests()
        self.hub = Hub()
        self.targets = Targets(self.hub)
        self.planned_path = PlannedPath(self.hub, robot.description)
        self.emergency_stop = EmergencyStop(clock, self._on_emergency_stop)
        self.lease = Lease(clock, self._on_lease)
        self.deadman = Deadman(clock)
        self.authority = Authority(robot, clock, self.lease, self.deadman, self.emergency_stop)
        self.loop = ControlLoop(self.authority, self._on_task_refused)
        self.tasks = TaskDesk(self, LoopPilot(self.loop, robot), compute or ComputeProcess())
        self._projection = MarkerProjection(robot.description.camera)
        self.feed = VideoFeed(self._describe)
        self._holder_id: int | None = None
        self._state = StateView(self)
        self._unsubscribes: list[Unsubscribe] = []
        self._background: list[asyncio.Task[None]] = []
        self.failed: asyncio.Future[None] | None = None

    async def start(self) -> None:
        """Connect the robot and begin. Raises DriverError or SetupError with what to do."""
        self.failed = asyncio.get_running_loop().create_future()
        self._unsubscribes = [
            self.robot.base.subscribe(self._on_odometry),
            self.robot.frames.subscribe(self._on_frame),
            self.robot.subscribe_health(self._on_health),
        ]
        await self.robot.connect()
        self.tasks.start()
        self._background = [
            asyncio.create_task(self.loop.run(), name="control loop"),
            asyncio.create_task(self._tell_state(), name="state"),
        ]
        for task in self._background:
            task.add_done_callback(self._on_background_end)

    def prepare_end(self) -> None:
        """Stop the wheels and end the streams, so that open connections can be closed."""
        self.loop.stop("the server is closing")
        self.feed.end()

    async def stop(self) -> None:
        """Stop the wheels, then everything else. Safe to call twice."""
        self.prepare_end()
        await self.tasks.close()
        background, self._background = self._background, []
        for task in background:
            task.cancel()
        await asyncio.gather(*background, return_exceptions=True)
        for unsubscribe in self._unsubscribes:
            unsubscribe()
        await self.robot.close()

    def tell_state(self) -> None:
        """Tell every page the present state now."""
        self.hub.tell("state", self._state.now())

    def base_pose(self) -> PlanarPose:
        """Return where the robot is now; the start before the first odometry."""
        odometry = self.loop.senses.odometry
        return odometry.world_from_base if odometry else PlanarPose()

    def pose_at(self, captured_ns: int) -> PlanarPose | None:
        """Return where the base was when a frame of that time stamp was taken; None where nobody knows."""
        taken_ns = self.camera_delay.taken_ns(captured_ns)
        try:
            return self.poses.at(taken_ns)
        except PoseNotYetKnown:
            return self._newest_pose_unless_old(taken_ns)
        except TapreachError:
            return None

    def session_gone(self, session_id: int) -> None:
        """The socket is closed: the wheels stop at once when it was the operator's, and the lease is free."""
        self.guests.leave(session_id)
        self.lease.leave(session_id)
        self.tell_state()

    async def capture(self, frame_id: int | None) -> str:
        """Store a frame, the newest for None, and return the capture's id. Raises TapreachError."""
        frame = self.frames.newest if frame_id is None else self.frames.get(frame_id)
        if frame is None:
            raise FrameError("there is no picture yet")
        arm = self.loop.senses.arm
        context = CaptureContext(
            taken_at=self.clock.wall_time(),
            world_from_base=self.pose_at(frame.captured_ns),
            arm=arm.pose if arm else None,
            camera=self.robot.description.camera,
            robot=self.robot.description.name,
        )
        capture_id = await asyncio.to_thread(self.captures.save, frame, context)
        self.captures_changed(capture_id)
        return capture_id

    def captures_changed(self, newest: str | None = None) -> None:
        """Tell every page to ask for the list again."""
        self.hub.tell("captures", CapturesChanged(newest=newest))

    def _newest_pose_unless_old(self, taken_ns: int) -> PlanarPose | None:
        if len(self.poses) == 0:
            return None
        newest_ns, pose = self.poses.newest()
        return pose if taken_ns - newest_ns < POSE_LAG_NS else None

    def _describe(self, frame: Frame) -> bytes:
        return self._projection.meta(
            self.pose_at(frame.captured_ns),
            self.targets.marks,
            self.planned_path.lines_in_world,
            self.tasks.fetch_lines_in_world,
        )

    def _on_odometry(self, reading: Odometry) -> None:
        try:
            self.poses.add(reading.captured_ns, reading.world_from_base)
        except InputError:
            return  # two readings of the same time say the same

    def _on_frame(self, frame: Frame) -> None:
        self.frames.add(frame)
        self.feed.publish(frame)

    def _on_health(self, health: Health) -> None:
        if not health.is_running:
            self.loop.stop(f"robot {health.status}: {health.reason}")
        self.tell_state()

    def _on_emergency_stop(self) -> None:
        if self.emergency_stop.is_set:
            self.loop.stop(f"emergency stop {self.emergency_stop.text}")
            self.loop.hold_arm()
        self.tell_state()

    def _on_lease(self) -> None:
        holder_id = self.lease.status.holder_id
        if holder_id != self._holder_id:
            self._holder_id = holder_id
            self.deadman.gone()
            self.loop.stop("the operator has changed")
            self.tasks.operator_changed()
        self.tell_state()

    def _on_task_refused(self, reason: str) -> None:
        self.tasks.cancel(reason)

    async def _tell_state(self) -> None:
        told_pose = self.base_pose()
        while True:
            if self.tasks.is_running and self._holder_id is not None:
                self.lease.command_given(self._holder_id)
            self.lease.tick()
            self.tell_state()
            if self.base_pose() != told_pose:
                told_pose = self.base_pose()
                self.targets.base_moved(told_pose)
            await self.clock.sleep_until(self.clock.now_ns() + STATE_PERIOD_NS)

    def _on_background_end(self, task: asyncio.Task[None]) -> None:
        if task.cancelled() or self.failed is None or self.failed.done():
            return
        error = task.exception() or TapreachError(f"{task.get_name()} ended")
        self.failed.set_exception(error)
