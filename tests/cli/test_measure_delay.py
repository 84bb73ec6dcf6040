"""The camera's delay, measured by the robot and written: a board, and a camera that is late."""

import asyncio
import tomllib

import pytest
from tests.cli.test_teach import SHIPPED, Scripted
from tests.cli.visited_board import play_clocked
from tests.drivers.arduino.peer import PeerBoard
from tests.server.conftest import InlineService
from typer.testing import CliRunner

from tapreach.cli.main import app
from tapreach.cli.teaching.delay import changes_of, measure_delay
from tapreach.drivers.arduino.parts import NoCamera
from tapreach.drivers.arduino.robot import ArduinoRobot
from tapreach.drivers.fake_picture import FakePicture
from tapreach.drivers.tick_odometry import TickOdometry
from tapreach.errors import InputError
from tapreach.estimation.camera_delay import CameraDelay
from tapreach.robot.clock import MS
from tapreach.robot.config import load_robot
from tapreach.robot.messages import Frame
from tapreach.tasks.teaching.person import TeachingStopped

PERIOD_NS = 60 * MS


class LateCamera(NoCamera):
    """Draws what was to be seen `late_ms` ago; takes off its stamps what the robot file says."""

    def __init__(self, description, clock, board, late_ms):
        super().__init__()
        self._camera, self._clock, self._board, self._late_ns = description.camera, clock, board, late_ms * MS
        self._odometry = TickOdometry(description.base)

    def start(self):
        self._task = asyncio.create_task(self._run())

    async def close(self):
        self._task.cancel()
        await asyncio.wait([self._task])

    async def _run(self):
        picture, count = FakePicture(self._camera), 0
        while True:
            ticks = [round(tick) for tick in self._board.ticks]
            pose = self._odometry.update(self._clock.now_ns() + 1, *ticks).world_from_base
            await self._clock.sleep_until(self._clock.now_ns() + self._late_ns)
            count += 1
            now_ns = self._clock.now_ns()
            stamp_ns = now_ns - round(self._camera.delay_ms * MS)
            size = self._camera.model().size
            self._listeners.tell(Frame(count, stamp_ns, now_ns, size, picture.jpeg(pose, "")))
            await self._clock.sleep_until(now_ns + max(MS, PERIOD_NS - self._late_ns))


@pytest.fixture
def own_file(tmp_path):
    path = tmp_path / "rover.toml"
    path.write_text(SHIPPED.read_text(encoding="utf-8"), encoding="utf-8")
    return path


def measured(path, person, late_ms):
    async def work(clock, board, opened):
        def make(description, clock):
            make_camera = lambda description, clock: LateCamera(description, clock, board, late_ms)  # noqa: E731
            return ArduinoRobot(description, clock, make_camera, opened)

        return await measure_delay(path, person, clock, make, InlineService())

    return play_clocked(work, lambda clock: PeerBoard(clock, first_tick=0))


def test_delay_is_measured_written_and_then_taken_off(own_file):
    before = tomllib.loads(SHIPPED.read_text(encoding="utf-8"))["camera"]
    late_ms = 50
    assert measured(own_file, Scripted("yes", "yes"), late_ms)
    text = own_file.read_text(encoding="utf-8")
    after = tomllib.loads(text)["camera"]
    assert after["delay_ms"] == pytest.approx(late_ms, abs=6)
    assert after["timing_sigma_ms"] < before["timing_sigma_ms"]
    untouched = {key: value for key, value in before.items() if key not in ("delay_ms", "timing_sigma_ms")}
    assert {key: after[key] for key in untouched} == untouched
    again = Scripted("yes", "no")
    measured(own_file, again, late_ms)
    assert own_file.read_text(encoding="utf-8") == text
    assert abs(float(again.text.split("the camera is ")[1].split(" ms")[0])) <= 3


def test_person_who_stops_before_it_turns_leaves_the_file(own_file):
    with pytest.raises(TeachingStopped):
        measured(own_file, Scripted("stop"), 50)
    assert own_file.read_bytes() == SHIPPED.read_bytes()


def test_what_is_left_comes_on_top_and_stamps_ahead_of_pictures_are_refused():
    camera = load_robot(SHIPPED).camera.model_copy(update={"delay_ms": 30.0})
    changes = changes_of(camera, CameraDelay(0.045, 0.003, 0.004))
    assert changes == {("camera", "delay_ms"): 75.0, ("camera", "timing_sigma_ms"): 5.0}
    assert changes_of(camera, CameraDelay(-0.032, 0.003))["camera", "delay_ms"] == 0.0
    with pytest.raises(InputError, match="measure again"):
        changes_of(camera, CameraDelay(-0.06, 0.003))


def test_shipped_file_robot_without_camera_and_two_options_are_refused(tmp_path):
    with pytest.raises(InputError, match="copy it"):
        measured(SHIPPED, Scripted(), 50)
    other = tmp_path / "fake.toml"
    other.write_text((SHIPPED.parent / "fake.toml").read_text(encoding="utf-8"), encoding="utf-8")
    with pytest.raises(InputError, match="no delay to measure"):
        measured(other, Scripted(), 50)
    words = ["doctor", "--robot", "rover-pi", "--teach", "motors", "--measure", "delay"]
    assert "one after the other" in str(CliRunner().invoke(app, words).exception)
    assert "needs a person" in str(CliRunner().invoke(app, [*words[:3], *words[5:]]).exception)
