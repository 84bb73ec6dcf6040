from hypothesis import given
from hypothesis import strategies as st

from tapreach.bench.drawn import Drawing, DrawnFrame, ages_ms
from tapreach.bench.painted import PaintedFrame, painted_ages_ms
from tapreach.bench.pattern import CODES
from tapreach.robot.clock import MS

PERIOD_NS = 33 * MS


@given(st.integers(1, 3 * CODES), st.integers(0, 16_000))
def test_age_of_a_drawn_code_counts_from_its_newest_frame(frame_id, late_ms):
    # Codes repeat after CODES frames, 16.9 s: a picture younger than that is told from its predecessor.
    captured_ns = {number: number * PERIOD_NS for number in range(1, 5 * CODES)}
    drawn_ns = captured_ns[frame_id] + late_ms * MS
    drawing = Drawing((DrawnFrame(frame_id % CODES, drawn_ns),), 0, 0.1)
    assert ages_ms(drawing, captured_ns) == [late_ms]


def test_picture_of_unknown_capture_time_is_left_out():
    drawing = Drawing((DrawnFrame(5, 100 * MS), DrawnFrame(6, 200 * MS)), 0, 0.1)
    assert ages_ms(drawing, {6: 150 * MS}) == [50]
    assert painted_ages_ms([PaintedFrame(5, 0), PaintedFrame(6, 190 * MS)], {6: 150 * MS}) == [40]


def test_rate_of_a_drawing_is_counted_between_first_and_last():
    frames = tuple(DrawnFrame(code, code * 100 * MS) for code in range(11))
    assert Drawing(frames, 0, 0.1).rate_hz == 10
