"""Projection, its derivative, and the way back through the lens."""

import math

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.errors import InputError
from tapreach.geometry.camera import Camera
from tapreach.geometry.pixel import ImageSize

VGA = ImageSize(640, 480)
PLAIN = Camera(VGA, 600.0, 590.0, 321.0, 238.0)
BARREL = Camera(VGA, 520.0, 525.0, 318.0, 244.0, (-0.28, 0.09, 0.001, -0.0007, -0.01))

coordinates = st.floats(-0.5, 0.5)
points_in_view = st.tuples(coordinates, coordinates, st.floats(0.3, 20.0)).map(
    lambda p: np.array([[p[0] * p[2], p[1] * p[2] * 0.75, p[2]]])
)


def grid_of_pixels():
    u, v = np.meshgrid(np.linspace(-0.5, 639.5, 17), np.linspace(-0.5, 479.5, 13))
    return np.stack([u.ravel(), v.ravel()], axis=1)


@pytest.mark.parametrize("camera", [PLAIN, BARREL])
@given(points=points_in_view)
def test_project_agrees_with_opencv(camera, points):
    expected, _ = cv2.projectPoints(
        points, np.zeros(3), np.zeros(3), camera.matrix(), np.array(camera.distortion)
    )
    np.testing.assert_allclose(camera.project(points).pixels, expected[:, 0], atol=1e-8)


@pytest.mark.parametrize("camera", [PLAIN, BARREL])
def test_unproject_inverts_project_over_the_whole_picture(camera):
    directions = camera.unproject(grid_of_pixels())
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1.0, atol=1e-14)
    np.testing.assert_allclose(camera.project(3.7 * directions).pixels, grid_of_pixels(), atol=1e-9)


def test_unproject_agrees_with_opencv():
    pixels = grid_of_pixels()
    stop = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 200, 1e-14)
    expected = cv2.undistortPointsIter(
        pixels, BARREL.matrix(), np.array(BARREL.distortion), np.eye(3), np.eye(3), stop
    )
    np.testing.assert_allclose(BARREL.normalise(pixels), expected[:, 0], atol=1e-9)


@pytest.mark.parametrize("camera", [PLAIN, BARREL])
@given(points=points_in_view)
def test_jacobian_agrees_with_finite_differences(camera, points):
    _, jacobian = camera.project_with_jacobian(points)
    step = 1e-6 * points[0, 2]
    for axis in range(3):
        shift = np.eye(3)[axis] * step
        change = camera.project(points + shift).pixels - camera.project(points - shift).pixels
        np.testing.assert_allclose(jacobian[0, :, axis], change[0] / (2 * step), rtol=1e-5, atol=1e-4)


@pytest.mark.parametrize("point", [(0.1, 0.2, -1.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (3.0, 1.0, 1e-12)])
def test_point_behind_or_beside_the_camera_is_marked_and_stays_finite(point):
    projection, jacobian = PLAIN.project_with_jacobian([point, (0.0, 0.0, 1.0)])
    assert projection.is_valid.tolist() == [False, True]
    assert projection.is_inside.tolist() == [False, True]
    assert np.all(np.isfinite(projection.pixels))
    assert np.all(jacobian[0] == 0.0)


def test_point_beyond_the_fold_of_the_lens_is_not_taken_for_a_visible_one():
    folding = Camera(VGA, 400.0, 400.0, 319.5, 239.5, (-0.4, 0.0, 0.0, 0.0, 0.0))
    projection = folding.project([(1.5, 0.0, 1.0)])
    assert not projection.is_valid[0]


def test_pixel_that_the_lens_cannot_image_is_refused_by_name():
    folding = Camera(VGA, 200.0, 200.0, 319.5, 239.5, (-0.4, 0.0, 0.0, 0.0, 0.0))
    with pytest.raises(InputError, match=r"pixel \(639\.0, 0\.0\) has no ray"):
        folding.unproject([(639.0, 0.0)])


def test_inside_the_picture_ends_at_the_edges_of_the_outer_pixels():
    camera = Camera(VGA, 600.0, 600.0, 319.5, 239.5)
    depth = 600.0
    at_edge = [(639.5 - 319.5, 0.0, depth), (639.6 - 319.5, 0.0, depth)]
    assert camera.project(at_edge).is_inside.tolist() == [True, False]


@given(st.floats(0.1, 4.0), points_in_view)
def test_scaled_camera_sees_the_corners_of_the_picture_in_the_same_places(factor, points):
    size = ImageSize(round(640 * factor), round(480 * factor))
    large, small = BARREL.scaled(size).project(points), BARREL.project(points)
    ratio = np.array([size.width / 640, size.height / 480])
    np.testing.assert_allclose(large.pixels + 0.5, (small.pixels + 0.5) * ratio, atol=1e-8)


def test_from_fov_puts_the_edge_of_the_view_on_the_edge_of_the_picture():
    camera = Camera.from_fov(VGA, math.radians(60.0))
    edge = camera.project([(math.tan(math.radians(30.0)), 0.0, 1.0)])
    assert edge.pixels[0, 0] == pytest.approx(639.5)


@pytest.mark.parametrize("bad", [0.0, -600.0, float("nan"), float("inf")])
def test_focal_length_that_cannot_be_is_refused(bad):
    with pytest.raises(InputError, match="camera fx"):
        Camera(VGA, bad, 600.0, 320.0, 240.0)


def test_distortion_of_the_wrong_length_is_refused():
    with pytest.raises(InputError, match=r"camera distortion has shape \(4,\)"):
        Camera(VGA, 600.0, 600.0, 320.0, 240.0, (0.0, 0.0, 0.0, 0.0))  # type: ignore[arg-type]
