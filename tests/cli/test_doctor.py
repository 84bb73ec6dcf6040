"""`tapreach doctor` as a user types it, with a board behind a pseudo-terminal and a camera behind HTTP."""

import asyncio
import json

import pytest
from tests.cli.visited_board import turn
from tests.drivers.arduino.lines import PtyLine
from tests.drivers.arduino.peer import PeerBoard
from tests.drivers.arduino.rig import description_for
from tests.drivers.camera.mjpeg_server import OK, MjpegServer
from tests.drivers.camera.pictures import jpeg, part
from typer.testing import CliRunner

from tapreach.cli.checkup.camera_check import judged_frames
from tapreach.cli.checkup.check import Verdict
from tapreach.cli.checkup.examine import examine
from tapreach.cli.main import app
from tapreach.errors import InputError
from tapreach.geometry.pixel import ImageSize
from tapreach.resources import resource_path
from tapreach.robot.clock import MS, ManualClock, MonotonicClock
from tapreach.robot.messages import Frame

CAMERA = description_for("/dev/peer").camera


def robot_file(tmp_path, board, source):
    text = (resource_path("robots") / "rover-pi.toml").read_text(encoding="utf-8")
    for old, new in (
        ("/dev/ttyACM0", board),
        ("v4l2:/dev/video0", source),
        ("width = 640", "width = 160"),
        ("height = 480", "height = 120"),
    ):
        assert old in text
        text = text.replace(old, new)
    path = tmp_path / "rover.toml"
    path.write_text(text, encoding="utf-8")
    return path


async def stream(visit):
    await visit.send(OK)
    for number in range(10**6):
        await visit.send(part(jpeg(number % 7)))
        await asyncio.sleep(0.03)


def invoked(*arguments):
    return CliRunner().invoke(app, ["doctor", *arguments])


@pytest.mark.flaky(reruns=1)  # real lines and the real clock
def test_robot_that_is_well_passes_every_check(tmp_path):
    async def run():
        line = PtyLine(PeerBoard(MonotonicClock()), tmp_path / "board")
        await line.open()
        async with MjpegServer(stream).running() as server:
            path = robot_file(tmp_path, line.address, server.url)
            words = "--robot", str(path), "--json", "--captures", str(tmp_path)
            done = await asyncio.to_thread(invoked, *words)
        await line.close()
        return done

    done = asyncio.run(run())
    told = json.loads(done.stdout)
    verdicts = {check["name"]: check["verdict"] for check in told["checks"]}
    assert list(verdicts) == ["camera", "link", "firmware", "battery", "servos", "wifi", "disk"]
    assert {verdicts[name] for name in ("link", "firmware", "battery", "servos")} == {"ok"}, told
    assert verdicts["camera"] in ("ok", "warn")
    assert 10 < told["checks"][0]["figures"]["rate_hz"] < 40
    assert done.exit_code == (1 if told["verdict"] == "fail" else 0)


def test_robot_that_is_not_there_fails_in_words_and_exits_with_1(tmp_path):
    path = robot_file(tmp_path, str(tmp_path / "none"), f"v4l2:{tmp_path}/video7")
    done = invoked("--robot", str(path))
    assert done.exit_code == 1
    assert "video7" in done.stdout
    assert "is not there: plug the board in" in done.stdout
    assert "Mend the first thing that fails" in done.stdout


def test_robot_of_no_hardware_is_checked_as_well(tmp_path):
    done = invoked("--robot", "fake", "--captures", str(tmp_path))
    assert done.exit_code == 0, done.output
    assert "driver 'fake' answers" in done.stdout
    assert "pictures/s of 30" in done.stdout


def test_unknown_robot_is_refused():
    assert isinstance(invoked("--robot", "dalek").exception, InputError)


def test_bridge_that_is_not_there_fails_by_its_link(tmp_path):
    described = description_for(str(tmp_path / "none"), "ros-arduino")

    async def run():
        clock = ManualClock()
        turning = asyncio.create_task(turn(clock, lambda: None))
        checks = await examine(described, clock, tmp_path)
        turning.cancel()
        return checks

    checks = asyncio.run(run())
    assert [c.verdict for c in checks if c.name == "link"] == [Verdict.FAIL]
    assert next(c for c in checks if c.name == "camera").verdict is Verdict.WARN  # it names none


def frames(rate_hz, age_ms, count=40):
    times = [round(number * 1000 * MS / rate_hz) for number in range(count)]
    return [Frame(i + 1, t, t + round(age_ms * MS), ImageSize(160, 120), b"") for i, t in enumerate(times)]


@pytest.mark.parametrize(
    ("rate_hz", "age_ms", "verdict", "word"),
    [
        (30, 40, Verdict.OK, ""),
        (20, 40, Verdict.WARN, "more light"),
        (5, 40, Verdict.FAIL, "more light"),
        (30, 300, Verdict.WARN, "late"),
        (30, 700, Verdict.FAIL, "late"),
    ],
)
def test_pictures_are_judged_by_rate_and_age(rate_hz, age_ms, verdict, word):
    check = judged_frames(frames(rate_hz, age_ms), CAMERA)
    assert check.verdict is verdict
    assert word in check.advice
    assert check.figures["rate_hz"] == pytest.approx(rate_hz, rel=0.01)
    assert check.figures["age_ms"] == pytest.approx(age_ms)
    assert check.figures["longest_gap_ms"] == pytest.approx(1000 / rate_hz, abs=0.1)


def test_single_picture_has_no_rate_and_fails():
    assert judged_frames(frames(30, 10, 1), CAMERA).verdict is Verdict.FAIL
