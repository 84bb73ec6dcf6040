"""Looking for the thing again: where it should be in the picture, what of it is kept, and what forgotten."""

import asyncio
import math
from dataclasses import replace

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.messages import ArmPose, Frame
from tapreach.tasks.estimating import LocatedPoint, estimate
from tapreach.tasks.fetch.fetch_state import Mode
from tapreach.tasks.fetch.gripping import _let_be_moved
from tapreach.tasks.fetch.known_thing import MISTAKEN_SD, PUSHED_SD, Appearance, KnownThing
from tapreach.tasks.fetch.looking_again import (
    expected,
    is_where_it_was,
    keep_what_is_known,
    tap_again,
    tap_unseen,
)
from tapreach.tasks.fetch.memory import FetchMemory
from tapreach.tasks.fetch.run import FetchRun, NotKnown
from tapreach.tasks.fetch.thing import NoSize, ThingSize
from tapreach.tasks.known_place import KnownPlace
from tapreach.tasks.optics import optics_of, points_in_camera
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.task import Tap
from tasks.fetch.worlds import ROBOT, size_at
from tasks.rig import bare_context

THING = np.array([0.6, 0.03, 0.05])
HERE = PlanarPose(0.05, 0.0, 0.0)
SEEN = Appearance(b"", Pixel(320.0, 240.0), 0.5)


class Located:
    """What a locating that has ended is to a fetch."""

    way_since_seen = ()

    def __init__(self, found: LocatedPoint) -> None:
        self.estimate = found


def pixel_of(thing: np.ndarray, here: PlanarPose) -> np.ndarray:
    in_camera = points_in_camera(thing[None], here, ROBOT.camera)
    return np.asarray(optics_of(ROBOT.camera)[0].project(in_camera).pixels[0])


class FoldedArm:
    """An arm that is out of the picture."""

    async def target(self) -> ArmPose:
        return ROBOT.arm.standard.pose()


def picture(thing: np.ndarray | None) -> bytes:
    """What the camera sees from HERE: a textured floor, and a textured thing unless it is gone."""
    rng = np.random.default_rng(8)
    noise = cv2.GaussianBlur(rng.normal(size=(480, 640)).astype(np.float32), (0, 0), 5.0)
    seen = 128.0 + 40.0 * noise / noise.std()
    if thing is not None:
        u, v = (round(float(each)) for each in pixel_of(thing, HERE))
        coat = cv2.GaussianBlur(rng.normal(size=(61, 61)).astype(np.float32), (0, 0), 2.5)
        shown = seen[v - 30 : v + 31, u - 30 : u + 31]
        shown[:] = (120.0 + 45.0 * coat / coat.std())[: shown.shape[0], : shown.shape[1]]
    return bytes(cv2.imencode(".jpg", np.clip(seen, 0, 255).astype(np.uint8))[1])


def looking_at(what: KnownThing, seen: bytes) -> Tap | None:
    """Where the thing is tapped again when the next picture is `seen`."""
    context = bare_context()
    now_ns = context.clock.now_ns()
    context.poses.add(now_ns, HERE)
    context.poses.add(now_ns + 1, HERE)

    async def next_frame(frame_id: int) -> Frame:
        return Frame(7, now_ns, now_ns, ROBOT.camera.model().size, seen)

    context = replace(context, next_frame=next_frame)
    run = FetchRun(context, FetchMemory(Tap(1, 1.0, 1.0), 1, Mode.GO, known=what), (), FoldedArm())  # type: ignore[arg-type]
    return asyncio.run(tap_again(run))


def known(sd: float = 0.01) -> KnownThing:
    size = replace(size_at(0.6, 0.03), seen_along=0.0)
    place = KnownPlace(THING, sd**2 * np.eye(3), HERE)
    return KnownThing(place, size, np.array([0.02, 0.0, 0.0]), SEEN)


def run_with(what: KnownThing | None, thing: np.ndarray = THING) -> FetchRun:
    """A fetch whose robot stands at HERE, having located `thing`."""
    context = bare_context()
    context.poses.add(1, HERE)
    run = FetchRun(context, FetchMemory(Tap(1, 1.0, 1.0), 1, Mode.GO, known=what), (), None)  # type: ignore[arg-type]
    poses = [HERE.after(PlanarStep(0.0, -back)) for back in (0.3, 0.15, 0.0)]
    views = [
        Sighting(i, i, Pixel(*map(float, pixel_of(thing, pose))), 0.4, 1.0, pose)
        for i, pose in enumerate(poses)
    ]
    run.locating = Located(estimate(views, ROBOT, False))  # type: ignore[assignment]
    return run


def spread(what: KnownThing, here: PlanarPose = HERE) -> float:
    there = expected(what, here, ROBOT)
    assert there is not None
    return math.sqrt(float(np.linalg.eigvalsh(there.covariance)[-1]))


def test_thing_is_expected_where_the_camera_would_see_it() -> None:
    there = expected(known(), HERE, ROBOT)
    assert there is not None
    np.testing.assert_allclose(there.pixel, pixel_of(THING, HERE), atol=1e-6)
    assert expected(known(), replace(HERE, heading=math.pi), ROBOT) is None


@given(st.floats(-0.03, 0.03), st.floats(-0.03, 0.03))
def test_pushed_thing_lies_in_the_region_in_which_it_is_sought(ahead: float, aside: float) -> None:
    there = expected(known(0.005).pushed(), HERE, ROBOT)
    assert there is not None
    off = pixel_of(THING + np.array([ahead, aside, 0.0]), HERE) - there.pixel
    assert off @ np.linalg.solve(there.covariance, off) < 9.0
    assert spread(known(0.005).pushed()) > 1.5 * spread(known(0.005))


@given(st.floats(0.05, 0.6))
def test_region_grows_with_the_way_driven_since(back: float) -> None:
    been = replace(known(), place=known().place.seen_from(HERE.after(PlanarStep(0.0, -back)), ROBOT))
    assert spread(replace(been, place=been.place.seen_from(HERE, ROBOT))) > spread(known())


@given(st.floats(0.0, 0.2))
def test_farther_away_it_is_sought_at_a_smaller_size(back: float) -> None:
    there = expected(known(), HERE.after(PlanarStep(0.0, -back)), ROBOT)
    assert there is not None
    distance = np.linalg.norm(points_in_camera(THING[None], HERE, ROBOT.camera)) + 0.9 * back
    assert there.scales[0] == pytest.approx(SEEN.distance / distance, rel=0.06)
    assert min(there.scales) < there.scales[0] < max(there.scales)


def test_size_is_known_at_once_and_kept_where_it_cannot_be_measured_again() -> None:
    run = run_with(known())
    run.measured(NoSize("only 1 picture"), THING)
    size = run.thing().size
    assert isinstance(size, ThingSize) and size.width == pytest.approx(0.05)
    np.testing.assert_allclose(size.axis_in_world, THING + np.array([0.02, 0.0, 0.0]), atol=1e-3)


def test_place_and_size_are_remembered_as_they_are_known_now() -> None:
    run = run_with(None)
    run.measured(size_at(0.62, 0.03), THING)
    keep_what_is_known(run)
    kept = run.memory.known
    assert kept is not None and kept.size is not None and kept.appearance is None
    np.testing.assert_allclose(kept.place.point_in_world, THING, atol=1e-3)
    assert kept.place.known_at == HERE and kept.size.seen_along == pytest.approx(0.0, abs=0.1)


def test_grip_that_may_have_pushed_it_leaves_its_place_less_sure_and_its_size_as_it_is() -> None:
    run = run_with(known(0.004))
    _let_be_moved(run)
    kept = run.memory.known
    assert kept is not None and kept.size is not None and kept.size.width_sd == known().size.width_sd  # type: ignore[union-attr]
    assert math.sqrt(kept.place.cov_in_world[0, 0]) == pytest.approx(math.hypot(0.004, PUSHED_SD))
    looked_at = kept.place_seen_from(HERE).cov_in_world
    assert math.sqrt(looked_at[0, 0]) == pytest.approx(math.hypot(0.004, PUSHED_SD, MISTAKEN_SD), rel=0.02)
    before = known(0.004)
    assert before.place_seen_from(HERE) is before.place


@pytest.mark.parametrize(("aside", "up"), [(0.0, 0.0), (0.01, 0.04), (0.2, 0.0)])
def test_nothing_is_kept_when_the_place_looked_at_is_another_one(aside: float, up: float) -> None:
    """Another spot of the same thing is none."""
    run = run_with(known(0.004), THING + np.array([0.0, aside, up]))
    assert is_where_it_was(run) is (aside < 0.1)
    run.forget()
    assert run.memory.known is None and isinstance(run.size, NoSize)


@pytest.mark.parametrize("push", [(0.0, 0.0), (0.02, 0.03), (0.03, -0.04)])
def test_thing_pushed_by_the_claw_is_tapped_where_it_is_now(push: tuple[float, float]) -> None:
    looked = Appearance(picture(THING), Pixel(*map(float, pixel_of(THING, HERE))), 0.5)
    what = replace(known(0.004), appearance=looked).pushed()
    pushed = THING + np.array([*push, 0.0])
    tap = looking_at(what, picture(pushed))
    assert tap is not None and tap.frame_id == 7
    np.testing.assert_allclose((tap.u, tap.v), pixel_of(pushed, HERE), atol=2.0)


def test_thing_that_is_gone_or_stands_far_from_where_it_was_is_not_tapped() -> None:
    looked = Appearance(picture(THING), Pixel(*map(float, pixel_of(THING, HERE))), 0.5)
    what = replace(known(0.004), appearance=looked)
    assert looking_at(what, picture(None)) is None
    assert looking_at(what, picture(THING + np.array([0.05, 0.12, 0.0]))) is None
    assert looking_at(known(), picture(THING)) is None, "a picture that cannot be used"


@pytest.mark.parametrize(("right", "is_tapped"), [(0.27, True), (0.278, False)], ids=["just inside", "gone"])
def test_thing_at_the_edge_is_tapped_while_its_spot_is_in_the_picture(right: float, is_tapped: bool) -> None:
    before, now = (np.array([0.6, -aside, 0.05]) for aside in (0.265, right))
    looked = Appearance(picture(before), Pixel(*map(float, pixel_of(before, HERE))), 0.5)
    place = replace(known(0.02).place, point_in_world=before)
    tap = looking_at(replace(known(0.02), place=place, appearance=looked), picture(now))
    assert (tap is not None) == is_tapped


def tapped_unseen(sd: float, here: PlanarPose = HERE) -> tuple[Tap | None, FetchRun]:
    run = run_with(known(sd))
    run.context.poses.add(run.context.clock.now_ns() + 2, here)
    run.context.frames.add(Frame(7, 0, 0, ROBOT.camera.model().size, b""))
    return asyncio.run(tap_unseen(run)), run


def test_thing_that_looks_otherwise_is_tapped_on_its_front_where_that_is_surely_met() -> None:
    tap, run = tapped_unseen(0.004)
    assert tap is not None and run.memory.known is not None and known().size is not None
    before, now = known(), run.memory.known
    front = now.place.point_in_world
    assert (tap.u, tap.v) == pytest.approx(tuple(pixel_of(front, HERE)))
    assert front + now.axis_offset == pytest.approx(before.place.point_in_world + before.axis_offset)
    assert np.linalg.norm(now.axis_offset) == pytest.approx(before.size.width / 2.0)


def test_thing_that_may_be_missed_or_is_out_of_the_picture_is_not_tapped_unseen() -> None:
    assert tapped_unseen(0.05)[0] is None
    assert tapped_unseen(0.004, HERE.compose(PlanarPose(0.0, 0.0, 1.5)))[0] is None


def test_thing_whose_views_contradict_each_other_is_where_it_was_known_to_be() -> None:
    run = run_with(known())
    assert run.locating is not None
    run.locating = None
    there = run.thing()
    assert there.point_in_world == pytest.approx(known().place.point_in_world)
    assert isinstance(there.size, ThingSize)
    with pytest.raises(NotKnown):
        nothing = run_with(None)
        nothing.locating = None
        nothing.thing()
