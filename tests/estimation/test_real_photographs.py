"""Two real photographs with known camera motion and depth measured by structured light.

Scharstein et al., "High-resolution stereo datasets with subpixel-accurate ground truth", GCPR 2014
(Middlebury 2014, "Motorcycle"). The pictures are not part of the project; the test needs them in
../shared/real.
"""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform

from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.observation import Observation
from tapreach.estimation.point_estimate import Status
from tapreach.geometry.camera import Camera
from tapreach.geometry.pixel import ImageSize, Pixel
from tapreach.geometry.pose import pose_from_matrix

DATA = Path(__file__).resolve().parents[3] / "shared" / "real" / "motorcycle.json"


@pytest.mark.skipif(not DATA.exists(), reason="the photographs are not beside this checkout")
def test_motorcycle_is_located_to_a_fraction_of_a_percent():
    data = json.loads(DATA.read_text())
    cameras = [
        Camera(ImageSize(741, 497), k[0][0], k[1][1], k[0][2], k[1][2], tuple(d))
        for k, d in zip(data["intrinsics"], data["distortion"], strict=True)
    ]
    poses = [pose_from_matrix(matrix) for matrix in data["world_from_camera"]]
    relative_errors, inside = [], []
    for each in data["points"]:
        views = [
            Observation(Pixel(*pixel), data["pixel_sigma_px"], camera, pose, RigidTransform.identity())
            for pixel, camera, pose in zip(each["pixels"], cameras, poses, strict=True)
        ]
        estimate = estimate_point(views, with_advice=False)
        assert estimate.status is Status.DETERMINED, estimate.reason
        truth = np.array(each["truth_point_in_world_m"])
        error = estimate.point_in_world - truth
        relative_errors.append(np.linalg.norm(error) / np.linalg.norm(truth))
        # The truth has an error of its own along the depth.
        sd = np.hypot(np.sqrt(estimate.point_cov_in_world[2, 2]), each["truth_sd_m"])
        inside.append(abs(error[2]) < 1.96 * sd)
    assert len(relative_errors) == 120
    assert np.median(relative_errors) < 0.002
    assert np.mean(inside) > 0.85
