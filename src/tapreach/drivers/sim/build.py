"""A MuJoCo model out of a scene file, the rover and the camera."""

import math

import mujoco
import numpy as np

from tapreach.drivers.sim.build_materials import Palette
from tapreach.drivers.sim.build_objects import add_object
from tapreach.drivers.sim.build_room import (
    WALL_TEXTURE,
    add_furniture,
    add_hanging,
    add_light,
    add_room,
    add_sun_patches,
)
from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.scene import Scene
from tapreach.errors import ConfigError
from tapreach.geometry.pose import camera_mount
from tapreach.resources import resource_path
from tapreach.robot.config import CameraSection

# MuJoCo's camera looks along -z with y up, ours along z with y down: the one place that converts.
OPENCV_FROM_MUJOCO = np.diag([1.0, -1.0, -1.0])


def build_model(scene: Scene, camera: CameraSection, faults: SimFaults) -> mujoco.MjModel:
    """Return the compiled model: room, furniture, objects, rover and camera, with the faults of its parts.

    Raises ConfigError for a camera that the renderer cannot be.
    """
    _check_camera(camera)
    spec = mujoco.MjSpec.from_file(str(resource_path("models") / "rover.xml"))
    palette = Palette(spec)
    add_light(spec, scene.light, scene.room.wall in WALL_TEXTURE)
    add_room(spec, palette, scene.room)
    for index, hanging in enumerate(scene.hangings):
        add_hanging(spec, palette, scene.room, index, hanging)
        add_sun_patches(spec, palette, scene.room, scene.light, hanging)
    for index, piece in enumerate(scene.furniture):
        add_furniture(spec, palette, index, piece)
    for name, thing in zip(scene.object_names(), scene.objects, strict=True):
        add_object(spec, palette, name, thing)
    _set_track(spec, faults)
    _add_camera(spec, camera, faults)
    return spec.compile()


def _check_camera(camera: CameraSection) -> None:
    lens = camera.model()
    middle = ((camera.width - 1) / 2, (camera.height - 1) / 2)
    if lens.fx != lens.fy or (lens.cx, lens.cy) != middle or any(lens.distortion):
        raise ConfigError(
            "the simulated camera has square pixels, no distortion and its axis in the middle: "
            "in the robot file leave out fy, cx, cy and distortion"
        )


def _set_track(spec: mujoco.MjSpec, faults: SimFaults) -> None:
    for name in ("wheel_left", "wheel_right"):
        wheel = spec.body(name)
        wheel.pos = [wheel.pos[0], wheel.pos[1] * (1.0 + faults.track_error), wheel.pos[2]]


def _add_camera(spec: mujoco.MjSpec, camera: CameraSection, faults: SimFaults) -> None:
    mount = camera.mount
    position = (
        mount.forward + faults.mount_forward,
        mount.left + faults.mount_left,
        mount.up + faults.mount_up,
    )
    base_from_camera = camera_mount(
        position,
        math.radians(mount.pitch_deg + faults.mount_pitch_deg),
        math.radians(mount.yaw_deg + faults.mount_yaw_deg),
        math.radians(mount.roll_deg + faults.mount_roll_deg),
    )
    quat = np.zeros(4)
    rotation = base_from_camera.rotation.as_matrix() @ OPENCV_FROM_MUJOCO
    mujoco.mju_mat2Quat(quat, np.ascontiguousarray(rotation).flatten())
    focal = camera.fx * (1.0 + faults.focal_error)
    spec.body("base").add_camera(
        name="front", pos=position, quat=quat, fovy=math.degrees(2 * math.atan(camera.height / 2 / focal)),
        resolution=(camera.width, camera.height),
    )  # fmt: skip
    spec.visual.global_.offwidth = max(1280, camera.width)
    spec.visual.global_.offheight = max(960, camera.height)
