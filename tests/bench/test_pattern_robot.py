import asyncio

import cv2
import numpy as np

from tapreach.bench.estimate_load import POINT_IN_WORLD, sightings
from tapreach.bench.pattern import pattern_jpegs, read_bar_code
from tapreach.bench.pattern_description import pattern_description
from tapreach.bench.pattern_robot import PatternRobot, SentTwist
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.clock import MS, SECOND, ManualClock
from tapreach.robot.messages import Twist
from tapreach.tasks.estimating import estimate

SIZE = ImageSize(160, 120)


def watch(seconds: int):
    clock, frames, told = ManualClock(), [], []

    async def run():
        description = pattern_description(SIZE, 10.0)
        robot = PatternRobot(description, pattern_jpegs(SIZE, seed=1, count=16), clock, told.append)
        robot.frames.subscribe(frames.append)
        await robot.connect()
        await clock.advance(seconds * SECOND)
        robot.base.drive(Twist(0.1, 0.0))
        await robot.close()
        await clock.advance(SECOND)

    asyncio.run(run())
    return clock, frames, told


def test_frames_come_at_the_rate_and_end_with_the_robot():
    _, frames, _ = watch(2)
    assert [frame.frame_id for frame in frames] == list(range(1, 22))
    steps = np.diff([frame.captured_ns for frame in frames])
    assert set(steps.tolist()) == {100 * MS}


def test_frame_shows_its_own_number():
    _, frames, _ = watch(2)
    for frame in frames:
        picture = cv2.imdecode(np.frombuffer(frame.jpeg, np.uint8), cv2.IMREAD_COLOR)
        assert read_bar_code(picture) == frame.frame_id % 16


def test_wheels_note_what_they_are_told_and_when():
    clock, _, told = watch(1)
    assert told == [SentTwist(clock.now_ns() - SECOND, Twist(0.1, 0.0))]


def test_load_is_a_real_estimate_of_a_real_point():
    description = pattern_description(ImageSize(640, 480), 30.0)
    answer = estimate(sightings(description, seed=4), description, with_advice=False)
    error = np.linalg.norm(np.asarray(answer.point_in_world) - POINT_IN_WORLD)
    assert error < 0.1
