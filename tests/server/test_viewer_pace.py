"""Frames in flight and quality, against links of every kind, simulated."""

from dataclasses import dataclass

from hypothesis import given, settings
from hypothesis import strategies as st

from tapreach.robot.clock import MS, SECOND
from tapreach.server.frame_packet import LADDER
from tapreach.server.viewer_pace import ViewerPace

INTERVAL_NS = 33 * MS
SIZES = (44_000, 18_000, 6_000)
"""Bytes of a frame at each quality."""


@dataclass
class Outcome:
    level: int
    rate_hz: float
    worst_age_ms: float


def watched(bytes_per_s: float, round_trip_ms: float, seconds: float) -> Outcome:
    """Watch a 30 Hz camera over a link that sends one byte after the other; figures of the last third."""
    pace = ViewerPace(INTERVAL_NS)
    pace.measured_round_trip(round(round_trip_ms * MS))
    end_ns, now_ns, frame, link_free_ns, flying = round(seconds * SECOND), 0, 0, 0, []
    last_sent, delivered, ages = 0, 0, [0.0]
    while now_ns < end_ns:
        now_ns += MS
        for item in [item for item in flying if item[1] <= now_ns]:
            flying.remove(item)
            pace.acknowledged(item[0], now_ns)
            if now_ns > end_ns * 2 // 3:
                delivered += 1
                ages.append((now_ns - item[0] * INTERVAL_NS) / MS)
        frame = now_ns // INTERVAL_NS
        if frame > last_sent and pace.is_open:
            last_sent = frame
            pace.sent(frame, now_ns)
            serial_ns = round(SIZES[pace.level] / bytes_per_s * SECOND)
            link_free_ns = max(now_ns, link_free_ns) + serial_ns
            flying.append((frame, link_free_ns + round(round_trip_ms * MS)))
    return Outcome(pace.level, delivered / (seconds / 3), max(ages))


def test_fast_link_keeps_the_cameras_own_picture():
    outcome = watched(100e6, 0.5, 6)
    assert outcome.level == 0
    assert outcome.rate_hz > 29


def test_six_megabit_per_second_gives_up_quality_and_keeps_the_rate():
    outcome = watched(6e6 / 8, 1.0, 6)
    assert outcome.level > 0
    assert outcome.rate_hz >= 25


def test_far_but_wide_link_keeps_quality_and_has_two_frames_in_flight():
    outcome = watched(100e6, 60.0, 6)
    assert outcome.level == 0
    assert outcome.rate_hz >= 25


@settings(deadline=None, max_examples=15)
@given(st.floats(20e3, 1e8), st.floats(0.1, 15.0))
def test_age_does_not_grow_on_any_link(bytes_per_s, round_trip_ms):
    outcome = watched(bytes_per_s, round_trip_ms, 9)
    serial_ms = SIZES[outcome.level] / bytes_per_s * 1000
    largest_serial_ms = SIZES[max(0, outcome.level - 1)] / bytes_per_s * 1000
    assert outcome.worst_age_ms <= 34 + round_trip_ms + max(serial_ms, largest_serial_ms) + 2


def test_link_that_becomes_wide_again_gets_the_full_picture_back():
    pace = ViewerPace(INTERVAL_NS)
    frame, now_ns = 0, 0
    for transfer_ms, seconds in ((80, 2), (3, 10)):
        for _ in range(seconds * 1000 // max(transfer_ms, 33)):
            frame += 1
            pace.sent(frame, now_ns)
            pace.acknowledged(frame, now_ns + transfer_ms * MS)
            now_ns += max(transfer_ms, 33) * MS
        if transfer_ms == 80:
            assert pace.level == len(LADDER) - 1
    assert pace.level == 0


def test_viewer_that_never_answers_gets_one_frame():
    pace = ViewerPace(INTERVAL_NS)
    assert pace.is_open
    pace.sent(1, 0)
    assert not pace.is_open
    pace.acknowledged(99, SECOND)
    assert not pace.is_open


def test_answer_to_a_newer_frame_covers_the_older_ones():
    pace = ViewerPace(INTERVAL_NS)
    pace.measured_round_trip(60 * MS)
    pace.sent(1, 0)
    pace.sent(2, 33 * MS)
    assert not pace.is_open
    pace.acknowledged(2, 100 * MS)
    assert pace.is_open
