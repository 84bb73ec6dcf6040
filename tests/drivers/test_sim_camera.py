import math
from collections.abc import Iterator, Mapping
from typing import Any

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from sim_world import ROBOT, Rig, camera_in_world

from tapreach.drivers.sim.camera import ShadowPolicy, SimCamera, SimPicture, Snapshot, state_at
from tapreach.drivers.sim.renderer import Renderer
from tapreach.drivers.sim.scene import Scene, load_scene
from tapreach.robot.messages import ArmPose

MARKERS = {"near": (0.6, 0.1), "left": (1.1, 0.42), "right": (0.9, -0.12), "far": (2.4, -0.2)}


def marker_scene() -> Scene:
    """Cubes of 12 mm to 30 mm, some high up, on which a picture is easy to measure."""
    cubes = [
        {"kind": "box", "name": name, "position": at, "size": [0.012 * max(1.0, at[0])] * 3, "mass": 0.02}
        for name, at in MARKERS.items()
    ]
    room = {"x": (-2, 4), "y": (-2, 2), "floor": "plain", "wall": "plain", "skirting": False}
    return Scene.model_validate(
        {"title": "markers", "room": room, "light": {"shadows": False}, "objects": cubes}
    )


class MarkerRig(Rig):
    """A robot that stands askew, before cubes painted in one colour that nothing else has."""

    def __init__(self, faults: Mapping[str, Any] | None = None) -> None:
        super().__init__(marker_scene(), faults)
        model = self.world.model
        for name in MARKERS:
            for geom in np.flatnonzero(model.geom_bodyid == model.body(name).id):
                model.geom_matid[geom] = -1
                model.geom_rgba[geom] = (0, 1, 0, 1)
        self.drive(0.15, 0.35, 0.8)
        self.drive(0.0, 0.0, 0.5)


def centre_of(picture: NDArray[np.uint8], guess: NDArray[np.float64]) -> NDArray[np.float64]:
    """Centroid (u, v) of the green blob around a pixel."""
    red, green, blue = (picture[:, :, i].astype(int) for i in range(3))
    mask = ((green > 60) & (red < 0.35 * green) & (blue < 0.35 * green)).astype(np.uint8)
    _, _, _, centroids = cv2.connectedComponentsWithStats(mask)
    nearest = np.linalg.norm(centroids[1:] - guess, axis=1).argmin()
    return np.asarray(centroids[1:][nearest])


@pytest.fixture(scope="module")
def markers() -> Iterator[tuple[MarkerRig, NDArray[np.uint8]]]:
    rig = MarkerRig()
    renderer = Renderer(rig.world.model, ROBOT.camera.width, ROBOT.camera.height)
    yield rig, renderer.render(rig.world.snapshot()).copy()
    renderer.close()


@pytest.mark.parametrize("name", MARKERS)
def test_true_position_projects_onto_its_pixel(
    name: str, markers: tuple[MarkerRig, NDArray[np.uint8]]
) -> None:
    rig, picture = markers
    truth = rig.truth
    point_in_camera = camera_in_world(truth).inv().apply(truth.object(name).centre_in_world)
    projection = ROBOT.camera.model().project(point_in_camera[None])
    assert projection.is_inside[0]
    found = centre_of(picture, projection.pixels[0])
    assert np.linalg.norm(found - projection.pixels[0]) < 0.5


def test_pixel_centres_are_where_the_conventions_put_them(
    markers: tuple[MarkerRig, NDArray[np.uint8]],
) -> None:
    """Half a pixel, the classic mistake, would show in the mean over markers all over the picture."""
    rig, picture = markers
    points = camera_in_world(rig.truth).inv().apply([rig.truth.object(n).centre_in_world for n in MARKERS])
    pixels = ROBOT.camera.model().project(points).pixels
    errors = [centre_of(picture, pixel) - pixel for pixel in pixels]
    assert np.abs(np.mean(errors, axis=0)).max() < 0.25


def test_true_camera_is_where_the_robot_file_says() -> None:
    truth = MarkerRig().truth
    error = camera_in_world(truth).inv() * truth.camera_pose
    assert np.abs(error.as_matrix() - np.eye(4)).max() < 1e-6
    assert truth.focal_px == pytest.approx(ROBOT.camera.fx)


def test_mount_and_focal_faults_move_the_true_camera_alone() -> None:
    rig = MarkerRig({"mount_forward": 0.01, "mount_left": -0.004, "mount_up": 0.003, "focal_error": 0.05})
    error = camera_in_world(rig.truth).inv() * rig.truth.camera_pose
    assert np.linalg.norm(error.translation) == pytest.approx(np.linalg.norm([0.01, 0.004, 0.003]), abs=1e-6)
    assert rig.truth.focal_px == pytest.approx(1.05 * ROBOT.camera.fx)
    tilted = MarkerRig({"mount_pitch_deg": 2.0}).truth
    turn = (camera_in_world(tilted).inv() * tilted.camera_pose).rotation.as_rotvec(degrees=True)
    assert turn == pytest.approx([-2.0, 0.0, 0.0], abs=1e-6), "down is a negative turn about the camera's x"
    leaning = MarkerRig({"mount_roll_deg": 3.0}).truth
    turn = (camera_in_world(leaning).inv() * leaning.camera_pose).rotation.as_rotvec(degrees=True)
    assert turn == pytest.approx([0.0, 0.0, 3.0], abs=1e-6)


def test_stowed_and_standard_arm_leave_the_picture_free_and_a_low_one_does_not() -> None:
    rig = Rig(load_scene("plain_floor"))
    renderer = Renderer(rig.world.model, 640, 480)
    stowed = renderer.render(rig.world.snapshot()).copy()
    pictures = []
    for pose in (ROBOT.arm.standard.pose(), ArmPose(0.0, math.radians(46.0), math.radians(36.0), 0.03)):
        rig.world.move_arm(pose)
        rig.step(200)
        pictures.append(renderer.render(rig.world.snapshot()).copy())
    renderer.close()
    standard, low = (np.abs(stowed.astype(int) - picture).max(axis=2) > 40 for picture in pictures)
    assert low[360:].mean() > 0.05, "the claw is seen at the lower edge"
    assert low[:330].mean() < 0.005, "and hides nothing of what one taps"
    assert standard.mean() < 0.01
    dark = stowed[360:].max(axis=2) < 60
    assert dark.mean() < 0.01, "nothing of the arm is left"


class Plain:
    """Stands for the renderer: the picture shows the state's first number."""

    def render(self, snapshot: NDArray[np.float64], camera: str = "front") -> NDArray[np.uint8]:
        return np.full((48, 64, 3), np.clip(snapshot[0], 0, 255), np.uint8)


def taken(count: int = 1, seed: int = 0, **values: Any) -> list[SimPicture]:
    """Pictures of a state whose number rises by 10 each 10 ms, up to 100 at 100 ms."""
    from sim_world import faults

    camera = SimCamera(Plain(), faults(**values), seed)
    history = [Snapshot(ms * 1_000_000, np.array([float(ms)])) for ms in range(0, 110, 10)]
    for _ in range(count):
        camera.take(history)
    return camera.delivered(10**12)


def grey(picture: SimPicture) -> NDArray[np.float64]:
    return np.asarray(cv2.imdecode(np.frombuffer(picture.jpeg, np.uint8), cv2.IMREAD_GRAYSCALE), dtype=float)


def test_picture_without_faults_shows_the_last_state_at_its_time() -> None:
    (picture,) = taken()
    assert picture.captured_ns == picture.leaves_ns == 100_000_000
    assert grey(picture).mean() == pytest.approx(100, abs=1)


def test_motion_blur_mixes_the_exposure_and_stamps_its_middle() -> None:
    (picture,) = taken(motion_blur_ms=40.0)
    assert picture.captured_ns == 80_000_000
    assert grey(picture).mean() == pytest.approx(80, abs=1.5)


def test_delay_holds_pictures_back_and_the_host_does_not_know() -> None:
    from sim_world import faults

    camera = SimCamera(Plain(), faults(camera_delay_ms=50.0), 0)
    camera.take([Snapshot(100_000_000, np.array([1.0]))])
    assert camera.delivered(149_000_000) == []
    assert len(camera.delivered(150_000_000)) == 1
    assert camera.delivered(10**12) == []
    assert camera.unknown_delay_ns == 50_000_000


def test_dropped_frames_are_lost_at_their_rate_and_by_seed() -> None:
    assert 120 < len(taken(200, dropped_frames=0.25)) < 180
    assert [p.jpeg for p in taken(50, 1, dropped_frames=0.5)] == [
        p.jpeg for p in taken(50, 1, dropped_frames=0.5)
    ]


def test_exposure_noise_changes_brightness_and_grain() -> None:
    pictures = [grey(p) for p in taken(30, exposure_noise=0.1)]
    assert np.std([p.mean() for p in pictures]) > 4.0
    assert pictures[0].std() > 0.5
    assert grey(taken()[0]).std() == 0.0


def test_lower_jpeg_quality_makes_smaller_pictures() -> None:
    rough, fine = taken(exposure_noise=0.3, jpeg_quality=20), taken(exposure_noise=0.3, jpeg_quality=95)
    assert len(rough[0].jpeg) < 0.5 * len(fine[0].jpeg)


def test_state_between_snapshots_is_interpolated() -> None:
    history = [Snapshot(0, np.array([0.0])), Snapshot(10, np.array([1.0]))]
    assert [state_at(history, t)[0] for t in (-5, 0, 4, 10, 15)] == [0.0, 0.0, 0.4, 1.0, 1.0]


def test_shadows_are_given_up_before_the_rate_and_come_back_late() -> None:
    policy = ShadowPolicy(1 / 30)
    assert all(policy.note(0.02) for _ in range(100))
    assert policy.note(2.0), "one hiccup is no reason"
    assert not [policy.note(0.05) for _ in range(60)][-1]
    assert not [policy.note(0.008) for _ in range(250)][-1], "not at once"
    assert [policy.note(0.008) for _ in range(200)][-1]
