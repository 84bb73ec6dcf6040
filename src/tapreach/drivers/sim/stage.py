"""A furnished room with the robot put where it is wanted: pictures, and the truth about what they show.

For benches only: nothing that locates or drives may import this.
"""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import RigidTransform, Rotation

from tapreach.drivers.sim.build import OPENCV_FROM_MUJOCO
from tapreach.drivers.sim.build_objects import SEEN
from tapreach.drivers.sim.camera import SimCamera, Snapshot, state_at
from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.renderer import Renderer
from tapreach.drivers.sim.scene import Scene
from tapreach.drivers.sim.world import World
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.clock import MS
from tapreach.robot.config import RobotDescription

PERIOD_NS = 100 * MS
_SEEN_GROUPS = np.array([group <= SEEN for group in range(6)], np.uint8)
_SAME_PLACE = 0.004
"""A ray that ends this near to a surface point [m] sees it."""


@dataclass(frozen=True, eq=False)
class Hit:
    """What a line of sight meets: the body's name, the point (3,) [m] and the outward normal (3,)."""

    body: str
    point: FloatArray
    normal: FloatArray


class Stage:
    """World, camera and truth. Use it as a context manager, in one thread: it holds a renderer."""

    def __init__(self, scene: Scene, description: RobotDescription, faults: SimFaults, seed: int) -> None:
        self.objects = scene.object_names()
        self._room = scene.room
        self._world = World(scene, description, faults, seed)
        self._start = self._world.model.joint("base").qposadr[0]
        self._rest = self._world.snapshot()
        self._data = mujoco.MjData(self._world.model)
        picture = description.camera
        self._renderer = Renderer(self._world.model, picture.width, picture.height)
        self._renderer.shadows = False  # they lie on the floor, and cost most of the time
        self._camera = SimCamera(self._renderer, faults, seed)
        self._now_ns = 0

    def __enter__(self) -> "Stage":
        return self

    def __exit__(self, *_: object) -> None:
        self._renderer.close()

    def picture(self, before: PlanarPose, now: PlanarPose) -> tuple[bytes, NDArray[np.float64]]:
        """Return the JPEG taken on arriving at `now`, and the state of the world in mid-exposure."""
        self._now_ns += PERIOD_NS
        states = [
            Snapshot(self._now_ns - PERIOD_NS, self._state(before)),
            Snapshot(self._now_ns, self._state(now)),
        ]
        self._camera.take(states)
        (taken,) = self._camera.delivered(self._now_ns)
        return taken.jpeg, state_at(states, taken.captured_ns)

    def camera_pose(self, state: NDArray[np.float64]) -> tuple[RigidTransform, float]:
        """Return world_from_camera and the focal length [px] of a state."""
        self.place(state)
        mujoco.mj_camlight(self._world.model, self._data)
        camera, model = self._data.camera("front"), self._world.model
        rotation = Rotation.from_matrix(camera.xmat.reshape(3, 3) @ OPENCV_FROM_MUJOCO)
        height, fovy = model.cam_resolution[camera.id][1], np.radians(model.cam_fovy[camera.id])
        return RigidTransform.from_components(camera.xpos, rotation), float(height / 2 / np.tan(fovy / 2))

    def at(self, pose: PlanarPose) -> NDArray[np.float64]:
        """Return the state with the robot at `pose`, for `camera_pose` and `look`."""
        return self._state(pose)

    def place(self, state: NDArray[np.float64]) -> None:
        """Put the bodies where `state` has them: what `look` and `sees` then ask about."""
        self._data.qpos[:] = state
        mujoco.mj_kinematics(self._world.model, self._data)

    def centre(self, name: str) -> FloatArray:
        """Return where the middle of an object is (3,) [m]."""
        return np.array(self._data.body(name).xpos)

    def is_in_room(self, point: FloatArray) -> bool:
        """Tell whether the robot can stand at a point (2 or more,) without touching a wall."""
        (west, east), (south, north) = self._room.x, self._room.y
        return bool(west + 0.2 < point[0] < east - 0.2 and south + 0.2 < point[1] < north - 0.2)

    def look(self, origin: FloatArray, direction: FloatArray) -> Hit | None:
        """Return the first visible thing along a ray from `origin` (3,) along a unit `direction` (3,)."""
        geom, normal = np.zeros(1, np.int32), np.zeros(3)
        model = self._world.model
        base = model.body("base").id
        distance = mujoco.mj_ray(model, self._data, origin, direction, _SEEN_GROUPS, True, base, geom, normal)
        if distance < 0.0:
            return None
        body = str(model.body(int(model.geom_bodyid[geom[0]])).name)
        return Hit(body, origin + distance * direction, normal)

    def sees(self, origin: FloatArray, point: FloatArray) -> bool:
        """Tell whether nothing stands between `origin` (3,) and the surface point (3,)."""
        away = point - origin
        hit = self.look(origin, away / np.linalg.norm(away))
        return hit is not None and float(np.linalg.norm(hit.point - point)) < _SAME_PLACE

    def _state(self, pose: PlanarPose) -> NDArray[np.float64]:
        state = self._rest.copy()
        state[self._start : self._start + 2] = pose.x, pose.y
        yaw = np.array([np.cos(pose.heading / 2.0), 0.0, 0.0, np.sin(pose.heading / 2.0)])
        turned = np.zeros(4)
        mujoco.mju_mulQuat(turned, yaw, self._rest[self._start + 3 : self._start + 7])
        state[self._start + 3 : self._start + 7] = turned
        return state
