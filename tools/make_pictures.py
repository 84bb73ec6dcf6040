"""Make the pictures of the README anew: a real `tapreach run`, a real browser, one tap on the red can.

    .venv/bin/python tools/make_pictures.py

Writes docs/pictures/page.png, phone.png and tap.webp. Takes a minute; needs the dev extra and Chromium.
"""

import io
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, sync_playwright

ROOT = Path(__file__).resolve().parents[1]
PICTURES = ROOT / "docs" / "pictures"
CHROMIUM = os.environ.get("TAPREACH_CHROMIUM") or shutil.which("chromium") or "/usr/bin/chromium"
ARGUMENTS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking"]
TABLET = {"width": 1180, "height": 820}
PHONE = {"width": 390, "height": 844}
RED_CAN = (234.0, 205.0)
ANIMATION_WIDTH = 720
LONGEST_S = 60.0
PERIOD_S = 0.25


def open_page(browser: object, address: str, viewport: dict[str, int]) -> Page:
    """Open the operator page without its first hints and wait until it may drive."""
    context = browser.new_context(viewport=viewport, device_scale_factor=1)  # type: ignore[attr-defined]
    page: Page = context.new_page()
    page.add_init_script("localStorage.setItem('tapreach.hints', '3')")
    page.goto(address)
    page.wait_for_selector("body:not(.cannot-drive)", timeout=30_000)
    page.wait_for_timeout(1500)
    return page


def tap(page: Page, u: float, v: float) -> None:
    """Tap a pixel of a 640 x 480 picture."""
    box = page.locator("#picture").bounding_box()
    assert box is not None
    scale = min(box["width"] / 640, box["height"] / 480)
    left = box["x"] + (box["width"] - 640 * scale) / 2
    top = box["y"] + (box["height"] - 480 * scale) / 2
    page.mouse.click(left + (u + 0.5) * scale, top + (v + 0.5) * scale)


def film_locate(page: Page) -> list[Image.Image]:
    """Tap the red can and return a picture every quarter of a second until the robot has located it."""
    shots = [shoot(page)]
    tap(page, *RED_CAN)
    page.locator("#task").wait_for(state="visible")
    began = time.monotonic()
    while page.locator("#task").is_visible() and time.monotonic() < began + LONGEST_S:
        shots.append(shoot(page))
        page.wait_for_timeout(1000 * PERIOD_S)
    page.wait_for_timeout(600)
    return [*shots, shoot(page)]


def shoot(page: Page) -> Image.Image:
    """Take a picture of the page."""
    return Image.open(io.BytesIO(page.screenshot())).convert("RGB")


def save_animation(shots: list[Image.Image], path: Path) -> None:
    """Save the film, smaller, its last picture for three seconds."""
    height = round(shots[0].height * ANIMATION_WIDTH / shots[0].width)
    frames = [shot.resize((ANIMATION_WIDTH, height), Image.Resampling.LANCZOS) for shot in shots]
    durations = [round(1000 * PERIOD_S)] * (len(frames) - 1) + [3000]
    frames[0].save(
        path, save_all=True, append_images=frames[1:], duration=durations, loop=0, quality=60, method=6
    )


def main() -> None:
    """Start the robot, make the pictures, stop it."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    command = [str(Path(sys.executable).with_name("tapreach")), "run", "--port", "0"]
    with (
        tempfile.TemporaryDirectory() as captures,
        subprocess.Popen([*command, "--captures", captures], stdout=subprocess.PIPE, text=True) as process,
        sync_playwright() as playwright,
    ):
        assert process.stdout is not None
        address = next(found.group() for line in process.stdout if (found := re.search(r"http://\S+", line)))
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        page = open_page(browser, address, TABLET)
        shots = film_locate(page)
        shots[-1].save(PICTURES / "page.png", optimize=True)
        save_animation(shots, PICTURES / "tap.webp")
        page.context.close()
        shoot(open_page(browser, address, PHONE)).save(PICTURES / "phone.png", optimize=True)
        browser.close()
        process.send_signal(signal.SIGINT)
    for path in sorted(PICTURES.iterdir()):
        print(f"{path.name}: {path.stat().st_size / 1024:.0f} kB")


if __name__ == "__main__":
    main()
