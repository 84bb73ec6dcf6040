"""The rotations of the inner loop against scipy, and against the Jacobian of the geometry package."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tapreach.estimation.small_rotations import backward_rotations
from tapreach.geometry.pose import right_jacobians


@pytest.mark.parametrize("largest", [0.0, 1e-9, 0.01, 0.28, 3.0])
def test_rotations_and_jacobians_agree_with_the_general_ones(largest):
    turns = largest * np.random.default_rng(0).uniform(-1.0, 1.0, size=(4, 5, 3))
    back, slopes = backward_rotations(turns)
    expected = Rotation.from_rotvec(-turns.reshape(-1, 3)).as_matrix()
    np.testing.assert_allclose(back.reshape(-1, 3, 3), expected, atol=1e-14)
    np.testing.assert_allclose(slopes.reshape(-1, 3, 3), right_jacobians(turns.reshape(-1, 3)), atol=1e-9)
