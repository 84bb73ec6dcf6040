"""Regions of a normal distribution."""

import math

import numpy as np
import pytest

from tapreach.errors import InputError
from tapreach.geometry.gaussian import chi2_limit, confidence_ellipse, require_covariance, squared_mahalanobis


def test_ellipse_of_an_elongated_distribution_points_along_it():
    c, s = math.cos(0.4), math.sin(0.4)
    rotation = np.array([[c, -s], [s, c]])
    ellipse = confidence_ellipse(rotation @ np.diag([9.0, 1.0]) @ rotation.T)
    assert ellipse.angle == pytest.approx(0.4)
    np.testing.assert_allclose(ellipse.half_axes, np.sqrt(5.991) * np.array([3.0, 1.0]), rtol=1e-3)


def test_region_holds_its_share_of_samples():
    rng = np.random.default_rng(1)
    root = rng.normal(size=(3, 3))
    covariance = root @ root.T
    samples = rng.normal(size=(4000, 3)) @ root.T
    inside = [squared_mahalanobis(sample, covariance) < chi2_limit(0.95, 3) for sample in samples]
    assert 0.94 < np.mean(inside) < 0.96


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        ([[1.0, 0.5], [0.0, 1.0]], "not symmetric"),
        ([[1.0, 2.0], [2.0, 1.0]], "eigenvalue"),
        ([[1.0]], "shape"),
    ],
)
def test_matrix_that_is_no_covariance_is_refused(bad, message):
    with pytest.raises(InputError, match=message):
        require_covariance("tap covariance", bad, 2)
