"""The host's side of the simulated robot: starts the simulator's process and speaks with it."""

import asyncio
import socket
import subprocess
import sys

from tapreach import errors
from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.host_parts import HostArm, HostBase, HostCamera
from tapreach.drivers.sim.protocol import (
    MAX_PACKET,
    AskTruth,
    Failed,
    FrameParser,
    Message,
    Ready,
    Setup,
    Telemetry,
    TruthReply,
    decode,
    encode,
)
from tapreach.drivers.sim.scene import Scene
from tapreach.robot.clock import Clock
from tapreach.robot.config import RobotDescription
from tapreach.robot.driver_robot import DriverRobot
from tapreach.robot.messages import Health, LinkStatus

START_TIMEOUT_S = 30.0
END_TIMEOUT_S = 2.0
_LOST = "the connection to the simulated robot is lost"


class SimRobot(DriverRobot):
    """A Robot whose body is a process of its own; it stops its wheels when the host falls silent."""

    def __init__(
        self,
        description: RobotDescription,
        scene: Scene,
        clock: Clock,
        faults: SimFaults | None = None,
        seed: int = 0,
        opengl: str = "auto",
        tells_truth: bool = False,
    ) -> None:
        super().__init__(description, "the simulated robot has not been started")
        chosen = faults if faults is not None else scene.faults
        self._setup = Setup(
            scene.model_dump_json(exclude_unset=True), description.model_dump_json(),
            chosen.model_dump_json(), seed, opengl, tells_truth,
        )  # fmt: skip
        self.base = HostBase(description.base, self._send)
        self.arm = HostArm(description.arm, self._send)
        self.frames = HostCamera(description.camera, clock)
        self._process: subprocess.Popen[bytes] | None = None
        self._control: socket.socket | None = None
        self._frames: socket.socket | None = None
        self._parser = FrameParser()
        self._started: asyncio.Future[None] | None = None
        self._truths: list[asyncio.Future[str]] = []

    @property
    def process_id(self) -> int | None:
        """Id of the simulator's process; None before it started."""
        return self._process.pid if self._process else None

    async def connect(self) -> None:
        """Start the process and return when it runs.

        Raises SetupError when nothing can draw, ConfigError for what it cannot simulate, or DriverError.
        """
        loop = asyncio.get_running_loop()
        self._started = loop.create_future()
        self._control, child_control = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._frames, child_frames = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
        with child_control, child_frames:
            self._process = _spawn(child_control.fileno(), child_frames.fileno())
        for ours in (self._control, self._frames):
            ours.setblocking(False)
        loop.add_reader(self._control.fileno(), self._read_control)
        loop.add_reader(self._frames.fileno(), self._read_frames)
        self._send(self._setup)
        try:
            await asyncio.wait_for(asyncio.shield(self._started), START_TIMEOUT_S)
        except TimeoutError:
            await self.close()
            raise errors.DriverError(f"the simulator did not start within {START_TIMEOUT_S:.0f} s") from None
        except BaseException:  # also a cancelled start leaves no process behind
            await self.close()
            raise

    async def close(self) -> None:
        """Let the process go; closing its sockets stops and ends it."""
        self._disconnect()
        process, self._process = self._process, None
        if process is not None:
            try:
                await asyncio.to_thread(process.wait, END_TIMEOUT_S)
            except subprocess.TimeoutExpired:
                process.kill()
                await asyncio.to_thread(process.wait)
        if self._health.status is LinkStatus.RUNNING:
            self._set_health(Health(LinkStatus.LOST, "the simulated robot was switched off"))

    async def ask_truth_json(self, at_ns: int) -> str:
        """Return the truth as JSON; call truth.ask_truth instead, from tests and benches only."""
        if not self._setup.tells_truth:
            raise errors.InputError("this SimRobot was not made with tells_truth=True")
        answer: asyncio.Future[str] = asyncio.get_running_loop().create_future()
        self._truths.append(answer)
        self._send(AskTruth(at_ns))
        return await answer

    def _send(self, message: Message) -> None:
        if self._control is None:
            raise errors.LinkLost(self._health.reason or _LOST)
        try:
            self._control.send(encode(message))
        except BlockingIOError:
            raise errors.LinkLost("the simulated robot no longer takes commands") from None
        except OSError:
            self._lose(_LOST)
            raise errors.LinkLost(self._health.reason) from None

    def _read_control(self) -> None:
        while self._control is not None:
            try:
                packet = self._control.recv(MAX_PACKET)
            except BlockingIOError:
                return
            except OSError:
                packet = b""
            if not packet:
                self._lose(self._ending())
                return
            try:
                self._take(decode(packet))
            except errors.DriverError as error:
                self._lose(str(error))
                return

    def _take(self, message: Message) -> None:
        if isinstance(message, Telemetry):
            self.base.take(message)
            self.arm.take(message)
        elif isinstance(message, Ready) and self._started and not self._started.done():
            self._set_health(Health(LinkStatus.RUNNING))
            self._started.set_result(None)
        elif isinstance(message, Failed):
            self._lose(message.reason, message.kind)
        elif isinstance(message, TruthReply) and self._truths:
            self._truths.pop(0).set_result(message.truth)

    def _read_frames(self) -> None:
        try:
            data = self._frames.recv(1 << 20) if self._frames else b""
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if not data:
            if self._frames:
                asyncio.get_running_loop().remove_reader(self._frames.fileno())
            return
        try:
            newest = self._parser.feed(data)[-1:]
        except errors.DriverError as error:
            self._lose(str(error))
            return
        for captured_ns, jpeg in newest:
            self.frames.take(captured_ns, jpeg)

    def _lose(self, reason: str, kind: str = "LinkLost") -> None:
        self._disconnect()
        self._set_health(Health(LinkStatus.LOST, reason))
        failure = {"SetupError": errors.SetupError, "ConfigError": errors.ConfigError}.get(
            kind, errors.LinkLost
        )
        if self._started and not self._started.done():
            self._started.set_exception(failure(reason))
        for answer in self._truths:
            answer.set_exception(errors.LinkLost(reason))
        self._truths.clear()

    def _ending(self) -> str:
        code = self._process.poll() if self._process else None
        how = f" (exit code {code})" if code else ""
        return f"the simulator has ended{how}; start it again with `tapreach run`"

    def _disconnect(self) -> None:
        for ours in (self._control, self._frames):
            if ours is not None:
                asyncio.get_running_loop().remove_reader(ours.fileno())
                ours.close()
        self._control = self._frames = None


def _spawn(control_fd: int, frames_fd: int) -> "subprocess.Popen[bytes]":
    command = [sys.executable, "-m", "tapreach.drivers.sim.child", str(control_fd), str(frames_fd)]
    return subprocess.Popen(command, pass_fds=(control_fd, frames_fd), stdin=subprocess.DEVNULL)
