"""A camera with everything that it has told, and bounded waiting for more."""

import asyncio
import threading
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

from tapreach.drivers.camera.factory import make_camera
from tapreach.drivers.camera.threaded import CameraStatus, ThreadedCamera
from tapreach.robot.clock import MonotonicClock
from tapreach.robot.config import CameraSection
from tapreach.robot.messages import Frame

PATIENCE_S = 20.0


def section(source: str, width: int = 160, height: int = 120, **other: float) -> CameraSection:
    mount = {"forward": 0.1, "up": 0.2}
    return CameraSection.model_validate(
        {"source": source, "width": width, "height": height, "fx": 150.0, "mount": mount, **other}
    )


class Watched:
    """A camera, its frames and statuses."""

    def __init__(self, camera: ThreadedCamera) -> None:
        self.camera = camera
        self.frames: list[Frame] = []
        self.statuses: list[CameraStatus] = []
        camera.subscribe(self.frames.append)
        camera.subscribe_status(self.statuses.append)

    async def until(self, holds: Callable[[], object]) -> None:
        async with asyncio.timeout(PATIENCE_S):
            while not holds():
                await asyncio.sleep(0.005)


@asynccontextmanager
async def watched(settings: CameraSection) -> AsyncIterator[Watched]:
    """Start the camera; after it, no thread of it may be left."""
    seen = Watched(make_camera(settings, MonotonicClock()))
    seen.camera.start()
    try:
        yield seen
    finally:
        await seen.camera.close()
        assert [thread.name for thread in threading.enumerate() if thread.name == "camera"] == []
