from sim_world import ROBOT

from tapreach.drivers.sim.scene import load_scene
from tapreach.drivers.sim.speed import measure_speed
from tapreach.robot.clock import MonotonicClock


def test_physics_is_faster_than_real_time_and_pictures_cost_what_is_said() -> None:
    speed = measure_speed(load_scene("room"), ROBOT, MonotonicClock(), simulated_s=1.0, pictures=5)
    assert speed.realtime_factor > 1.0
    assert speed.picture_ms > 0.0
    assert speed.picture_without_shadows_ms > 0.0
    assert 0.0 < speed.jpeg_ms < 50.0
