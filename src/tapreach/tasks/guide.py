"""The guided procedures with everything they touch: frames, poses, the robot's own moves, the estimator.

The order of the steps and what each allows is in guide_progress, which is pure; this file brings taps and
odometry to it and shows the outcome.
"""

import math
from collections.abc import Callable
from math import degrees

from tapreach.errors import InputError
from tapreach.geometry.pixel import Pixel, require_inside
from tapreach.geometry.planar_motion import PlanarPose, wrapped
from tapreach.robot.interface import Unsubscribe
from tapreach.robot.messages import Odometry
from tapreach.tasks.frame_pose import pose_at
from tapreach.tasks.guide_moves import GuideMove, advance_move, in_words, pose_move, turn_move
from tapreach.tasks.guide_progress import GuideProgress, in_degrees
from tapreach.tasks.guide_result import GuideResult, result_of
from tapreach.tasks.guide_state import CLOSED, GuideKind, GuideState
from tapreach.tasks.guide_steps import ADVANCE, CHECK_TURN, TABLES, TURN
from tapreach.tasks.runner import TaskRunner
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.task import Tap, TaskContext

TAP_SIGMA = 1.0
"""How well a person finds the same spot of a target again [px]."""
CENTRED = math.radians(0.5)
CORRECT = "Tap the spot once more to correct the last tap."


class Guide:
    """One run of a guided procedure for the session `owner`.

    runner: carries out what the robot is asked to do. target_id: under which the result is shown.
    on_change: called with the state after every change, also when the odometry's reading changes by what a
    person can see.
    """

    def __init__(
        self,
        context: TaskContext,
        runner: TaskRunner,
        kind: GuideKind,
        owner: int,
        target_id: int,
        on_change: Callable[[GuideState], None],
    ) -> None:
        self._context = context
        self._runner = runner
        self._kind = kind
        self._owner = owner
        self._target_id = target_id
        self._on_change = on_change
        self._progress = GuideProgress(TABLES[kind])
        self._result = GuideResult("")
        self._here: PlanarPose | None = None
        self._unsubscribe: Unsubscribe | None = None
        self._told = CLOSED

    @property
    def state(self) -> GuideState:
        """What the page shows now; closed before `start` and after `end`."""
        return self._state() if self._unsubscribe is not None else CLOSED

    async def start(self) -> None:
        """Open the guide at its first step."""
        if self._unsubscribe is None:
            self._unsubscribe = self._context.robot.base.subscribe(self._hear)
        self._tell()

    async def tap(self, tap: Tap) -> None:
        """Take a tap for the present step. Raises FrameError, PoseError, InputError."""
        frame = self._context.frames.get(tap.frame_id)
        pixel = require_inside(Pixel(tap.u, tap.v), frame.size)
        pose = await pose_at(self._context, frame.captured_ns)
        sighting = Sighting(frame.frame_id, frame.captured_ns, pixel, TAP_SIGMA, 1.0, pose)
        self._progress = self._progress.tapped(sighting)
        await self._renew()

    async def value(self, name: str, value: float | None) -> None:
        """Type a value over what odometry read, or take it back with None. Raises InputError."""
        self._progress = self._progress.with_value(name, value)
        await self._renew()

    async def act(self, act: str) -> None:
        """Do what the present step offers: 'pose', 'centre', 'turn', 'advance' by the robot; 'next', 'back'.

        Raises InputError for what it does not offer, and while another task runs.
        """
        self._progress.require(act)
        if act in ("next", "back"):
            self._progress = self._progress.acted(act)
            await self._renew()
        else:
            self._runner.start(self._move(act), self._owner)

    async def end(self) -> None:
        """Leave the guide; what the robot is doing for it is stopped."""
        if self._unsubscribe is None:
            return
        self._unsubscribe()
        self._unsubscribe = None
        if self._runner.progress is not None and self._runner.progress.kind == "guide":
            self._runner.cancel("the guide was left")
        self._tell()

    def _move(self, act: str) -> GuideMove:
        theta = self._progress.theta(self._here) or 0.0
        if act == "pose":
            return pose_move(self._context)
        if act == "centre":
            return turn_move(self._to_centre())
        if act == "turn":
            wanted = TURN if self._kind is GuideKind.TWO_TAP else CHECK_TURN
            return turn_move(wanted - theta)
        return advance_move(ADVANCE - (self._progress.distance(self._here) or 0.0))

    def _to_centre(self) -> float:
        """Return the turn [rad, left] that still brings the roughly tapped target to the centre line."""
        rough = self._progress.rough
        if rough is None:
            raise InputError("tap the target first, so that the robot knows what to centre")
        camera = self._context.description.camera.model()
        ((x, _),) = camera.normalise([rough.pixel.to_array()])
        here = self._here if self._here is not None else rough.world_from_base
        return -math.atan(float(x)) - wrapped(here.heading - rough.world_from_base.heading)

    async def _renew(self) -> None:
        self._result = await result_of(self._context, self._kind, self._progress, self._target_id)
        if self._result.target is not None:
            self._context.show_target(self._result.target)
        self._tell()

    def _hear(self, reading: Odometry) -> None:
        self._here = reading.world_from_base
        if self._looks_different(self._state()):
            self._tell()

    def _looks_different(self, state: GuideState) -> bool:
        return _readable(state) != _readable(self._told)

    def _tell(self) -> None:
        self._told = self.state
        self._on_change(self._told)

    def _state(self) -> GuideState:
        progress, step = self._progress, self._progress.step
        is_finished = bool(self._result.text) and progress.number + 1 == len(progress.table)
        return GuideState(
            kind=self._kind,
            step=progress.number + 1,
            steps=len(progress.table),
            title="Result" if is_finished else step.title,
            instruction=CORRECT if is_finished else step.instruction,
            hint=self._hint(),
            acts=progress.acts,
            wants_tap=step.wants_tap,
            theta_deg=in_degrees(progress.theta(self._here)),
            distance=progress.distance(self._here) if self._kind is GuideKind.TWO_TAP else None,
            values_typed=tuple("theta_deg" if name == "theta" else name for name in progress.typed),
            result=self._result.text,
        )

    def _hint(self) -> str:
        """Return the help for the present step, by odometry."""
        key, progress = self._progress.step.key, self._progress
        if key == "centre" and progress.rough is not None:
            left = self._to_centre()
            return "it stands on the centre line: go on" if abs(left) < CENTRED else f"turn {in_words(left)}"
        if key == "turn":
            wanted = TURN if self._kind is GuideKind.TWO_TAP else CHECK_TURN
            return f"turned {in_words(progress.theta(self._here) or 0.0)} of {degrees(wanted):.0f}° left"
        if key == "advance":
            driven = progress.distance(self._here) or 0.0
            return f"driven {100.0 * driven:.1f} of {100.0 * ADVANCE:.0f} cm"
        return ""


def _readable(state: GuideState) -> tuple[object, ...]:
    """Return what a person can see of a state, so that the odometry's last digits do not fill the socket."""
    theta = None if state.theta_deg is None else round(state.theta_deg, 1)
    distance = None if state.distance is None else round(state.distance, 3)
    return state.step, state.hint, theta, distance
