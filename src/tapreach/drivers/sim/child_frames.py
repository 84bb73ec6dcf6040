"""Pictures at the camera's rate; when the host is slow the newest wins and nothing waits."""

import socket

from tapreach.drivers.sim.camera import ShadowPolicy, SimCamera
from tapreach.drivers.sim.child_physics import PhysicsLoop
from tapreach.drivers.sim.protocol import encode_frame
from tapreach.drivers.sim.renderer import Renderer
from tapreach.robot.clock import SECOND, Clock


class FrameSender:
    """Sends one picture at a time; while one is still on its way, others are not taken."""

    def __init__(self, frames: socket.socket) -> None:
        self._socket = frames
        self._socket.setblocking(False)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 20)
        self._left = memoryview(b"")

    def is_free(self) -> bool:
        """Push on and return whether all of it is gone. Raises ConnectionError when nobody reads."""
        while self._left:
            try:
                self._left = self._left[self._socket.send(self._left) :]
            except BlockingIOError:
                return False
        return True

    def send(self, packet: bytes) -> bool:
        """Begin to send and return True, or return False while the last one is on its way."""
        if not self.is_free():
            return False
        self._left = memoryview(packet)
        self.is_free()
        return True


class FrameLoop:
    """Draws, encodes and sends, at a fixed rate, skipping what is late."""

    def __init__(
        self,
        renderer: Renderer,
        camera: SimCamera,
        physics: PhysicsLoop,
        frames: socket.socket,
        clock: Clock,
        rate_hz: float,
    ) -> None:
        self._renderer, self._camera, self._physics = renderer, camera, physics
        self._sender = FrameSender(frames)
        self._clock = clock
        self._period_ns = round(SECOND / rate_hz)
        self._policy = ShadowPolicy(1.0 / rate_hz)

    def run(self) -> None:
        """Run until physics ends or the host is gone."""
        due_ns = self._clock.now_ns()
        while not self._physics.ended.wait(max(0.0, (due_ns - self._clock.now_ns()) / SECOND)):
            self._one_picture()
            due_ns = max(due_ns + self._period_ns, self._clock.now_ns())

    def _one_picture(self) -> None:
        if not self._sender.is_free():
            return
        began_ns = self._clock.now_ns()
        self._camera.take(self._physics.history())
        now_ns = self._clock.now_ns()
        self._renderer.shadows = self._policy.note((now_ns - began_ns) / SECOND)
        for picture in self._camera.delivered(now_ns):
            believed_ns = picture.captured_ns + self._camera.unknown_delay_ns
            self._sender.send(encode_frame(believed_ns, picture.leaves_ns, picture.jpeg))
