"""Where things truly are. For tests and benches only: nothing that locates or drives may import this."""

import json
from dataclasses import asdict, dataclass
from typing import Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import RigidTransform, Rotation

from tapreach.drivers.sim.build import OPENCV_FROM_MUJOCO
from tapreach.drivers.sim.scene import Scene
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose

_DRAWN = np.array([1, 1, 1, 0, 0, 0], np.uint8)
"""MuJoCo's groups of shapes that the renderer draws; the solids of the collisions are not among them."""

Matrix = tuple[tuple[float, ...], ...]


@dataclass(frozen=True)
class ObjectTruth:
    """One object: its middle in the world frame [m], its pose (4 × 4), outer size along its axes [m]."""

    name: str
    kind: str
    centre_in_world: tuple[float, float, float]
    world_from_object: Matrix
    size: tuple[float, float, float]
    graspable: bool


@dataclass(frozen=True)
class WorldTruth:
    """Everything at one time. Poses are 4 × 4 matrices in the world frame (the base at start-up)."""

    captured_ns: int
    world_from_base: Matrix
    world_from_camera: Matrix
    world_from_gripper: Matrix
    focal_px: float
    objects: tuple[ObjectTruth, ...]

    @property
    def base_pose(self) -> PlanarPose:
        """The base on the floor."""
        return PlanarPose.from_rigid(RigidTransform.from_matrix(np.array(self.world_from_base)))

    @property
    def camera_pose(self) -> RigidTransform:
        """world_from_camera."""
        return RigidTransform.from_matrix(np.array(self.world_from_camera))

    def object(self, name: str) -> ObjectTruth:
        """Return the object called `name`. Raises KeyError listing the names."""
        for thing in self.objects:
            if thing.name == name:
                return thing
        raise KeyError(f"no object {name!r}; objects: {', '.join(o.name for o in self.objects)}")

    def to_json(self) -> str:
        """Return JSON that `from_json` reads."""
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, text: str) -> "WorldTruth":
        """Read what `to_json` wrote."""
        data = json.loads(text)
        objects = tuple(
            ObjectTruth(**{**o, "centre_in_world": tuple(o["centre_in_world"]), "size": tuple(o["size"])})
            for o in data.pop("objects")
        )
        return cls(objects=objects, **data)


@dataclass(frozen=True)
class SurfacePoint:
    """What a line of sight meets first: the object's name ('' for room, furniture or the robot itself), its
    distance from the camera [m], the point in the world and in the frame of its body, (3,) each [m].
    """

    name: str
    distance: float
    point_in_world: FloatArray
    point_in_object: FloatArray


class AsksTruth(Protocol):
    """A SimRobot made with tells_truth=True, or an InlineSimRobot."""

    async def ask_truth_json(self, at_ns: int) -> str:
        """Return WorldTruth as JSON; for `ask_truth` only."""
        ...


async def ask_truth(robot: AsksTruth, at_ns: int = 0) -> WorldTruth:
    """Return the truth at a time of the last 10 s [ns], interpolated; now for 0.

    Raises InputError for a SimRobot that was not made with tells_truth=True, LinkLost when it is gone.
    """
    return WorldTruth.from_json(await robot.ask_truth_json(at_ns))


class TruthTeller:
    """Reads the truth out of states of a model; works on data of its own, so physics is not disturbed."""

    def __init__(self, model: mujoco.MjModel, scene: Scene) -> None:
        self._model = model
        self._data = mujoco.MjData(model)
        self._things = list(zip(scene.object_names(), scene.objects, strict=True))
        self._names = frozenset(scene.object_names())

    def tell(self, qpos: NDArray[np.float64], captured_ns: int) -> WorldTruth:
        """Return the truth of one state."""
        self._data.qpos[:] = qpos
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_camlight(self._model, self._data)
        base, camera = self._data.body("base"), self._data.camera("front")
        gripper = self._data.site("gripper")
        lens = camera.id
        focal = self._model.cam_resolution[lens][1] / 2 / np.tan(np.radians(self._model.cam_fovy[lens]) / 2)
        return WorldTruth(
            captured_ns,
            _matrix(base.xpos, base.xmat.reshape(3, 3)),
            _matrix(camera.xpos, camera.xmat.reshape(3, 3) @ OPENCV_FROM_MUJOCO),
            _matrix(gripper.xpos, gripper.xmat.reshape(3, 3)),
            float(focal),
            tuple(self._object(index) for index in range(len(self._things))),
        )

    def surfaces(
        self, qpos: NDArray[np.float64], directions_in_camera: NDArray[np.float64]
    ) -> list[SurfacePoint | None]:
        """Return what each direction (n, 3) out of the camera meets first of all that is drawn; None in the
        open.
        """
        self._data.qpos[:] = qpos
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_camlight(self._model, self._data)
        camera = self._data.camera("front")
        in_world = directions_in_camera @ (camera.xmat.reshape(3, 3) @ OPENCV_FROM_MUJOCO).T
        return [self._met(camera.xpos, direction) for direction in in_world]

    def _met(self, start: NDArray[np.float64], direction: NDArray[np.float64]) -> SurfacePoint | None:
        geom = np.full(1, -1, np.int32)
        base = self._model.body("base").id
        distance = float(mujoco.mj_ray(self._model, self._data, start, direction, _DRAWN, 1, base, geom))
        if distance < 0.0:
            return None
        point = start + distance * direction
        body = self._data.body(int(self._model.geom_bodyid[geom[0]]))
        name = body.name if body.name in self._names else ""
        return SurfacePoint(name, distance, point, (point - body.xpos) @ body.xmat.reshape(3, 3))

    def _object(self, index: int) -> ObjectTruth:
        name, thing = self._things[index]
        body = self._data.body(name)
        centre = (float(body.xpos[0]), float(body.xpos[1]), float(body.xpos[2]))
        pose = _matrix(body.xpos, body.xmat.reshape(3, 3))
        return ObjectTruth(name, thing.kind, centre, pose, thing.outer_size, thing.graspable)


def _matrix(position: NDArray[np.float64], rotation: NDArray[np.float64]) -> Matrix:
    pose = RigidTransform.from_components(position, Rotation.from_matrix(rotation))
    return tuple(tuple(float(value) for value in row) for row in pose.as_matrix())
