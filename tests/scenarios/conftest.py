"""The whole product: `tapreach run` with the simulated rover, and a real browser on its page."""

import json
import math
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from playwright.sync_api import Browser, Page, expect, sync_playwright
from tests.scenarios.running import tapreach_run
from websockets.sync.client import connect

from tapreach.cli.robot_file import find_robot_file
from tapreach.drivers.sim.scene import load_scene
from tapreach.geometry.camera import Camera
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import load_robot

CHROMIUM = os.environ.get("TAPREACH_CHROMIUM") or shutil.which("chromium") or "/usr/bin/chromium"
ARGUMENTS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking"]
MINUS = "\N{MINUS SIGN}"
TABLET = {"width": 1024, "height": 768}


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield chromium
        chromium.close()


class Operator:
    """A person at the page, who knows where things stand in the room when the robot starts."""

    def __init__(self, page: Page, address: str, scene: str) -> None:
        self.page = page
        self._socket_address = address.replace("http", "ws") + "ws/control"
        self._objects = {thing.name: thing for thing in load_scene(scene).objects}
        description = load_robot(find_robot_file("sim"))
        self._camera: Camera = description.camera.model()
        self._base_from_camera = description.camera.mount.base_from_camera()

    def middle_of(self, name: str) -> NDArray[np.float64]:
        """Where the middle of a thing is, world frame [m]."""
        thing = self._objects[name]
        return np.array([*thing.position, thing.up + thing.tall / 2])

    def radius_of(self, name: str) -> float:
        """Half the width of a thing [m]."""
        return self._objects[name].width / 2

    def tall(self, name: str) -> float:
        """Height of a thing [m]."""
        return self._objects[name].tall

    def tap(self, name: str) -> None:
        """Tap the middle of a thing, as it is seen from where the wheels say that the robot is."""
        world_from_camera = self.pose().to_rigid() * self._base_from_camera
        in_camera = world_from_camera.inv().apply(self.middle_of(name))
        (u, v) = self._camera.project(in_camera[None]).pixels[0]
        self.tap_pixel(float(u), float(v))

    def draw_around(self, name: str) -> None:
        """Draw a box around a thing that stands upright, as it is seen from where the wheels say."""
        thing, radius = self._objects[name], self.radius_of(name)
        ring = [(radius * math.cos(a), radius * math.sin(a)) for a in np.linspace(0.0, 2.0 * math.pi, 60)]
        x, y = thing.position
        rims = np.array([(x + dx, y + dy, thing.up + z) for dx, dy in ring for z in (0.0, thing.tall)])
        world_from_camera = self.pose().to_rigid() * self._base_from_camera
        pixels = self._camera.project(world_from_camera.inv().apply(rims)).pixels
        self.page.mouse.move(*self._spot(*map(float, pixels.min(axis=0))))
        self.page.mouse.down()
        self.page.mouse.move(*self._spot(*map(float, pixels.max(axis=0))), steps=5)
        self.page.mouse.up()

    def tap_pixel(self, u: float, v: float) -> None:
        """Tap a pixel of the picture."""
        self.page.mouse.click(*self._spot(u, v))

    def _spot(self, u: float, v: float) -> tuple[float, float]:
        """Where a pixel of the picture is on the screen."""
        x, y = self.page.evaluate(
            """([u, v, width, height]) => {
                const box = document.getElementById('picture').getBoundingClientRect();
                const scale = Math.min(box.width / width, box.height / height);
                return [box.left + (box.width - width * scale) / 2 + (u + 0.5) * scale,
                        box.top + (box.height - height * scale) / 2 + (v + 0.5) * scale];
            }""",
            [u, v, self._camera.size.width, self._camera.size.height],
        )
        return float(x), float(y)

    def read_position(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Read X, Y, Z and their 95 % half widths from the target card, base frame [m]."""
        texts = self.page.locator("#card-xyz dd").all_inner_texts()
        numbers = [float(text.replace("cm", "").replace("±", "").replace(MINUS, "-")) / 100 for text in texts]
        return np.array(numbers[0::2]), np.array(numbers[1::2])

    def odometry(self) -> str:
        """What the page says of the wheels."""
        return self.page.locator("#odometry").inner_text()

    def pose(self) -> PlanarPose:
        """Where the wheels say that the robot is: asked as somebody who watches."""
        with connect(self._socket_address) as socket:
            socket.send(json.dumps({"type": "hello", "seq": 1, "name": "watcher"}))
            while True:
                message = json.loads(socket.recv(timeout=30))
                if message["type"] == "state" and message["odometry"]:
                    told = message["odometry"]
                    return PlanarPose(told["x"], told["y"], math.radians(told["heading_deg"]))

    def error(self, name: str) -> float:
        """Distance of the position on the target card from the middle of a thing [m]."""
        position, _ = self.read_position()
        in_world = self.pose().to_rigid().apply(position)
        return float(np.linalg.norm(in_world - self.middle_of(name)))

    def wait_for_task(self) -> None:
        """Wait until no task runs any more."""
        expect(self.page.locator("#task")).to_be_hidden(timeout=90_000)
        expect(self.page.locator("#motion")).to_have_text("Still")


@contextmanager
def operating(browser: Browser, address: str, scene: str) -> Iterator[Operator]:
    """Somebody who has just opened the page of a robot in a shipped scene and holds the lease."""
    troubles: list[str] = []
    context = browser.new_context(viewport=TABLET, reduced_motion="reduce")  # type: ignore[arg-type]
    page = context.new_page()
    page.set_default_timeout(60_000)
    page.on("pageerror", lambda error: troubles.append(str(error)))
    page.add_init_script("localStorage.setItem('tapreach.hints', '3')")
    page.goto(address)
    page.wait_for_selector("body:not(.cannot-drive)")
    expect(page.locator("#lease-who")).to_have_text("You")
    yield Operator(page, address, scene)
    context.close()
    assert troubles == []


@pytest.fixture
def operator(browser: Browser, tmp_path: Path) -> Iterator[Operator]:
    """Somebody at the page of a robot in the room `room`."""
    with tapreach_run(tmp_path, "--scene", "room") as run, operating(browser, run.address, "room") as person:
        yield person
