"""How far the robot backs off before it holds up its claw."""

import math

from hypothesis import given
from hypothesis import strategies as st

from tapreach.tasks.fetch.arm_zero import arm_noise
from tapreach.tasks.fetch.claw_show_room import CLEAR, way_back
from tapreach.tasks.fetch.looking_poses import FARTHEST_AHEAD, looking_poses
from tasks.fetch.worlds import ROBOT, obstacle_at

POSES = looking_poses(ROBOT, arm_noise())


@given(st.floats(-0.6, 0.6), st.floats(-0.5, 0.5))
def test_once_it_has_backed_off_the_claw_is_shown_clear_of_what_stands_there(x: float, y: float) -> None:
    back = way_back([obstacle_at("can", x, y, 0.03)], ROBOT)
    for pose in POSES:
        apart = math.hypot(x + back - pose.tip[0], y - pose.tip[1]) - 0.03
        assert apart > CLEAR or x <= 0.0


def test_what_stands_aside_or_far_ahead_or_behind_is_not_backed_off_from() -> None:
    far = ROBOT.camera.mount.forward + FARTHEST_AHEAD + 0.2
    around = [obstacle_at("a", far, 0.0), obstacle_at("b", 0.2, 0.4), obstacle_at("c", -0.3, 0.0)]
    assert way_back(around, ROBOT) == 0.0


def test_nearest_of_all_counts() -> None:
    near, nearer = obstacle_at("a", 0.3, 0.0), obstacle_at("b", 0.25, 0.02)
    assert way_back([near, nearer], ROBOT) == way_back([nearer], ROBOT) > way_back([near], ROBOT) > 0.0
