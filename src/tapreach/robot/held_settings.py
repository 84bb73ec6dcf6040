"""Cameras whose automatics can be held, so that a thing looks the same from one picture to the next."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Protocol, runtime_checkable

from tapreach.robot.interface import FrameSource


@runtime_checkable
class HoldsSettings(Protocol):
    """What a robot's camera also offers where exposure, gain, white balance and focus can be reached."""

    def hold_settings(self) -> Callable[[], None]:
        """Keep them as they are, from the next picture on, until what is returned is called.

        Held by several they are let go by the last one; calling it twice does no harm. A camera that drops
        out meanwhile is held again when it is back.
        """
        ...


@contextmanager
def settings_held(camera: FrameSource) -> Iterator[None]:
    """Hold the camera's settings for as long as the block runs, however it ends; others go on as they do."""
    release = camera.hold_settings() if isinstance(camera, HoldsSettings) else None
    try:
        yield
    finally:
        if release is not None:
            release()
