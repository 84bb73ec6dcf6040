import pytest
from sim_world import HALL, ROBOT

from tapreach.drivers.sim.renderer import Renderer
from tapreach.drivers.sim.world import World
from tapreach.errors import ConfigError
from tapreach.robot.config import RobotDescription


def robot_with(**camera: object) -> RobotDescription:
    return ROBOT.model_copy(update={"camera": ROBOT.camera.model_copy(update=camera)})


@pytest.mark.parametrize(("width", "height"), [(640, 480), (960, 720), (1280, 720)])
def test_picture_has_the_size_of_the_robot_file(width: int, height: int) -> None:
    robot = robot_with(width=width, height=height, fx=533.0 * height / 480)
    world = World(HALL, robot, HALL.faults)
    renderer = Renderer(world.model, width, height)
    picture = renderer.render(world.snapshot())
    assert picture.shape == (height, width, 3)
    assert picture.std() > 1.0
    renderer.close()


@pytest.mark.parametrize(
    "camera", [{"fy": 500.0}, {"cx": 300.0}, {"cy": 250.0}, {"distortion": (0.1, 0.0, 0.0, 0.0, 0.0)}]
)
def test_lens_that_cannot_be_drawn_is_refused(camera: dict[str, object]) -> None:
    with pytest.raises(ConfigError, match="leave out fy, cx, cy and distortion"):
        World(HALL, robot_with(**camera), HALL.faults)
