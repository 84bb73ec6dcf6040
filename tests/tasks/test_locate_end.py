"""Why a move or the whole of locating ends, and what is said then."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.estimation.point_estimate import PointEstimate
from tapreach.estimation.pose_history import PoseHistory
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.clock import MS, SECOND
from tapreach.tasks.free_way import way_behind
from tapreach.tasks.locate_end import End, closing_reason, closing_sentence, has_helped, is_worthwhile
from tapreach.tasks.locate_watch import LOST_NS, MoveWatch
from tapreach.tasks.move_choice import Choice
from tapreach.tasks.planned_move import PlannedMove, footprint, wheel_tracks
from tapreach.tasks.sighting import Sighting, observation_of, ray_of
from tapreach.tasks.target import Target, TargetSource
from tasks.rig import sim_description

ROBOT = sim_description()


def seen(x: float, u: float = 320.0, v: float = 240.0) -> Sighting:
    return Sighting(1, 1, Pixel(u, v), 0.5, 1.0, PlanarPose(x))


def estimated(distance: float) -> PointEstimate:
    point, views = np.array([distance, 0.15 * distance, 0.05]), []
    for pose in (PlanarPose(), PlanarPose(0.2, 0.0, 0.1)):
        camera = pose.to_rigid() * ROBOT.camera.mount.base_from_camera()
        u, v = ROBOT.camera.model().project(camera.inv().apply(point)[None]).pixels[0]
        views.append(observation_of(replace(seen(0.0, float(u), float(v)), world_from_base=pose), ROBOT))
    return estimate_point(views, OdometryNoise())


def watch(accuracy: float = 1e-9, nearest: float = 1.0, is_forward: bool = True) -> MoveWatch:
    return MoveWatch(ROBOT, accuracy, ray_of(seen(0.0), ROBOT), nearest, is_forward)


def test_move_goes_on_while_it_has_a_purpose() -> None:
    assert watch().reason_to_stop([seen(0.0), seen(0.1)], None, 0) == ""
    assert watch().reason_to_stop([seen(0.0)], estimated(1.0), LOST_NS - 1) == ""


def test_move_ends_when_the_wanted_accuracy_is_reached() -> None:
    estimate = estimated(1.0)
    assert "accuracy" in watch(1.01 * estimate.relative_sd).reason_to_stop([seen(0.0)], estimate, 0)
    assert watch(0.99 * estimate.relative_sd).reason_to_stop([seen(0.0)], estimate, 0) == ""


def test_move_ends_when_the_target_is_out_of_sight() -> None:
    assert "out of sight" in watch().reason_to_stop([seen(0.0)], None, LOST_NS)


def test_forward_move_ends_before_what_may_be_right_ahead() -> None:
    there = [seen(0.3), seen(0.35)]
    assert "right ahead" in watch(nearest=0.5).reason_to_stop(there, None, 0)
    assert watch(nearest=0.5, is_forward=False).reason_to_stop(there, None, 0) == ""
    assert watch(nearest=0.5).reason_to_stop(there, estimated(2.0), 0) == "", "the estimate knows better"
    assert "right ahead" in watch(nearest=5.0).reason_to_stop(there, estimated(0.6), 0)


@pytest.mark.parametrize(
    ("before", "now"),
    [((40.0, 240.0), (15.0, 240.0)), ((320.0, 440.0), (320.0, 470.0)), ((500.0, 240.0), (570.0, 240.0))],
)
def test_move_ends_before_the_target_leaves_the_picture(
    before: tuple[float, float], now: tuple[float, float]
) -> None:
    outwards, inwards = [seen(0.0, *before), seen(0.0, *now)], [seen(0.0, *now), seen(0.0, *before)]
    assert "leave the picture" in watch().reason_to_stop(outwards, None, 0)
    assert watch().reason_to_stop(inwards, None, 0) == ""


def choice(relative_sd: float) -> Choice:
    return Choice(PlanarStep(0.2, 0.3), relative_sd, 1.5, 0.0)


def test_further_moves_must_promise_and_keep() -> None:
    estimate = estimated(1.0)
    assert is_worthwhile(choice(0.9), None)
    assert is_worthwhile(choice(0.65 * estimate.relative_sd), estimate)
    assert not is_worthwhile(choice(0.9 * estimate.relative_sd), estimate)
    assert has_helped(None, estimate)
    assert has_helped(estimate, replace(estimate, relative_sd=0.8 * estimate.relative_sd))
    assert not has_helped(estimate, replace(estimate, relative_sd=0.95 * estimate.relative_sd))


@pytest.mark.parametrize(
    ("end", "words"),
    [
        (End.REACHED, ", 3 % was wanted"),
        (
            End.NO_GAIN,
            "; the 0.30 m left to drive would not help much",
        ),
        (End.WAY_USED_UP, "; the way it may drive is used up"),
        (End.NO_MOVE, "; no further move keeps it in the picture"),
        (End.LOST, "; lost on the way (it is hidden), from the views before"),
    ],
)
def test_closing_reason_says_how_well_and_why(end: End, words: str) -> None:
    assert closing_reason(0.02, end, 0.03, 0.3, "it is hidden") == f"range known to 2 %{words}"


def test_closing_sentence_tells_what_was_found_and_what_would_help() -> None:
    target = Target(
        1, TargetSource.LOCATE, "determined", "range known", "", 1, 0.0, 0.0, None, None, 1.234, (1.2, 1.3)
    )
    found = "1.23 m away (95 %: 1.20 to 1.30 m): range known"
    assert closing_sentence(target) == found
    assert closing_sentence(replace(target, advice="turn")) == f"{found}. Adviser: turn"


def test_planned_move_tells_its_way_and_what_it_expects() -> None:
    move = PlannedMove.of(choice(0.014), PlanarPose())
    assert move.in_words == "turning 11° left, then driving 0.30 m forward"
    assert (move.expected_sd, move.expected_relative_sd) == pytest.approx((0.021, 0.014))
    back = PlannedMove(PlanarPose(), PlanarStep(0.0, -0.1), 0.02, 0.01)
    assert back.in_words == "driving 0.10 m back"


def test_tracks_run_beside_the_way_and_the_body_stands_at_its_end() -> None:
    start = PlanarPose(1.0, 2.0, 0.7)
    move = PlannedMove(start, PlanarStep(0.3, 0.4), 0.02, 0.01)
    turned = start.after(PlanarStep(0.3, 0.0))
    for side, track in zip((1.0, -1.0), wheel_tracks(move, ROBOT), strict=True):
        ways = [turned.between(pose) for pose in track]
        assert [way.x for way in ways] == pytest.approx(np.linspace(0.0, 0.4, 7))
        assert all(side * way.y > ROBOT.base.track_width / 2 for way in ways)
    corners = [move.end.between(pose) for pose in footprint(move, ROBOT)]
    assert max(corner.x for corner in corners) > ROBOT.camera.mount.forward
    assert sum(corner.y for corner in corners) == pytest.approx(0.0, abs=1e-12)


def drove(poses: list[PlanarPose]) -> PoseHistory:
    history = PoseHistory()
    for i, pose in enumerate(poses):
        history.add(SECOND + 100 * MS * i, pose)
    return history


def test_way_behind_is_the_straight_way_it_came() -> None:
    straight = [PlanarPose(0.02 * i) for i in range(20)]
    assert way_behind(drove(straight)) == pytest.approx(0.38)
    assert way_behind(PoseHistory()) == 0.0
    assert way_behind(drove([PlanarPose()] * 5)) == 0.0


def test_way_behind_ends_where_it_turned_off_and_after_half_a_minute() -> None:
    came_from_the_side = [PlanarPose(0.0, 0.02 * i - 0.4, math.pi / 2) for i in range(20)]
    then_straight = [PlanarPose(0.02 * i) for i in range(10)]
    assert way_behind(drove(came_from_the_side + then_straight)) == pytest.approx(0.18, abs=0.03)
    long_ago = [PlanarPose(0.02 * i) for i in range(20)] + [PlanarPose(0.38)] * 400
    assert way_behind(drove(long_ago)) == 0.0


def test_backing_off_first_has_what_lies_ahead_on_the_way_not_behind() -> None:
    backed = [PlanarPose(-0.02 * i) for i in range(20)]
    assert way_behind(drove(backed)) == 0.0
