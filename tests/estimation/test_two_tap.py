"""The paper's closed form: its geometry, its figures, and its named refusals."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tapreach.errors import InputError
from tapreach.estimation.paper_tables import TABLE_1, TABLE_2
from tapreach.estimation.two_tap import ScreenOffset, TwoTapStatus, two_tap
from tapreach.geometry.planar_motion import PlanarStep

FOCAL = 1170.0
STEP = PlanarStep(math.radians(12.0), 0.2)


def taps(x, y, z, step):
    """Return where a target X right, Y up, Z ahead of the first view is tapped in both."""
    c, s = math.cos(step.turn), math.sin(step.turn)
    right, ahead = x * c + z * s, z * c - x * s - step.advance
    return ScreenOffset(FOCAL * x / z, FOCAL * y / z), ScreenOffset(FOCAL * right / ahead, FOCAL * y / ahead)


@given(
    st.floats(-0.3, 0.3),
    st.floats(-0.5, 0.5),
    st.floats(0.4, 6.0),
    st.floats(0.05, 0.5),
    st.floats(0.05, 0.5),
)
def test_position_is_recovered_in_both_frames(x, y, z, turn, advance):
    step = PlanarStep(turn, advance)
    assume(abs(math.atan2(x, z) + turn) > 0.01)
    assume(z * math.cos(turn) - x * math.sin(turn) > advance + 0.05)
    first, second = taps(x, y, z, step)
    position = two_tap(first, second, FOCAL, step).position
    assert position is not None
    np.testing.assert_allclose(position.in_first, [x, y, z], atol=1e-7)
    c, s = math.cos(turn), math.sin(turn)
    np.testing.assert_allclose(position.in_second, [x * c + z * s, y, z * c - x * s - advance], atol=1e-7)
    assert position.height_difference == pytest.approx(0.0, abs=1e-7)


def test_centred_target_follows_the_paper_step_by_step():
    first, second = taps(0.0, -0.1, 1.5, STEP)
    estimate = two_tap(first, second, FOCAL, STEP)
    beta = math.atan(second.x / FOCAL)
    phi = math.pi / 2 - beta + STEP.turn
    along = STEP.advance * math.cos(STEP.turn) + STEP.advance * math.sin(STEP.turn) * math.tan(phi)
    assert estimate.position is not None
    assert (estimate.beta, estimate.phi) == pytest.approx((beta, phi))
    assert estimate.position.distance == pytest.approx(along)


def test_height_check_shows_taps_on_different_things():
    first, second = taps(0.0, -0.1, 1.0, STEP)
    position = two_tap(first, ScreenOffset(second.x, second.y + 20.0), FOCAL, STEP).position
    assert position is not None
    assert position.height_difference == pytest.approx(20.0 / FOCAL * position.in_second[2])


@given(st.floats(0.5, 4.0))
def test_sensitivity_is_the_slope_of_the_distance(depth):
    first, second = taps(0.0, 0.0, depth, STEP)
    shifted = [two_tap(first, ScreenOffset(second.x + dx, 0.0), FOCAL, STEP).position for dx in (-1e-3, 1e-3)]
    position = two_tap(first, second, FOCAL, STEP).position
    assert position is not None
    slope = (shifted[1].distance - shifted[0].distance) / 2e-3
    assert position.distance_per_unit == pytest.approx(slope, rel=1e-5)


@pytest.mark.parametrize("row", TABLE_2)
def test_table_2_comes_out_as_published_with_w_rounded(row):
    assert round(row.distance_cm, 2) == row.published_cm
    assert round(row.beta_deg, 2) == row.published_beta_deg
    assert round(row.phi_deg, 2) == row.published_phi_deg


def test_table_2_with_w_unrounded_deviates_as_noted():
    assert [round(row.distance_unrounded_cm, 2) for row in TABLE_2] == [51.22, 259.75]


def test_table_1_comes_out_as_published_but_for_its_last_row():
    computed = [round(row.focal_cm, 2) for row in TABLE_1]
    assert computed == [*(row.published_focal_cm for row in TABLE_1[:3]), 24.24]
    assert TABLE_1[-1].published_focal_cm == 24.27


OFF_AXIS = ScreenOffset(400.0, 0.0)


@pytest.mark.parametrize(
    ("second", "step", "status"),
    [
        (ScreenOffset(FOCAL * math.tan(STEP.turn), 0.0), STEP, TwoTapStatus.AT_INFINITY_OR_BEHIND),
        (ScreenOffset(100.0, 0.0), STEP, TwoTapStatus.AT_INFINITY_OR_BEHIND),
        (OFF_AXIS, PlanarStep(0.2, 0.0), TwoTapStatus.ZERO_ADVANCE),
        (ScreenOffset(0.0, 0.0), PlanarStep(0.0, 0.2), TwoTapStatus.NO_PARALLAX),
        (OFF_AXIS, PlanarStep(0.0, 0.2), TwoTapStatus.NO_PARALLAX),
        (OFF_AXIS, PlanarStep(-0.2, 0.2), TwoTapStatus.TARGET_BEHIND),
    ],
)
def test_taps_without_an_answer_say_why(second, step, status):
    estimate = two_tap(ScreenOffset(0.0, 0.0), second, FOCAL, step)
    assert (estimate.status, estimate.position) == (status, None)
    assert len(estimate.reason) > 20


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_tap_that_is_no_number_is_refused(bad):
    with pytest.raises(InputError, match="tap x"):
        ScreenOffset(bad, 0.0)


@given(st.floats(-1e4, 1e4), st.floats(-1e4, 1e4), st.floats(-3.2, 3.2), st.floats(-2.0, 2.0))
def test_any_taps_give_a_position_ahead_or_a_reason(first_x, second_x, turn, advance):
    estimate = two_tap(
        ScreenOffset(first_x, 5.0), ScreenOffset(second_x, 5.0), FOCAL, PlanarStep(turn, advance)
    )
    if estimate.position is not None:
        assert np.all(np.isfinite([*estimate.position.in_first, *estimate.position.in_second]))
        assert estimate.position.in_first[2] > 0.0
        assert estimate.position.in_second[2] > -1e-9
