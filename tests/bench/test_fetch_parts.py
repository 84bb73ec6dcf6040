"""Parts of the bench of fetching: what is drawn, what is true of a thing, what is judged."""

import asyncio
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from tapreach.bench.fault_level import DEFAULT, HARD
from tapreach.bench.fetch_arms import ARM_TASKS
from tapreach.bench.fetch_figures import beside_section, chapter_section, reasons_section
from tapreach.bench.fetch_outcome import FetchOutcome, PhaseEntry, StopOutcome
from tapreach.bench.fetch_plan import Arm, Chapter, FetchBenchPlan, generator
from tapreach.bench.fetch_scene import varied_scene
from tapreach.bench.fetch_stage import draw_fetch_stage
from tapreach.bench.fetch_truth import Standing, foot_height, is_between_fingers
from tapreach.bench.fetch_ungraspable import Hindrance, ungraspable
from tapreach.bench.kept import Kept
from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.truth import ObjectTruth, WorldTruth
from tapreach.tasks.fetch.states import Phase
from tapreach.tasks.fetch.ways import Ways
from tapreach.tasks.task import Tap

GOOD = FetchOutcome(
    chapter=Chapter.DEFAULT.value, number=3, arm="the whole of it", scene="random", thing="red can",
    distance=1.5, is_way_free=True, state="done", phase=Phase.HELD.value, note="held: seen", attempt=1,
    is_held=True, lift=0.1, lifted_after=28.0, is_denied=False, seconds=30.0, wall_seconds=60.0,
    others_moved=(), most_moved=0.4,
    phases=(PhaseEntry(0.0, "look", ""), PhaseEntry(28.0, "verify", "lifted"), PhaseEntry(30.0, "held", "")),
)  # fmt: skip
MISSED = replace(
    GOOD, number=4, phase="failed", state="failed", note="it slipped 12 mm. Tap it", is_held=False, lift=0.0,
    lifted_after=None,
)  # fmt: skip
STOP = StopOutcome(12.0, "approach", 0.0, 200.0, False, False, 0.0, True)


def thing(
    name="can", kind="can", centre=(1.0, 0.0, 0.06), size=(0.066, 0.066, 0.12), tilt_deg=0.0
) -> ObjectTruth:
    pose = RigidTransform.from_components(centre, Rotation.from_euler("x", tilt_deg, degrees=True))
    return ObjectTruth(name, kind, centre, tuple(map(tuple, pose.as_matrix())), size, True)


def world(*things: ObjectTruth, gripper=(0.0, 0.0, 0.2)) -> WorldTruth:
    grip = np.eye(4)
    grip[:3, 3] = gripper
    one = tuple(map(tuple, np.eye(4)))
    return WorldTruth(1, one, one, tuple(map(tuple, grip)), 500.0, things)


@pytest.mark.parametrize(
    ("kind", "tilt_deg", "foot"),
    [("can", 0.0, 0.0), ("can", 90.0, 0.06 - 0.033), ("box", 0.0, 0.0), ("box", 90.0, 0.06 - 0.033)],
)
def test_foot_is_the_lowest_point_however_it_lies(kind, tilt_deg, foot) -> None:
    assert foot_height(thing(kind=kind, tilt_deg=tilt_deg)) == pytest.approx(foot, abs=1e-9)


def test_held_is_lifted_and_between_the_fingers() -> None:
    standing = Standing("can", world(thing()))
    lifted = thing(centre=(0.3, 0.0, 0.16))
    assert standing.is_held(world(lifted, gripper=(0.3, 0.0, 0.15)))
    assert standing.is_held(world(lifted, gripper=(0.24, 0.0, 0.15))), "pinched by the ends of the fingers"
    assert not standing.is_held(world(lifted, gripper=(0.2, 0.0, 0.15))), "it is not in the claw"
    assert not standing.is_held(world(thing(centre=(0.3, 0.0, 0.07)), gripper=(0.3, 0.0, 0.07))), "not lifted"
    assert not is_between_fingers(world(lifted, gripper=(0.3, 0.05, 0.15)), "can")


def test_what_is_not_meant_and_was_moved_is_named() -> None:
    other = thing("ball", "ball", (2.0, 0.0, 0.03), (0.06, 0.06, 0.06))
    standing = Standing("can", world(thing(), other))
    pushed = replace(other, centre_in_world=(2.03, 0.0, 0.03))
    assert standing.others_moved(world(thing(centre=(0.3, 0.0, 0.2)), pushed)) == ("ball",)
    assert standing.others_moved(world(thing(centre=(0.3, 0.0, 0.2)), other)) == ()


@pytest.mark.parametrize("level", [DEFAULT, HARD])
def test_level_sets_servos_off_to_either_side_and_the_camera_late(level) -> None:
    rng = np.random.default_rng(2)
    drawn = [level.draw(SimFaults(), rng) for _ in range(30)]
    assert {each.servo_offset_deg for each in drawn} == {-level.servo_offset_deg, level.servo_offset_deg}
    assert {each.camera_delay_ms for each in drawn} == {level.camera_delay_ms}
    assert {each.dropped_frames for each in drawn} == {level.dropped_frames}


def test_rooms_differ_in_more_than_their_places() -> None:
    scenes = [varied_scene(np.random.default_rng(seed)) for seed in range(4)]
    widths = [round(each.width, 4) for scene in scenes for each in scene.objects if each.graspable]
    assert len(set(widths)) == len(widths) > 12
    assert len({scene.room.floor for scene in scenes}) > 1


@pytest.mark.parametrize("hindrance", list(Hindrance))
def test_room_has_what_cannot_be_grasped(hindrance) -> None:
    found = ungraspable(np.random.default_rng(8), hindrance)
    if hindrance is Hindrance.PICTURE:
        assert found.sought.corners_in_world is not None
        assert np.ptp(found.sought.corners_in_world[:, 2]) >= 0.2
        return
    index = found.scene.object_names().index(found.sought.name)
    there = found.scene.objects[index]
    assert there.width > 0.1 if hindrance is Hindrance.WIDE else there.up > 0.36


@pytest.mark.parametrize("chapter", [Chapter.HARD, Chapter.REFUSALS])
def test_stage_is_the_same_again_and_another_by_another_seed(chapter) -> None:
    first, again, other = (asyncio.run(draw_fetch_stage(seed, chapter, 2, 30.0)) for seed in (5, 5, 6))
    assert (first.stage.start, first.stage.pixel) == (again.stage.start, again.stage.pixel)
    assert 0.5 <= first.stage.distance <= 3.0
    assert first.stage.start != other.stage.start
    assert generator(5, chapter, 2).random() != generator(5, chapter, 2, 1).random()


def test_claims_are_false_both_ways() -> None:
    assert not GOOD.is_false_claim
    assert not MISSED.is_false_claim
    assert replace(GOOD, is_held=False).is_false_claim
    assert replace(MISSED, is_held=True).is_false_claim
    assert replace(GOOD, is_denied=True).is_false_claim


def test_refusal_counts_with_its_true_reason_and_nothing_moved() -> None:
    refused = replace(
        MISSED, hindrance=Hindrance.WIDE, phase="refused", most_moved=0.0, note="28 mm too wide for the claw"
    )
    assert refused.is_truly_refused
    assert not replace(refused, most_moved=0.02).is_truly_refused
    assert not replace(refused, note="lost it").is_truly_refused
    assert not replace(refused, phase="failed").is_truly_refused
    assert not GOOD.is_truly_refused


def test_stop_is_good_when_nothing_falls_and_it_goes_on() -> None:
    assert replace(GOOD, stop=STOP).is_good
    assert not replace(GOOD, stop=replace(STOP, was_held=True)).is_good, "it fell out of the claw"
    assert not replace(GOOD, stop=replace(STOP, flung=0.03)).is_good
    assert not replace(GOOD, stop=replace(STOP, resumed=False)).is_good


@pytest.mark.parametrize("chapter", list(Chapter))
def test_every_chapter_has_figures_even_of_nothing(chapter) -> None:
    runs = [replace(each, chapter=chapter.value, stop=STOP) for each in (GOOD, MISSED)]
    for own in ([], runs):
        section = chapter_section(chapter, own)
        assert any(figure.limit is not None for figure in section.figures)
        assert all(figure.value is None or math.isfinite(figure.value) for figure in section.figures)
        assert all(len(row) == len(section.grid.columns) for row in section.grid.rows)


def test_reasons_are_counted_without_their_numbers() -> None:
    other = replace(MISSED, number=5, note="it slipped 7.5 mm. Tap it")
    grid = reasons_section(Chapter.DEFAULT, [GOOD, MISSED, other]).grid
    assert grid is not None
    assert grid.rows == (("2", "failed after verify", "it slipped N mm"),)


def test_arms_are_set_beside_each_other_over_the_runs_that_all_did() -> None:
    missed = replace(MISSED, arm=Arm.FIXED_MOVE.value)
    section = beside_section([GOOD, replace(missed, number=GOOD.number), replace(GOOD, number=9)])
    assert [(row[0], *row[1:3]) for row in section.grid.rows] == [
        (GOOD.arm, "1", "1"),
        (missed.arm, "1", "0"),
    ]
    assert [figure.value for figure in section.figures] == [100.0, 0.0]


def test_every_arm_leaves_out_another_part() -> None:
    assert set(ARM_TASKS) == set(Arm)
    ways = [ARM_TASKS[arm](Tap(1, 2.0, 3.0)).ways for arm in Arm]
    assert ways[0] == Ways()
    assert len(set(ways)) == len(ways)


def test_kept_runs_are_read_again(tmp_path) -> None:
    kept = Kept(tmp_path / "runs.jsonl", list[FetchOutcome])
    kept.add([replace(GOOD, stop=STOP)])
    assert kept.read() == [[replace(GOOD, stop=STOP)]]


def test_one_chapter_alone_and_arms_only_with_default_faults() -> None:
    plan = FetchBenchPlan(1, chapter=Chapter.HARD)
    assert plan.chapters == (Chapter.HARD,)
    assert FetchBenchPlan(1).chapters == tuple(Chapter)
    assert plan.arms_of(Chapter.HARD, 0) == plan.arms[:1]
    assert plan.arms_of(Chapter.DEFAULT, 0) == plan.arms
    assert plan.arms_of(Chapter.DEFAULT, plan.comparisons) == plan.arms[:1]
