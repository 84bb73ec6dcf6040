"""The compiled firmware and its rover in real time, as `tapreach run` meets them: device path and camera."""

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from tests.firmware.sim.bridge import Bridge, Pty
from tests.firmware.sim.mujoco_plant import MujocoPlant
from tests.firmware.sim.servo_horns import ServoHorns
from tests.firmware.sim.started import started_rover
from tests.firmware.sim.whole_robot import described

from tapreach.drivers.sim.camera import encode_jpeg
from tapreach.drivers.sim.renderer import Renderer
from tapreach.drivers.sim.scene import load_scene
from tapreach.drivers.sim.world import World
from tapreach.resources import resource_path

RATE_HZ = 10.0
BOUNDARY = b"\r\n--picture\r\nContent-Type: image/jpeg\r\nContent-Length: %d\r\n\r\n"
LINK = 'driver = "arduino"\n\n[link]\naddress = "{device}"\n'
DELAY_MS = 15.0
CAMERA = f'[camera]\nsource = "{{pictures}}"\ndelay_ms = {DELAY_MS}\n'
SERVO = "\n[arm.servos.{name}]\n{keys}\n"


class Camera(threading.Thread):
    """Draws what the rover sees and serves it as mjpg-streamer does."""

    def __init__(
        self, bridge: Bridge, plant: MujocoPlant, horns: ServoHorns, width: int, height: int
    ) -> None:
        super().__init__(daemon=True)
        self._bridge, self._plant, self._horns = bridge, plant, horns
        self._size = width, height
        self._newest = b""
        self._has_new = threading.Condition()
        self._ending = threading.Event()
        self.server = ThreadingHTTPServer(("127.0.0.1", 0), self._handler())
        self.server.daemon_threads = True
        self.url = f"http://127.0.0.1:{self.server.server_port}/?action=stream"
        self._serving = threading.Thread(target=self.server.serve_forever, daemon=True)

    def run(self) -> None:
        self._serving.start()
        renderer = Renderer(self._plant.world.model, *self._size)
        renderer.shadows = False  # they cost as much as all the rest
        due = time.monotonic()
        while not self._ending.is_set():
            with self._bridge.lock:
                self._horns.follow()
                seen = self._plant.world.snapshot()
            began_s = time.monotonic()
            jpeg = encode_jpeg(renderer.render(seen), 85)
            self._was_late(time.monotonic() - began_s - DELAY_MS / 1000.0)
            with self._has_new:
                self._newest = jpeg
                self._has_new.notify_all()
            due = max(due + 1 / RATE_HZ, time.monotonic())
            self._ending.wait(due - time.monotonic())
        renderer.close()

    def _was_late(self, lag_s: float) -> None:
        """A picture that the machine draws much later than it says is as bad as a board that falls behind."""
        with self._bridge.lock:
            self._bridge.worst_lag_s = max(self._bridge.worst_lag_s, lag_s)

    def end(self) -> None:
        self._ending.set()
        self.server.shutdown()
        self.server.server_close()
        self.join(5.0)

    def _handler(self) -> type[BaseHTTPRequestHandler]:
        camera = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                self.send_response(200)
                self.send_header("Content-Type", "multipart/x-mixed-replace;boundary=picture")
                self.end_headers()
                while not camera._ending.is_set():
                    with camera._has_new:
                        camera._has_new.wait(1.0)
                        jpeg = camera._newest
                    try:
                        self.wfile.write(BOUNDARY % len(jpeg) + jpeg)
                    except OSError:
                        return

            def log_message(self, *_: object) -> None:
                return

        return Handler


def robot_file(folder: Path, device: str, pictures: str) -> Path:
    """Write the robot file that names both."""
    text, _, _ = (resource_path("robots") / "sim.toml").read_text().partition("[simulation]")
    text = text.replace('driver = "sim"\n', LINK.format(device=device))
    text = text.replace("[camera]\n", CAMERA.format(pictures=pictures))
    text = text.replace("timing_sigma_ms = 0.5", "timing_sigma_ms = 20.0")
    servos = described().arm.servos
    for name in type(servos).model_fields:
        values = getattr(servos, name).model_dump()
        keys = "\n".join(f"{key} = {str(value).lower()}" for key, value in values.items())
        text += SERVO.format(name=name, keys=keys)
    path = folder / "live.toml"
    path.write_text(text)
    return path


@contextmanager
def live_robot(scene: str, folder: Path, board: str = "uno") -> Iterator[tuple[Path, Bridge, World]]:
    """Run it; yield its robot file, the bridge, whose lock must be held to look at it, and the world."""
    description = described()
    plant = MujocoPlant(load_scene(scene), description)
    rover = started_rover(board, plant)
    bridge = Bridge(rover, Pty())
    horns = ServoHorns(rover, plant, description.arm)
    camera = Camera(bridge, plant, horns, description.camera.width, description.camera.height)
    with bridge:
        camera.start()
        try:
            yield robot_file(folder, bridge.url, camera.url), bridge, plant.world
        finally:
            camera.end()
    rover.close()
