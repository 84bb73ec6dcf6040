"""How fast this machine simulates: the figures behind "real time beside the server on two cores"."""

from dataclasses import dataclass

from tapreach.drivers.sim.camera import encode_jpeg
from tapreach.drivers.sim.renderer import Renderer
from tapreach.drivers.sim.scene import Scene
from tapreach.drivers.sim.world import World
from tapreach.robot.clock import MS, SECOND, Clock
from tapreach.robot.config import RobotDescription
from tapreach.robot.messages import Twist


@dataclass(frozen=True)
class SimSpeed:
    """Physics: simulated time over wall time. Pictures: mean wall time of drawing and reading back [ms]."""

    realtime_factor: float
    picture_ms: float
    picture_without_shadows_ms: float
    jpeg_ms: float


def measure_speed(
    scene: Scene, description: RobotDescription, clock: Clock, simulated_s: float = 3.0, pictures: int = 30
) -> SimSpeed:
    """Drive a curve and draw pictures, alone in this thread. Raises SetupError when nothing can draw."""
    world = World(scene, description, scene.faults)
    began_ns = clock.now_ns()
    for _ in range(round(simulated_s / world.period_s)):
        world.drive(Twist(0.1, 0.3))
        world.step()
    factor = simulated_s * SECOND / (clock.now_ns() - began_ns)
    renderer = Renderer(world.model, description.camera.width, description.camera.height)
    try:
        with_shadows = _mean_ms(renderer, world, clock, pictures)
        renderer.shadows = False
        without = _mean_ms(renderer, world, clock, pictures)
        picture = renderer.render(world.snapshot())
        began_ns = clock.now_ns()
        for _ in range(pictures):
            encode_jpeg(picture, scene.faults.jpeg_quality)
        jpeg = (clock.now_ns() - began_ns) / MS / pictures
    finally:
        renderer.close()
    return SimSpeed(factor, with_shadows, without, jpeg)


def _mean_ms(renderer: Renderer, world: World, clock: Clock, pictures: int) -> float:
    renderer.render(world.snapshot())
    began_ns = clock.now_ns()
    for _ in range(pictures):
        renderer.render(world.snapshot())
    return (clock.now_ns() - began_ns) / MS / pictures
