import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.bench.sample import median, percentile, slope
from tapreach.errors import InputError


def test_median_and_percentile_of_known_values():
    assert median([3.0, 1.0, 2.0]) == 2.0
    assert percentile(list(range(101)), 95) == 95.0


@given(st.floats(-10, 10), st.floats(-100, 100))
def test_slope_of_a_line_is_its_slope(steepness, start):
    times = [0.0, 1.0, 2.5, 4.0]
    assert slope(times, [start + steepness * t for t in times]) == pytest.approx(steepness, abs=1e-9)


def test_nothing_measured_is_an_error_that_says_so():
    with pytest.raises(InputError, match="nothing was measured"):
        median([])
    with pytest.raises(InputError, match="two different times"):
        slope([1.0, 1.0], [2.0, 3.0])
