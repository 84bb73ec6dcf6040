"""Width and height by a box in one picture: near the truth where little is unknown, honest where depth is."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import RigidTransform

from estimation.things import packet, random_thing
from tapreach.errors import InputError
from tapreach.estimation.box_extent import BoxExtent, NoExtent, box_extent
from tapreach.geometry.camera import Camera
from tapreach.geometry.pixel import ImageSize
from tapreach.geometry.pixel_box import LEAST_SIDE_PX, PixelBox
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.geometry.pose import camera_mount

CAMERA = Camera.from_fov(ImageSize(640, 480), math.radians(62.0))
MOUNT = camera_mount([0.1, 0.0, 0.15], pitch=math.radians(11.0))
EXACT = np.zeros((3, 3))


def pose_at(x: float, y: float, heading: float) -> RigidTransform:
    """world_from_camera of a robot on the floor."""
    return PlanarPose(x, y, heading).to_rigid() * MOUNT


def card_before(pose: RigidTransform, distance: float) -> tuple[PixelBox, NDArray[np.float64]]:
    """The box around a thin upright card of 12 cm by 20 cm straight ahead, and the card's middle."""
    ahead = pose.rotation.apply([0.0, 0.0, 1.0])
    foot = pose.translation[:2] + distance * ahead[:2] / np.hypot(ahead[0], ahead[1])
    card = packet(foot, (1e-6, 0.12, 0.20), math.atan2(ahead[1], ahead[0]))
    return card.box(CAMERA, pose), np.array([*foot, 0.1])


def measured(box: PixelBox, pose: RigidTransform, point: NDArray[np.float64], cov=EXACT) -> BoxExtent:
    found = box_extent(box, CAMERA, pose, point, cov)
    assert isinstance(found, BoxExtent), found
    return found


def test_card_has_its_size_up_to_the_depth_that_is_not_known() -> None:
    pose = pose_at(0.4, -0.7, 1.9)
    box, point = card_before(pose, 1.0)
    extent = measured(box, pose, point)
    assert extent.width == pytest.approx(0.12, rel=0.06)
    assert extent.height == pytest.approx(0.20, rel=0.05)


def test_corners_fall_on_the_drawn_box_again() -> None:
    pose = pose_at(0.4, -0.7, 1.9)
    box, point = card_before(pose, 0.8)
    corners = measured(box, pose, point).corners_in_world
    pixels = CAMERA.project(pose.inv().apply(corners)).pixels
    drawn = [(box.left, box.top), (box.right, box.top), (box.right, box.bottom), (box.left, box.bottom)]
    assert pixels == pytest.approx(np.array(drawn), abs=4.0)
    ahead = (point - pose.translation) * [1.0, 1.0, 0.0]
    assert (corners - point) @ ahead == pytest.approx(np.zeros(4), abs=1e-9)


def test_size_does_not_depend_on_where_the_world_begins() -> None:
    here, there = pose_at(0.0, 0.0, 0.0), pose_at(2.0, 1.0, -2.5)
    sizes = [measured(*swapped(card_before(pose, 0.9), pose)) for pose in (here, there)]
    assert sizes[0].width == pytest.approx(sizes[1].width)
    assert sizes[0].height_sd == pytest.approx(sizes[1].height_sd)


def swapped(found: tuple[PixelBox, NDArray[np.float64]], pose: RigidTransform):
    return found[0], pose, found[1]


def test_error_grows_with_that_of_the_range_and_of_the_edges() -> None:
    pose = pose_at(0.0, 0.0, 0.0)
    box, point = card_before(pose, 1.0)
    sure, unsure = measured(box, pose, point), measured(box, pose, point, np.diag([0.2, 0.0, 0.0]) ** 2)
    assert unsure.width_sd == pytest.approx(math.hypot(sure.width_sd, 0.2 * 0.12), rel=0.02)
    rough = box_extent(box, CAMERA, pose, point, EXACT, edge_sigma=12.0)
    assert isinstance(rough, BoxExtent)
    assert rough.width_sd > 3.0 * sure.width_sd


def roughly(drawn: PixelBox, rng: np.random.Generator) -> PixelBox:
    """A hand's box, 3 px off at each edge; a stroke too small to be a box is drawn again."""
    while True:
        edges = np.array([drawn.left, drawn.top, drawn.right, drawn.bottom]) + rng.normal(0.0, 3.0, 4)
        if min(edges[2] - edges[0], edges[3] - edges[1]) >= LEAST_SIDE_PX:
            return PixelBox(*edges)


def test_stated_95_percent_hold_for_things_of_any_shape() -> None:
    """Tins, balls and packets however turned, drawn with 3 px at each edge, range known to 2 %."""
    rng = np.random.default_rng(np.random.SeedSequence().entropy)
    pose, misses, cases, within = pose_at(0.0, 0.0, 0.0), np.zeros(2), 300, np.zeros(2)
    for _ in range(cases):
        thing = random_thing(rng)
        drawn, front = thing.box(CAMERA, pose), thing.front(CAMERA, pose)
        edges = roughly(drawn, rng)
        way = front - pose.translation
        cov = 0.02**2 * np.outer(way, way)
        extent = measured(edges, pose, front + 0.02 * rng.normal() * way, cov)
        error = np.abs(np.array([extent.width, extent.height]) - thing.size(pose))
        misses += error > 1.96 * np.array([extent.width_sd, extent.height_sd])
        within += error / [extent.width_sd, extent.height_sd]
    # Of 300 at 95 %: 35 misses or more happen once in 10^5 runs.
    assert np.all(misses < 35), misses
    # And the sds are no excuse: the mean of |error| / sd is 0.80 where they are just right.
    assert np.all(within / cases > 0.5), within / cases


@pytest.mark.parametrize(
    ("box", "point", "reason"),
    [
        (PixelBox(300, 300, 340, 340), [0.1, 0.0, 0.0], "straight below"),
        (PixelBox(300, 300, 340, 340), [-1.0, 0.0, 0.1], "straight below"),
        (PixelBox(0, 300, 30, 340), [0.3, -1.5, 0.1], "more than 60"),
    ],
)
def test_place_where_no_plane_faces_the_camera_has_a_reason(
    box: PixelBox, point: list[float], reason: str
) -> None:
    found = box_extent(box, CAMERA, pose_at(0.0, 0.0, 0.0), point, EXACT)
    assert isinstance(found, NoExtent)
    assert reason in found.reason


def test_what_is_no_box_is_named() -> None:
    with pytest.raises(InputError, match=r"2\.0 px wide"):
        PixelBox(10.0, 10.0, 12.0, 40.0)
    with pytest.raises(InputError, match="box top is nan"):
        PixelBox(10.0, math.nan, 12.0, 40.0)
    with pytest.raises(InputError, match="must be at least"):
        PixelBox(700.0, 10.0, 800.0, 40.0).within(ImageSize(640, 480))


def test_box_over_the_edge_is_cut_to_the_picture() -> None:
    cut = PixelBox(-20.0, 10.0, 50.0, 900.0).within(ImageSize(640, 480))
    assert cut == PixelBox(-0.5, 10.0, 50.0, 479.5)
