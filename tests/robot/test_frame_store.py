"""Frames by id: there, gone, or never seen, and always in bounds."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.errors import FrameExpired, FrameUnknown
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.clock import SECOND
from tapreach.robot.frame_store import FrameStore
from tapreach.robot.messages import Frame

SIZE = ImageSize(640, 480)


def frame(frame_id: int, captured_ns: int = 0, length: int = 10) -> Frame:
    return Frame(frame_id, captured_ns, captured_ns, SIZE, b"x" * length)


def test_stored_frame_is_found_and_the_newest_is_known():
    store = FrameStore()
    assert store.newest is None
    store.add(frame(1))
    store.add(frame(4))
    assert store.get(1).frame_id == 1
    assert store.newest.frame_id == 4


def test_frame_that_has_become_too_old_is_expired_and_the_oldest_is_named():
    store = FrameStore(keep_ns=10 * SECOND)
    for number in range(1, 21):
        store.add(frame(number, number * SECOND))
    with pytest.raises(FrameExpired, match=r"picture 5 .*the oldest is 10"):
        store.get(5)
    assert store.get(10).frame_id == 10


@pytest.mark.parametrize("frame_id", [0, -1, 3, 10**12])
def test_frame_that_never_was_is_unknown(frame_id):
    store = FrameStore()
    store.add(frame(2))
    with pytest.raises(FrameUnknown, match=f"no picture {frame_id} "):
        store.get(frame_id)


def test_frame_that_was_dropped_on_the_way_is_not_found():
    store = FrameStore()
    store.add(frame(1))
    store.add(frame(3))
    with pytest.raises(FrameExpired):
        store.get(2)


@given(st.lists(st.tuples(st.integers(1, 5), st.integers(0, 3 * SECOND), st.integers(1, 400)), max_size=60))
def test_store_never_exceeds_its_bounds_and_always_keeps_the_newest(steps):
    store, frame_id, now_ns = FrameStore(keep_ns=10 * SECOND, max_bytes=1000), 0, 0
    for skipped, later_ns, length in steps:
        frame_id += skipped
        now_ns += later_ns
        store.add(frame(frame_id, now_ns, length))
        kept = store.since(0)
        assert kept[-1].frame_id == frame_id == store.newest.frame_id
        assert sum(len(each.jpeg) for each in kept) <= 1000
        assert all(each.captured_ns >= now_ns - 10 * SECOND for each in kept)
        assert [each.frame_id for each in kept] == sorted(each.frame_id for each in kept)


def test_frames_since_one_are_the_newer_ones():
    store = FrameStore()
    for number in (1, 2, 5):
        store.add(frame(number))
    assert [each.frame_id for each in store.since(1)] == [2, 5]
    assert store.since(5) == []
