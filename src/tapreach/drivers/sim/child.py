"""The simulator's process: `python -m tapreach.drivers.sim.child CONTROL_FD FRAMES_FD`.

Physics runs in a thread of its own in real time; pictures are drawn in the main thread, where the OpenGL
context lives. The process ends when its host goes: the kernel tells it (PR_SET_PDEATHSIG), and so does end of
file.
"""

import ctypes
import os
import signal
import socket
import sys

import mujoco

from tapreach.drivers.sim.camera import SimCamera
from tapreach.drivers.sim.child_frames import FrameLoop
from tapreach.drivers.sim.child_physics import PhysicsLoop
from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.protocol import MAX_PACKET, Failed, Ready, Setup, decode, encode
from tapreach.drivers.sim.renderer import Renderer
from tapreach.drivers.sim.scene import Scene
from tapreach.drivers.sim.truth import TruthTeller
from tapreach.drivers.sim.world import World
from tapreach.errors import TapreachError
from tapreach.robot.clock import MonotonicClock
from tapreach.robot.config import RobotDescription

_PR_SET_PDEATHSIG = 1


def main() -> None:
    """Serve the host at the two inherited sockets until it goes."""
    _die_with_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the host's affair: it closes the sockets
    control = socket.socket(fileno=int(sys.argv[1]))
    frames = socket.socket(fileno=int(sys.argv[2]))
    try:
        _simulate(control, frames)
    except (BrokenPipeError, ConnectionError):
        pass
    except TapreachError as error:
        _say(control, Failed(type(error).__name__, str(error)))
    except Exception as error:  # the host shows the sentence; a traceback helps nobody there
        _say(control, Failed("DriverError", f"the simulator failed: {type(error).__name__}: {error}"))


def _simulate(control: socket.socket, frames: socket.socket) -> None:
    setup = decode(control.recv(MAX_PACKET))
    if not isinstance(setup, Setup):
        raise TapreachError(f"the first message must be Setup, not {type(setup).__name__}")
    scene = Scene.model_validate_json(setup.scene)
    description = RobotDescription.model_validate_json(setup.description)
    faults = SimFaults.model_validate_json(setup.faults)
    # The host is told by World.warnings; MuJoCo would leave a log file in the user's folder.
    mujoco.set_mju_user_warning(lambda text: None)
    world = World(scene, description, faults, setup.seed)
    picture = description.camera
    renderer = Renderer(world.model, picture.width, picture.height, setup.opengl)
    renderer.render(world.snapshot())  # the first picture compiles shaders: before anybody counts on the rate
    clock = MonotonicClock()
    teller = TruthTeller(world.model, scene) if setup.tells_truth else None
    physics = PhysicsLoop(world, control, clock, teller)
    camera = SimCamera(renderer, faults, setup.seed, picture.delay_ms)
    loop = FrameLoop(renderer, camera, physics, frames, clock, picture.rate_hz)
    control.send(encode(Ready(renderer.opengl_name)))
    physics.start()
    try:
        loop.run()
    finally:
        physics.stop()
        renderer.close()
    if physics.failure:
        raise physics.failure


def _say(control: socket.socket, message: Failed) -> None:
    try:
        control.setblocking(True)
        control.send(encode(message))
    except OSError:
        print(message.reason, file=sys.stderr)  # noqa: T201


def _die_with_parent() -> None:
    parent = os.getppid()
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        sys.exit(0)


if __name__ == "__main__":
    main()
