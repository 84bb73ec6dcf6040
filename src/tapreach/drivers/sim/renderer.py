"""Pictures of the world: MuJoCo's classic renderer on an off-screen context."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from tapreach.drivers.sim.gl import GLContext, create_context

Picture = NDArray[np.uint8]


class Renderer:
    """Draws what a camera of the model sees. Make it, use it and close it in one thread."""

    def __init__(self, model: mujoco.MjModel, width: int, height: int, opengl: str = "auto") -> None:
        self._model = model
        self._data = mujoco.MjData(model)
        self._opengl: GLContext = create_context(opengl)
        self.opengl_name = self._opengl.name
        self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
        self._scene = mujoco.MjvScene(model, 2000)
        self._scene.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = 0
        self._scene.flags[mujoco.mjtRndFlag.mjRND_HAZE] = 0
        self._option = mujoco.MjvOption()
        self._viewport = mujoco.MjrRect(0, 0, width, height)
        self._pixels: Picture = np.empty((height, width, 3), np.uint8)
        self.shadows = True

    def render(self, snapshot: NDArray[np.float64], camera: str | mujoco.MjvCamera = "front") -> Picture:
        """Return the RGB picture (height, width, 3) of `World.snapshot()`, good until the next call."""
        self._data.qpos[:] = snapshot
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_camlight(self._model, self._data)
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = int(self.shadows)
        view = self._fixed(camera) if isinstance(camera, str) else camera
        everything = mujoco.mjtCatBit.mjCAT_ALL.value
        mujoco.mjv_updateScene(self._model, self._data, self._option, None, view, everything, self._scene)
        mujoco.mjr_render(self._viewport, self._scene, self._context)
        mujoco.mjr_readPixels(self._pixels, None, self._viewport, self._context)
        return self._pixels[::-1]

    def close(self) -> None:
        """Free the context."""
        self._context.free()
        self._opengl.free()

    def _fixed(self, name: str) -> mujoco.MjvCamera:
        camera = mujoco.MjvCamera()
        camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
        camera.fixedcamid = self._model.camera(name).id
        return camera
