"""The control loop: 50 times a second one twist to the wheels, zeros too, whatever else happens."""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass

from tapreach.control.authority import Authority
from tapreach.control.gate import Decision, Gate, refusal
from tapreach.control.motion import Motion, Progress, Senses
from tapreach.control.pilot import MotionInterrupted
from tapreach.control.speed_limit import SpeedLimits
from tapreach.errors import LinkLost
from tapreach.robot.clock import MS, SECOND
from tapreach.robot.interface import Unsubscribe
from tapreach.robot.messages import STILL, ArmPose, ArmState, Odometry, Twist

PERIOD_NS = 20 * MS
ARM_REPORT_NS = 200 * MS
"""So long it may take until the arm's own reports show a new target."""
LONGEST_STEP = 3 * PERIOD_NS / SECOND
"""Ramps do not catch up on a stall: no step counts for more than this [s]."""


@dataclass(frozen=True, slots=True)
class Sent:
    """What really went to the wheels last, and why it was less than wished ('' when not)."""

    twist: Twist = STILL
    limited_by: str = ""


class ControlLoop:
    """Picks the task's motion or the operator's wish, lets the gate decide, and sends.

    `on_task_refused` is called once with the reason when a running task has lost its right to move.
    An exception in `run` must end the process: the robot's own deadman then stops the wheels.
    """

    def __init__(self, authority: Authority, on_task_refused: Callable[[str], None] = lambda _: None) -> None:
        self._authority = authority
        self._robot = authority.robot
        self._clock = authority.clock
        self._on_task_refused = on_task_refused
        self._gate = Gate(SpeedLimits.of(self._robot.description.base))
        self._decided_ns = self._clock.now_ns()
        self._senses = Senses()
        self._task_owner_id: int | None = None
        self._motion: tuple[Motion, asyncio.Future[Odometry]] | None = None
        self._arm_sent: ArmPose | None = None
        self._arm_sent_ns = 0
        self.sent = Sent()
        self.overruns = 0

    @property
    def senses(self) -> Senses:
        """The newest readings."""
        return self._senses

    async def run(self) -> None:
        """Act every 20 ms until cancelled; then send zero."""
        unsubscribes = self._listen()
        due_ns = self._clock.now_ns()
        try:
            while True:
                self.act()
                due_ns += PERIOD_NS
                if self._clock.now_ns() > due_ns:
                    self.overruns += 1
                    due_ns = self._clock.now_ns() + PERIOD_NS
                await self._clock.sleep_until(due_ns)
        finally:
            self.stop("the control loop has ended")
            for unsubscribe in unsubscribes:
                unsubscribe()

    def act(self) -> Twist:
        """Decide and send once; also called at once when a drive message arrives. Returns what was sent."""
        self._drop_task_without_right()
        now_ns = self._clock.now_ns()
        duration = min((now_ns - self._decided_ns) / SECOND, LONGEST_STEP)
        self._decided_ns = now_ns
        if self._motion is None:
            holder = self._authority.circumstances_of_holder()
            return self._send(self._gate.operator(self._authority.deadman.wish, holder, duration))
        motion, _ = self._motion
        wanted = motion.step(self._senses, now_ns)
        owner = self._authority.circumstances_of(self._task_owner_id)
        twist = self._watch() if wanted is None else self._send(self._gate.task(wanted, owner, duration))
        self._finish_motion(motion)
        return twist

    def stop(self, reason: str) -> Twist:
        """Zero now: the wish is dropped, a task loses its right to move. Returns what was sent."""
        self._authority.deadman.release()
        self.refuse_task(reason)
        return self._send(self._gate.stop())

    @property
    def arm_target(self) -> ArmPose | None:
        """Where the arm was sent last, also when it has not reported that yet; None while unknown."""
        if self._arm_sent is not None and self._clock.now_ns() - self._arm_sent_ns < ARM_REPORT_NS:
            return self._arm_sent
        return self._senses.arm.target if self._senses.arm is not None else None

    def move_arm(self, target: ArmPose) -> ArmPose:
        """Send the arm somewhere; the one door to it. Returns the target after limits. Raises LinkLost."""
        self._arm_sent, self._arm_sent_ns = self._robot.arm.move(target), self._clock.now_ns()
        return self._arm_sent

    def hold_arm(self) -> None:
        """Send the arm to where it is."""
        if self._senses.arm is not None:
            try:
                self.move_arm(self._senses.arm.pose)
            except LinkLost:
                return  # health says it; the arm holds by itself without a host

    def admit_task(self, owner_id: int) -> None:
        """Let a task of this session move the robot, as long as the session may."""
        self._task_owner_id = owner_id

    def dismiss_task(self) -> None:
        """The task has ended by itself."""
        self._end_motion("the task has ended")
        self._task_owner_id = None

    def refuse_task(self, reason: str) -> None:
        """End a running task's motion and tell; nothing when there is no task."""
        if self._task_owner_id is None:
            return
        self._task_owner_id = None
        self._end_motion(reason)
        self._on_task_refused(reason)

    async def carry_out(self, motion: Motion) -> Odometry:
        """Run a task's motion to its end; return the odometry at rest. Raises MotionInterrupted."""
        if self._task_owner_id is None:
            raise MotionInterrupted("no task may move the robot now")
        if self._motion is not None:
            raise MotionInterrupted("another motion is not finished")
        future: asyncio.Future[Odometry] = asyncio.get_running_loop().create_future()
        self._motion = (motion, future)
        try:
            return await future
        finally:
            if self._motion is not None and self._motion[1] is future:
                self._end_motion("cancelled")

    def _drop_task_without_right(self) -> None:
        if self._task_owner_id is not None:
            reason = refusal(self._authority.circumstances_of(self._task_owner_id))
            if reason:
                self.refuse_task(reason)

    def _end_motion(self, reason: str) -> None:
        if self._motion is None:
            return
        motion, future = self._motion
        self._motion = None
        self._send(self._gate.stop(reason))
        if motion.moves_arm:
            self.hold_arm()
        if not future.done():
            future.set_exception(MotionInterrupted(reason))

    def _finish_motion(self, motion: Motion) -> None:
        if self._motion is None or motion.progress is Progress.MOVING:
            return
        if motion.progress is Progress.GIVEN_UP or self._senses.odometry is None:
            self._end_motion(motion.reason or "there is no odometry")
            return
        _, future = self._motion
        self._motion = None
        if not future.done():
            future.set_result(self._senses.odometry)

    def _watch(self) -> Twist:
        # The robot moves by itself, by its task's right, asked for before. The next ramp starts at rest.
        self._gate.stop()
        reading = self._senses.odometry
        self.sent = Sent(reading.twist if reading is not None else STILL)
        return self.sent.twist

    def _send(self, decision: Decision) -> Twist:
        try:
            twist, reason = self._robot.base.drive(decision.twist), decision.reason
        except LinkLost as error:
            twist, reason = STILL, str(error)
        self.sent = Sent(twist, reason)
        return twist

    def _listen(self) -> tuple[Unsubscribe, ...]:
        def hear_odometry(reading: Odometry) -> None:
            self._senses = Senses(reading, self._senses.arm)

        def hear_arm(state: ArmState) -> None:
            self._senses = Senses(self._senses.odometry, state)

        return self._robot.base.subscribe(hear_odometry), self._robot.arm.subscribe(hear_arm)
