"""Parts of the bench of locating: what is drawn, what is judged, what is kept."""

import asyncio
import math
from dataclasses import replace

import numpy as np
import pytest

from tapreach.bench.fault_level import LOCATING
from tapreach.bench.kept import Kept
from tapreach.bench.locate_figures import arm_section
from tapreach.bench.locate_outcome import SURE_DEPTH, SURE_REGION, Outcome
from tapreach.bench.locate_plan import Arm, scene_of
from tapreach.bench.locate_stage import draw_stage
from tapreach.bench.places import FARTHEST, NEAREST
from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.scene import scene_names
from tapreach.errors import ConfigError

ANSWER = Outcome(
    tap=3, arm=str(Arm.CHOSEN), scene="room", thing="mug", distance=1.2, status="determined", note="",
    seconds=5.0, driven=0.3, scale=1.01, moved=0.0, views=6, wall_seconds=4.0, range_error=0.01,
    position_error=0.02, nees=2.0, nees_depth=1.5, nees_position=2.5, holds_range=True,
    relative_sd=0.012, track_px=0.4,
)  # fmt: skip
REFUSED = replace(
    ANSWER, tap=4, status="failed", note="lost the tapped place: hidden. Tap it again", range_error=None,
    position_error=None, nees=None, nees_depth=None, nees_position=None, holds_range=None, relative_sd=None,
)  # fmt: skip


def test_faults_have_the_size_they_say() -> None:
    rng = np.random.default_rng(4)
    drawn = [LOCATING.draw(SimFaults(), rng) for _ in range(400)]
    turned = [math.hypot(f.mount_pitch_deg, f.mount_yaw_deg, f.mount_roll_deg) for f in drawn]
    moved = [math.hypot(f.mount_forward, f.mount_left, f.mount_up) for f in drawn]
    assert turned == pytest.approx([1.0] * 400)
    assert moved == pytest.approx([LOCATING.mount_shift] * 400)
    assert {f.jpeg_quality for f in drawn} == {80}
    mean = np.array([(f.wheel_left_error + f.wheel_right_error) / 2 for f in drawn])
    apart = np.array([f.wheel_left_error - f.wheel_right_error for f in drawn])
    base = LOCATING.robot_file(30.0).base
    assert np.sqrt(np.mean(mean**2)) == pytest.approx(base.distance_sigma, rel=0.15)
    drift = math.degrees(float(np.sqrt(np.mean(apart**2)))) / base.track_width
    assert drift == pytest.approx(base.drift_sigma_deg_per_m, rel=0.15)
    assert np.abs(apart).max() < 1.2 * LOCATING.most_slip


def test_faults_of_a_scene_stay() -> None:
    faults = LOCATING.draw(SimFaults(motion_blur_ms=20.0), np.random.default_rng(1))
    assert faults.motion_blur_ms == 20.0


def test_every_scene_has_its_turn_and_random_ones_differ() -> None:
    scenes = [scene_of(7, number) for number in range(20)]
    assert {name for name, _ in scenes} == {*scene_names(), "random"}
    own = [scene.title for name, scene in scenes if name == "random"]
    assert len(own) == len(set(own)) == 6


def test_stage_is_the_same_again_and_shows_the_thing() -> None:
    first, again = (asyncio.run(draw_stage(5, 6, 30.0)) for _ in range(2))
    assert (first.start, first.pixel, first.faults) == (again.start, again.pixel, again.faults)
    assert NEAREST <= first.distance <= FARTHEST
    assert first.thing in first.scene.object_names()
    assert first.pixel.is_inside(LOCATING.robot_file(30.0).camera.model().size)
    assert asyncio.run(draw_stage(6, 6, 30.0)).start != first.start


def test_wrong_is_what_is_far_off_and_sure_of_itself() -> None:
    far = replace(ANSWER, range_error=-0.08)
    assert not ANSWER.is_wrong
    assert not far.is_wrong, "its region is wide enough"
    assert replace(far, nees_depth=SURE_DEPTH + 1.0).is_wrong
    assert replace(far, nees_position=SURE_REGION + 1.0).is_wrong
    assert not replace(ANSWER, nees_depth=SURE_DEPTH + 1.0).is_wrong, "it is near enough"
    assert not REFUSED.is_wrong


def test_figures_count_refusals_and_say_why() -> None:
    section = arm_section(Arm.CHOSEN, [ANSWER, REFUSED], is_held=True)
    figures = {figure.name: figure for figure in section.figures}
    assert figures["refused"].value == 50.0
    assert figures["refused"].note == "1 lost the tapped place: hidden"
    assert figures["range error: median"].value == pytest.approx(1.0)
    assert section.grid is not None
    assert all(len(row) == len(section.grid.columns) for row in section.grid.rows)


def test_figures_of_nothing_are_not_measured() -> None:
    figures = {each.name: each for each in arm_section(Arm.CHOSEN, [REFUSED], is_held=True).figures}
    assert figures["range error: median"].value is None
    assert figures["range error: median"].holds is False


def test_kept_taps_are_read_again(tmp_path) -> None:
    kept = Kept(tmp_path / "new" / "taps.jsonl", list[Outcome])
    assert kept.read() == []
    kept.add([ANSWER, replace(ANSWER, arm="fixed move")])
    kept.add([REFUSED])
    first, second = kept.read()
    assert first[0] == ANSWER
    assert second == [REFUSED]


def test_file_that_holds_something_else_is_named(tmp_path) -> None:
    path = tmp_path / "other.jsonl"
    path.write_text("not json\n")
    with pytest.raises(ConfigError, match=r"other\.jsonl"):
        Kept(path, list[Outcome]).read()
