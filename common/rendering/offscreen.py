"""Colour and depth of a scene in one GL pass; `mujoco.Renderer` needs two. Use it in one thread only."""

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

MAX_GEOMS = 10000
"""Geoms of a scene: the default of `mujoco.Renderer`."""


class Offscreen:
    """A GL context with a frame buffer of one size, and the scene drawn in it."""

    def __init__(self, model: Any, width: int, height: int) -> None:
        self._model = model
        self._scene = mujoco.MjvScene(model, maxgeom=MAX_GEOMS)
        self._gl: Any = mujoco.GLContext(width, height)
        self._gl.make_current()
        self._context: Any = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_150.value)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
        self._context.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR
        self._rect = mujoco.MjrRect(0, 0, width, height)

    def render(
        self, data: Any, camera: Any, option: Any, sky: bool = True
    ) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
        """RGB (h, w, 3) and distance along the optical axis (h, w) [m] from an `MjvCamera`.

        The `sky` is drawn behind everything, seen or not, which takes a third of a picture's time without a GPU.
        """
        self._gl.make_current()
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = sky
        everything = mujoco.mjtCatBit.mjCAT_ALL.value
        mujoco.mjv_updateScene(self._model, data, option, None, camera, everything, self._scene)
        rgb = np.empty((self._rect.height, self._rect.width, 3), np.uint8)
        z = np.empty(rgb.shape[:2], np.float32)
        mujoco.mjr_render(self._rect, self._scene, self._context)
        mujoco.mjr_readPixels(rgb, z, self._rect, self._context)
        return rgb[::-1], self._metres(z[::-1])

    def geoms(self, data: Any, camera: Any, option: Any) -> NDArray[np.int32]:
        """The geom (h, w) that each pixel shows, -1 for none; costs as much as a picture."""
        self._gl.make_current()
        flags, scene = self._scene.flags, self._scene
        everything = mujoco.mjtCatBit.mjCAT_ALL.value
        mujoco.mjv_updateScene(self._model, data, option, None, camera, everything, scene)
        flags[mujoco.mjtRndFlag.mjRND_SEGMENT] = flags[mujoco.mjtRndFlag.mjRND_IDCOLOR] = True
        rgb = np.empty((self._rect.height, self._rect.width, 3), np.uint8)
        mujoco.mjr_render(self._rect, scene, self._context)
        mujoco.mjr_readPixels(rgb, None, self._rect, self._context)
        flags[mujoco.mjtRndFlag.mjRND_SEGMENT] = flags[mujoco.mjtRndFlag.mjRND_IDCOLOR] = False
        numbers = np.full(scene.ngeom + 1, -1, np.int32)
        for geom in scene.geoms[: scene.ngeom]:
            if geom.objtype == mujoco.mjtObj.mjOBJ_GEOM:
                numbers[geom.segid + 1] = geom.objid
        shown = rgb[::-1].astype(np.int32) @ np.array([1, 1 << 8, 1 << 16], np.int32)
        return numbers[np.where(shown <= scene.ngeom, shown, 0)]

    def _metres(self, z: NDArray[np.float32]) -> NDArray[np.float32]:
        """Undo the perspective of a reversed z-buffer (1 near, 0 far), as `mujoco.Renderer` does."""
        extent = self._model.stat.extent
        near, far = np.float32(self._model.vis.map.znear * extent), np.float32(self._model.vis.map.zfar * extent)
        offset = np.float32(0.5) * (far + near) / (far - near) - np.float32(0.5)
        scale = np.float32(far * near) / (far - near)
        # float32 would lose millimetres far away.
        metres = z.astype(np.float64)
        metres += offset
        np.divide(scale, metres, out=metres)
        return metres.astype(np.float32)

    def close(self) -> None:
        """Free the GL context, in the thread that made it."""
        if self._context is not None:
            self._context.free()
            self._context = None
            self._gl.free()

    __del__ = close
