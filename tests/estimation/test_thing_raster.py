"""The upright raster: homographies against projecting the points themselves."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import RigidTransform, Rotation

from tapreach.estimation.thing_raster import PlacedView, UprightRaster
from tapreach.geometry.camera import Camera
from tapreach.geometry.pixel import ImageSize
from tapreach.geometry.pose import camera_mount

CAMERA = Camera(ImageSize(640, 480), 533.0, 540.0, 315.0, 243.0)
POINT = np.array([0.7, 0.1, 0.06])
BEHIND_OF = {"plane": 1.0, "nearer": 0.8, "farther": 1.7}


def view(x: float, y: float, heading: float) -> PlacedView:
    base = RigidTransform.from_components([x, y, 0.0], Rotation.from_euler("z", heading))
    pose = base * camera_mount((0.1, 0.01, 0.15), pitch=0.2, yaw=0.03, roll=-0.02)
    return PlacedView(CAMERA, pose, CAMERA.project(pose.inv().apply(POINT[None])).pixels[0])


REFERENCE, OTHER = view(0.0, 0.02, 0.15), view(0.12, -0.1, 0.35)


def raster() -> UprightRaster:
    made = UprightRaster.facing(REFERENCE, POINT)
    assert made is not None
    return made


def way_to(made: UprightRaster, row: int, column: int) -> np.ndarray:
    place = made.point + made.leftwards(column) * made.left
    place[2] = made.height_of(row)
    return place - made.origin


def mapped(homography: np.ndarray, row: int, column: int) -> np.ndarray:
    u, v, scale = homography @ np.array([column, row, 1.0])
    assert scale > 0.0
    return np.array([u, v]) / scale


@pytest.mark.parametrize("share", BEHIND_OF.values(), ids=BEHIND_OF.keys())
@pytest.mark.parametrize("cell", [(20, 31), (150, 170)])
def test_plane_falls_where_its_points_do(share: float, cell: tuple[int, int]) -> None:
    made = raster()
    there = made.origin + share * way_to(made, *cell)
    pixel = CAMERA.project(OTHER.world_from_camera.inv().apply(there[None])).pixels[0]
    assert_allclose(mapped(made.to_plane(OTHER, share), *cell), pixel, atol=1e-6)


def test_floor_falls_where_its_points_do() -> None:
    made = raster()
    row, column = made.row_at(0.04), 120
    way = way_to(made, row, column)
    share = made.floor_shares()[row, column]
    there = made.origin + share * way
    assert abs(there[2]) < 1e-9
    pixel = CAMERA.project(OTHER.world_from_camera.inv().apply(there[None])).pixels[0]
    assert_allclose(mapped(made.to_floor(OTHER), row, column), pixel, atol=1e-6)


def test_point_falls_on_where_it_was_followed_to() -> None:
    made = raster()
    slipped = PlacedView(CAMERA, OTHER.world_from_camera, np.add(OTHER.pixel, [3.0, -2.0]))
    seen = mapped(made.to_plane(slipped, 1.0), made.row, made.column)
    assert_allclose(seen, slipped.pixel, atol=1e-6)


def test_no_line_of_sight_above_the_horizon_meets_the_floor() -> None:
    made = raster()
    shares = made.floor_shares()
    assert np.all(np.isinf(shares[: made.row_at(float(made.origin[2]) + 0.01)]))
    assert shares[made.row_at(0.0), 10] == pytest.approx(1.0, abs=0.05)


def test_thing_right_before_the_camera_has_no_raster() -> None:
    close = REFERENCE.world_from_camera.translation + np.array([0.05, 0.0, 0.0])
    assert UprightRaster.facing(REFERENCE, close) is None
