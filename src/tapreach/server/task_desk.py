"""The seam between sessions and tasks: starts, shows and cancels what the robot does by itself."""

import asyncio
from collections.abc import Coroutine
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, Protocol

from tapreach.control.gate import refusal
from tapreach.control.pilot import Pilot
from tapreach.errors import InputError, LinkLost
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel, require_inside
from tapreach.robot.clock import SECOND
from tapreach.robot.messages import Frame
from tapreach.server.fetch_desk import FetchDesk
from tapreach.server.lesson_desk import LessonDesk
from tapreach.server.messages import GuideView, TaskView
from tapreach.server.messages_lesson import LessonName
from tapreach.tasks.delay_task import DelayTask
from tapreach.tasks.fetch.fetch_state import Mode, Verb
from tapreach.tasks.fetch.known_target import tap_on
from tapreach.tasks.floor_guess import floor_guess
from tapreach.tasks.guide import Guide
from tapreach.tasks.guide_state import GuideKind, GuideState
from tapreach.tasks.locate import ACCURACY, LocateTask
from tapreach.tasks.runner import TaskProgress, TaskRunner
from tapreach.tasks.target import Target
from tapreach.tasks.task import Compute, Tap, TaskContext, TaskReport

if TYPE_CHECKING:
    from tapreach.server.station import Station

CAMERA_SILENCE_NS = 2 * SECOND


class ComputeService(Compute, Protocol):
    """A Compute with a life of its own."""

    async def start(self) -> None:
        """Make it ready; calls before that wait."""
        ...

    async def close(self) -> None:
        """End it. Safe to call twice."""
        ...


class TaskDesk:
    """One task at a time, one guide at a time, both by whoever holds the lease."""

    def __init__(self, station: "Station", pilot: Pilot, compute: ComputeService) -> None:
        self._station = station
        self._compute = compute
        self._context = TaskContext(
            description=station.robot.description,
            robot=station.robot,
            pilot=pilot,
            frames=station.frames,
            poses=station.poses,
            compute=compute,
            clock=station.clock,
            next_frame=self._next_frame,
            report=_report_nowhere,
            show_target=self._show_target,
            show_move=station.planned_path.show,
            show_fetch=lambda state: self._fetch.show(state),
            camera_delay=station.camera_delay,
        )
        self._runner = TaskRunner(self._context, station.loop, self._tell_progress)
        self._fetch = FetchDesk(station.hub, self._runner)
        self.lessons = LessonDesk(station.hub, self._runner, station.robot, station.robot_file)
        self._guide: Guide | None = None
        self._guide_owner_id: int | None = None
        self._located_target_id: int | None = None
        self._background: set[asyncio.Task[None]] = set()

    @property
    def is_running(self) -> bool:
        """True while a task runs."""
        return self._runner.is_running

    def start(self) -> None:
        """Begin to make the computing process ready; does not wait for it."""
        self._in_background(self._compute.start())

    async def close(self) -> None:
        """End guide, task and computing process."""
        await self._runner.close()
        await self._compute.close()
        for task in tuple(self._background):
            task.cancel()
        await asyncio.gather(*self._background, return_exceptions=True)

    def cancel(self, reason: str) -> bool:
        """Stop the running task; False when none runs."""
        return self._runner.cancel(reason)

    def locate(self, tap: Tap, session_id: int, accuracy: float = ACCURACY) -> None:
        """Start locating. Raises FrameError, InputError; and InputError with the gate's reason."""
        self._require_tap(tap)
        self._require_motion(session_id)
        target_id = self._station.targets.new_id()
        self._runner.start(LocateTask(tap, target_id, accuracy=accuracy), session_id)
        self._located_target_id = target_id

    @property
    def fetch_lines_in_world(self) -> list[FloatArray]:
        """What is to be drawn of the plan to fetch, (n, 3) each [m]."""
        return self._fetch.lines_in_world

    def fetch(self, tap: Tap, mode: Mode, session_id: int) -> None:
        """Start to fetch what was tapped. Raises as `locate`."""
        self._require_tap(tap)
        self._require_motion(session_id)
        target_id = self._station.targets.new_id()
        self._fetch.start(tap, target_id, mode, self._station.targets.known(), session_id)
        self._located_target_id = target_id

    def fetch_target(self, target_id: int, mode: Mode, session_id: int) -> None:
        """Start to fetch a target that has a position, by where it is in the newest picture.

        Raises as `fetch`, and InputError when it is not in the picture.
        """
        self._require_motion(session_id)
        tap = tap_on(self._context, self._station.targets.get(target_id))
        others = [each for each in self._station.targets.known() if each.target_id != target_id]
        self._fetch.start(tap, target_id, mode, others, session_id)
        self._located_target_id = target_id

    def teach(self, lesson: LessonName, session_id: int) -> None:
        """Begin a lesson. Raises InputError."""
        self._require_motion(session_id)
        self.lessons.start(lesson, session_id)

    async def measure_delay(self, session_id: int) -> TaskProgress | None:
        """Measure how late the camera is, and return how that ended. Raises InputError."""
        self._require_motion(session_id)
        self._runner.start(DelayTask(), session_id)
        await self._runner.wait()
        return self._runner.progress

    def confirm_fetch(self) -> None:
        """The operator says yes. Raises InputError when nothing waits for it."""
        self._fetch.confirm()

    def resume_fetch(self, session_id: int) -> None:
        """Go on with the fetch that was stopped. Raises InputError."""
        self._require_motion(session_id)
        self._fetch.resume(self._station.targets.known(), session_id)

    def follow_up(self, verb: Verb, session_id: int) -> None:
        """Do something with the thing that is held. Raises InputError."""
        self._require_motion(session_id)
        self._fetch.follow_up(verb, session_id)

    async def guess_on_floor(self, tap: Tap) -> None:
        """Show where the tapped place is if it is on the floor. Raises FrameError, PoseError, InputError."""
        self._require_tap(tap)
        self._show_target(await floor_guess(self._context, tap, self._station.targets.new_id()))

    def target_cleared(self, target_id: int) -> None:
        """A task that still looks for this target has no more purpose."""
        if target_id == self._located_target_id:
            self.cancel("the target was forgotten")

    async def open_guide(self, kind: str, session_id: int) -> None:
        """Begin a guide, in the place of one that is open."""
        await self.end_guide()
        target_id = self._station.targets.new_id()
        self._guide_owner_id = session_id
        self._guide = Guide(
            self._context, self._runner, GuideKind(kind), session_id, target_id, self._tell_guide
        )
        await self._guide.start()

    def guide_of(self, session_id: int) -> Guide:
        """Return the guide that this session has open. Raises InputError."""
        if self._guide is None or self._guide_owner_id != session_id:
            raise InputError("no guide is open: start one first")
        return self._guide

    async def end_guide(self) -> None:
        """Leave the guide, if one is open."""
        guide, self._guide, self._guide_owner_id = self._guide, None, None
        if guide is not None:
            await guide.end()

    def operator_changed(self) -> None:
        """Guides belong to whoever drives."""
        if self._guide is not None:
            self._in_background(self.end_guide())

    def _require_motion(self, session_id: int) -> None:
        reason = refusal(self._station.authority.circumstances_of(session_id))
        if reason:
            raise InputError(reason)

    def _require_tap(self, tap: Tap) -> None:
        frame = self._station.frames.get(tap.frame_id)
        place = require_inside(Pixel(tap.u, tap.v), frame.size)
        if tap.box is not None and not tap.box.within(frame.size).holds(place):
            raise InputError(f"the tap ({tap.u:.1f}, {tap.v:.1f}) lies outside its own box; give its middle")

    async def _next_frame(self, frame_id: int) -> Frame:
        clock = self._station.clock
        arriving = asyncio.ensure_future(self._station.feed.frame_newer_than(frame_id))
        silence = asyncio.ensure_future(clock.sleep_until(clock.now_ns() + CAMERA_SILENCE_NS))
        try:
            await asyncio.wait({arriving, silence}, return_when=asyncio.FIRST_COMPLETED)
            if arriving.done():
                return arriving.result()
            raise LinkLost("the camera has sent no picture for 2 s")
        finally:
            arriving.cancel()
            silence.cancel()

    def _show_target(self, target: Target) -> None:
        self._station.targets.show(target, self._station.base_pose())

    def _tell_progress(self, progress: TaskProgress) -> None:
        view = TaskView(
            task_id=progress.task_id,
            kind=progress.kind,
            state=progress.state.value,
            phase=progress.phase,
            progress=progress.progress,
            message=progress.message,
        )
        self._station.hub.tell("task", view)
        self._fetch.task_changed(progress)
        self.lessons.task_changed(progress)

    def _tell_guide(self, state: GuideState) -> None:
        self._station.hub.tell("guide", GuideView(**asdict(state)))

    def _in_background(self, coroutine: Coroutine[Any, Any, None]) -> None:
        task = asyncio.create_task(coroutine)
        self._background.add(task)
        task.add_done_callback(self._background.discard)


def _report_nowhere(_: TaskReport) -> None:
    """The runner puts its own in the place of this."""
