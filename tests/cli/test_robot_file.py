"""Which robot, and what the command line changes in its file."""

import pytest

from tapreach.cli.robot_file import describe_robot, parse_faults, parse_size, resized
from tapreach.errors import InputError
from tapreach.robot.config import CameraSection


def described(**changes):
    arguments = {"robot": "sim", "size": None, "scene": None, "seed": None, "faults": []} | changes
    return describe_robot(**arguments)


@pytest.mark.parametrize("size", ["640x480", "960x720", "1280x720"])
def test_resized_picture_keeps_the_horizontal_field_of_view(size: str) -> None:
    lens = described(size=size).camera.model()
    (left, right) = lens.normalise([[-0.5, lens.cy], [lens.size.width - 0.5, lens.cy]])
    expected = described().camera.model()
    assert right[0] - left[0] == pytest.approx(expected.size.width / expected.fx)


def test_flatter_picture_is_the_middle_of_the_taller_one() -> None:
    description = described()
    camera = CameraSection.model_validate(
        description.camera.model_dump(exclude_unset=True) | {"cx": 300.0, "cy": 200.0, "fy": 500.0}
    )
    description = description.model_copy(update={"camera": camera})
    tall, flat = (resized(description, 1280, height).camera.model() for height in (960, 720))
    assert flat.cx == tall.cx
    assert flat.cy == tall.cy - 120.0
    assert (flat.fx, flat.fy) == (tall.fx, tall.fy)


def test_command_line_wins_over_the_robot_file() -> None:
    description = described(scene="dark", seed=3, faults=["slip=0.02", "jpeg_quality=50"])
    assert description.simulation["scene"] == "dark"
    assert description.simulation["seed"] == 3
    assert description.simulation["faults"] == {"slip": 0.02, "jpeg_quality": 50}


@pytest.mark.parametrize("text", ["", "640", "640x", "x480", "-1x2", "axb"])
def test_size_that_is_none_shows_one(text: str) -> None:
    with pytest.raises(InputError, match="640x480"):
        parse_size(text)


@pytest.mark.parametrize("text", ["slip", "slip=", "slip=much", "=="])
def test_fault_that_is_none_shows_one(text: str) -> None:
    with pytest.raises(InputError, match=r"slip=0\.02"):
        parse_faults([text])


def test_simulator_options_are_refused_for_another_robot() -> None:
    with pytest.raises(InputError, match="simulator"):
        described(robot="fake", seed=1)


def test_unknown_robot_lists_the_shipped_ones() -> None:
    with pytest.raises(InputError, match="fake, ros-arduino, rover-pi, sim, yun"):
        described(robot="dalek")
