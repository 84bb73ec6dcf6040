import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.bench.figure import Figure, at_least, at_most, exactly, plain, within


@pytest.mark.parametrize(
    ("limit", "value", "holds"),
    [
        (at_most(1.5), 1.5, True),
        (at_most(1.5), 1.51, False),
        (at_least(25), 25, True),
        (at_least(25), 24.9, False),
        (exactly(0), 0, True),
        (exactly(0), 1, False),
    ],
)
def test_figure_is_held_to_its_limit(limit, value, holds):
    assert Figure("age", value, "ms", limit).holds is holds


def test_figure_without_limit_has_no_verdict():
    assert Figure("rate", 30.0, "Hz").holds is None


def test_figure_that_was_not_measured_does_not_hold():
    figure = Figure("age", None, "ms", at_most(5), note="no browser")
    assert figure.holds is False
    assert figure.shown == "—"


def test_wanted_names_limit_and_unit():
    assert Figure("age", 1.0, "ms", at_most(2.5)).wanted == "≤ 2.50 ms"


@given(st.floats(-1e6, 1e6))
def test_plain_number_stays_near_the_value(value):
    assert abs(float(plain(value)) - value) <= max(0.0006, abs(value) * 0.01)
    assert "e" not in plain(value)


def test_band_holds_between_its_ends():
    figure = Figure("share", 95.0, "%", within(94.0, 96.0))
    assert figure.holds and figure.wanted == "94 to 96 %"
    assert not Figure("share", 93.9, "%", within(94.0, 96.0)).holds
    assert not Figure("share", 96.1, "%", within(94.0, 96.0)).holds
