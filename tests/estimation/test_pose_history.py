"""Asking for poses of the past."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.errors import InputError, PoseExpired, PoseNotYetKnown
from tapreach.estimation.pose_history import PoseHistory
from tapreach.geometry.planar_motion import PlanarPose

MS = 1_000_000


def history_of_an_arc(count=11, capacity=100):
    history = PoseHistory(capacity)
    for i in range(count):
        history.add(i * 20 * MS, PlanarPose(1.0, 2.0, 3.0).after_arc(0.05 * i, 0.1 * i))
    return history


@given(st.integers(0, 200 * MS))
def test_pose_between_two_samples_lies_on_the_arc_driven(captured_ns):
    pose = history_of_an_arc().at(captured_ns)
    share = captured_ns / (20 * MS)
    expected = PlanarPose(1.0, 2.0, 3.0).after_arc(0.05 * share, 0.1 * share)
    assert (pose.x, pose.y, pose.heading) == pytest.approx((expected.x, expected.y, expected.heading))


@given(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1.5, 1.5), st.floats(0.0, 1.0))
def test_way_to_a_pose_can_be_cut_anywhere(x, y, heading, fraction):
    start, end = PlanarPose(0.5, 0.1, 0.2), PlanarPose(x, y, heading)
    half_way = start.towards(end, fraction / 2)
    again = start.towards(start.towards(end, fraction), 0.5)
    whole = start.towards(end, 1.0)
    for first, second in ((half_way, again), (whole, end)):
        assert (first.x, first.y, first.heading) == pytest.approx(
            (second.x, second.y, second.heading), abs=1e-9
        )


def test_heading_is_interpolated_across_a_full_turn():
    history = PoseHistory()
    history.add(0, PlanarPose(heading=math.pi - 0.1))
    history.add(10, PlanarPose(heading=math.pi + 0.1))
    assert history.at(5).heading == pytest.approx(math.pi)


def test_time_after_the_newest_pose_is_not_guessed():
    with pytest.raises(PoseNotYetKnown, match=r"lies 5\.0 ms after the newest"):
        history_of_an_arc().at(205 * MS)


def test_time_before_the_oldest_kept_pose_is_too_old():
    with pytest.raises(PoseExpired, match=r"lies 100\.0 ms before the oldest"):
        history_of_an_arc(11, capacity=5).at(20 * MS)


def test_empty_history_knows_no_pose():
    with pytest.raises(PoseNotYetKnown, match="no pose"):
        PoseHistory().at(0)


def test_memory_is_bounded():
    assert len(history_of_an_arc(1000, capacity=10)) == 10


def test_pose_that_is_not_after_the_newest_is_refused():
    history = history_of_an_arc()
    with pytest.raises(InputError, match="not after the newest"):
        history.add(200 * MS, PlanarPose())


def test_history_for_less_than_two_poses_is_refused():
    with pytest.raises(InputError, match="capacity is 1"):
        PoseHistory(1)


def test_poses_since_a_time_are_those_recorded_at_it_and_after():
    history = PoseHistory()
    for step in range(10):
        history.add(step * 20 * MS, PlanarPose(0.1 * step, 0.0, 0.0))
    assert [at_ns for at_ns, _ in history.since(130 * MS)] == [140 * MS, 160 * MS, 180 * MS]
    assert history.since(140 * MS) == history.since(130 * MS)
    assert history.since(181 * MS) == []
    assert len(history.since(0)) == 10
