"""Exposure and white balance of a V4L2 camera (made of answers), held and released by the whole driver."""

import asyncio

import pytest
from tests.drivers.camera.fake_video import FakeVideo
from tests.drivers.camera.pictures import jpeg
from tests.drivers.camera.test_v4l2_stream import CONTROLS, EXPOSURE_AUTO, FOCUS_AUTO, SIZE, WHITE_AUTO
from tests.drivers.camera.watching import Watched

from tapreach.drivers.arduino.parts import NoCamera
from tapreach.drivers.camera.stream import Hold
from tapreach.drivers.camera.threaded import ThreadedCamera
from tapreach.drivers.camera.v4l2_stream import V4l2Stream
from tapreach.robot.clock import MonotonicClock
from tapreach.robot.held_settings import HoldsSettings, settings_held

BY_HAND = {EXPOSURE_AUTO: 1, WHITE_AUTO: 0}
AUTOMATIC = {EXPOSURE_AUTO: 3, WHITE_AUTO: 1}


class Plugged:
    """A camera that somebody films with; `device` is what is plugged in now."""

    def __init__(self):
        self.device = FakeVideo(controls=CONTROLS)
        clock, hold = MonotonicClock(), Hold()

        def make():
            return V4l2Stream("/dev/video0", clock, 0, SIZE, 30.0, hold, lambda path: self.device)

        self.camera = ThreadedCamera(make, SIZE, clock, hold)
        self.seen = Watched(self.camera)
        self._clock = clock

    async def until(self, wanted):
        """Film until the controls are so."""
        await self.film_until(lambda: wanted.items() <= self.device.controls.items())

    async def film(self, pictures):
        """Film so many pictures more."""
        end = len(self.seen.frames) + pictures
        await self.film_until(lambda: len(self.seen.frames) >= end)

    async def film_until(self, holds):
        def is_so():
            if self.device.is_streaming and self.device.empty and not self.device.filled:
                self.device.fill(jpeg(1), self._clock.now_ns())
            return holds()

        await self.seen.until(is_so)


def play(scenario):
    async def run():
        plugged = Plugged()
        plugged.camera.start()
        try:
            await plugged.until({FOCUS_AUTO: 0, **AUTOMATIC})
            await scenario(plugged)
        finally:
            await plugged.camera.close()

    asyncio.run(run())


def test_held_while_the_block_runs_and_released_after_an_error():
    async def scenario(plugged):
        with pytest.raises(ZeroDivisionError), settings_held(plugged.camera):
            await plugged.until(BY_HAND)
            raise ZeroDivisionError
        await plugged.until(AUTOMATIC)

    play(scenario)


def test_last_of_two_holders_releases_and_releasing_twice_does_no_harm():
    async def scenario(plugged):
        first, second = plugged.camera.hold_settings(), plugged.camera.hold_settings()
        await plugged.until(BY_HAND)
        first()
        first()
        await plugged.film(4)
        assert BY_HAND.items() <= plugged.device.controls.items()
        second()
        await plugged.until(AUTOMATIC)

    play(scenario)


def test_camera_that_was_unplugged_while_held_is_held_again():
    async def scenario(plugged):
        with settings_held(plugged.camera):
            await plugged.until(BY_HAND)
            gone, plugged.device = plugged.device, FakeVideo(controls=CONTROLS)
            gone.unplug()
            await plugged.until(BY_HAND)
        await plugged.until(AUTOMATIC)

    play(scenario)


def test_closing_gives_the_camera_back_as_it_was():
    async def scenario(plugged):
        plugged.camera.hold_settings()
        await plugged.until(BY_HAND)
        await plugged.camera.close()
        assert plugged.device.controls == CONTROLS

    play(scenario)


def test_camera_without_settings_goes_on_as_it_does():
    camera = NoCamera()
    assert not isinstance(camera, HoldsSettings)
    with settings_held(camera):
        pass
