"""Physics in real time, beside the drawing: commands in, telemetry out, a short history for the camera."""

import select
import socket
import threading
from collections import deque

from tapreach.drivers.sim.camera import HISTORY, Snapshot, state_at
from tapreach.drivers.sim.protocol import (
    MAX_PACKET,
    AskTruth,
    Drive,
    MoveArm,
    Telemetry,
    TruthReply,
    decode,
    encode,
)
from tapreach.drivers.sim.truth import TruthTeller
from tapreach.drivers.sim.world import World
from tapreach.errors import DriverError
from tapreach.robot.clock import MS, SECOND, Clock
from tapreach.robot.messages import ArmPose, Twist

TELEMETRY_EVERY = 2
LATE_NS = 100 * MS
TRUTH_HISTORY = 1000


class PhysicsLoop:
    """Steps the world every 10 ms in its own thread. After a stall the time lost is not caught up."""

    def __init__(
        self, world: World, control: socket.socket, clock: Clock, teller: TruthTeller | None
    ) -> None:
        self._world = world
        self._control = control
        self._clock = clock
        self._teller = teller
        self._period_ns = round(world.period_s * SECOND)
        self._lock = threading.Lock()
        first = Snapshot(clock.now_ns(), world.snapshot())
        self._history: deque[Snapshot] = deque([first], maxlen=TRUTH_HISTORY if teller else HISTORY)
        self._thread = threading.Thread(target=self._run, name="physics")
        self.ended = threading.Event()
        self.failure: Exception | None = None

    def start(self) -> None:
        """Begin to step."""
        self._control.setblocking(False)
        self._thread.start()

    def stop(self) -> None:
        """End the thread and wait for it."""
        self.ended.set()
        if self._thread.is_alive():
            self._thread.join()

    def history(self) -> list[Snapshot]:
        """Return the last states, oldest first; at least one."""
        with self._lock:
            return list(self._history)[-HISTORY:]

    def _run(self) -> None:
        try:
            self._step_until_ended()
        except Exception as error:
            self.failure = error
        finally:
            self.ended.set()

    def _step_until_ended(self) -> None:
        captured_ns = self._clock.now_ns()
        count = 0
        while not self.ended.is_set():
            if self._clock.now_ns() - captured_ns > LATE_NS:
                captured_ns = self._clock.now_ns()
            captured_ns += self._period_ns
            self._serve_until(captured_ns)
            self._world.step()
            with self._lock:
                self._history.append(Snapshot(captured_ns, self._world.snapshot()))
            count += 1
            if count % TELEMETRY_EVERY == 0:
                self._send(encode(telemetry_of(self._world, captured_ns)))
            if self._world.warnings:
                raise DriverError("; ".join(self._world.warnings) + ": the simulation must be started anew")

    def _serve_until(self, when_ns: int) -> None:
        """Take commands as they come until the next step is due."""
        while not self.ended.is_set():
            left_ns = when_ns - self._clock.now_ns()
            readable, _, _ = select.select([self._control], [], [], max(0.0, left_ns / SECOND))
            if not readable:
                if left_ns <= 0:
                    return
                continue
            self._receive()

    def _receive(self) -> None:
        try:
            packet = self._control.recv(MAX_PACKET)
        except BlockingIOError:
            return
        except OSError:
            packet = b""
        if not packet:
            self.ended.set()
            return
        message = decode(packet)
        if isinstance(message, Drive):
            self._world.drive(Twist(message.linear, message.angular))
        elif isinstance(message, MoveArm):
            target = ArmPose(message.rotation, message.shoulder, message.elbow, message.claw)
            self._world.move_arm(target)
        elif isinstance(message, AskTruth) and self._teller:
            self._send(encode(TruthReply(self._truth(self._teller, message.at_ns))))

    def _truth(self, teller: TruthTeller, at_ns: int) -> str:
        history = list(self._history)
        when_ns = at_ns or history[-1].captured_ns
        return teller.tell(state_at(history, when_ns), when_ns).to_json()

    def _send(self, packet: bytes) -> None:
        try:
            self._control.send(packet)
        except BlockingIOError:
            pass  # a slow host misses telemetry; physics does not wait
        except OSError:
            self.ended.set()


def telemetry_of(world: World, captured_ns: int) -> Telemetry:
    """Return the board's state as the message that carries it."""
    state = world.board_state()
    now, target = state.arm, state.arm_target
    return Telemetry(
        captured_ns, *state.ticks,
        now.rotation, now.shoulder, now.elbow, now.claw,
        target.rotation, target.shoulder, target.elbow, target.claw,
        state.arm_is_moving, state.needs_zero,
    )  # fmt: skip
