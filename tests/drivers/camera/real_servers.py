"""Servers of this system on loopback: ustreamer, and GStreamer's RTSP server. Debian packages, tests only."""

import os
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

SYSTEM_PYTHON = "/usr/bin/python3"
RTSP_SERVER = Path(__file__).with_name("rtsp_server.py")
PACKAGES = "apt install ustreamer gir1.2-gst-rtsp-server-1.0 python3-gi gstreamer1.0-plugins-good"


def miss(what: str) -> None:
    """Skip for want of a package; where everything is to be tested (CI), fail."""
    if os.environ.get("CI"):
        pytest.fail(f"{what} is not installed: {PACKAGES}")
    pytest.skip(f"{what} is not installed: {PACKAGES}")


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as server:
        return int(server.getsockname()[1])


@contextmanager
def process(*command: str) -> Iterator["subprocess.Popen[str]"]:
    """A process that ends with the test."""
    running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        yield running
    finally:
        running.kill()
        running.wait(10)
        assert running.stdout is not None
        running.stdout.close()


@contextmanager
def ustreamer(port: int) -> Iterator[None]:
    """Serve without a device: it shows its own picture, 640 x 480, once a second."""
    program = shutil.which("ustreamer")
    if program is None:
        miss("ustreamer")
    command = (str(program), "--host", "127.0.0.1", "--port", str(port), "--device", "/dev/video-none")
    with process(*command):
        end = time.monotonic() + 20
        while True:
            with suppress(OSError):
                socket.create_connection(("127.0.0.1", port), 1).close()
                break
            assert time.monotonic() < end, "ustreamer does not listen"
            time.sleep(0.02)
        yield


@contextmanager
def rtsp_server() -> Iterator[str]:
    """Serve /mjpeg and /vp8, 320 x 240 at 20 pictures per second; yields the address before the path."""
    asked = (SYSTEM_PYTHON, "-c", "import gi; gi.require_version('GstRtspServer', '1.0')")
    if not Path(SYSTEM_PYTHON).exists() or subprocess.run(asked, capture_output=True, timeout=30).returncode:
        miss("GStreamer's RTSP server")
    with process(SYSTEM_PYTHON, str(RTSP_SERVER)) as running:
        assert running.stdout is not None
        port = running.stdout.readline().strip()
        assert port, "the RTSP server did not start"
        yield f"rtsp://127.0.0.1:{port}"
