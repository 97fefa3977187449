"""Colour and depth of a scene in one GL pass; `mujoco.Renderer` needs two. Use it in one thread only."""

from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from common.rendering.backend import context

MAX_GEOMS = 10000
"""Geoms of a scene: the default of `mujoco.Renderer`."""
HIDDEN = 5
"""A MuJoCo geom group that is never drawn."""
Layers = Sequence[NDArray[np.intp]]
"""Numbers of the geoms that are drawn, those of the first before those of the next."""


class Offscreen:
    """A GL context with a frame buffer of one size, and the scene drawn in it."""

    def __init__(self, model: Any, backend: str, width: int, height: int) -> None:
        self._model = model
        self._scene = mujoco.MjvScene(model, maxgeom=MAX_GEOMS)
        self._gl: Any = context(backend, width, height)
        self._gl.make_current()
        self._context: Any = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_150.value)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
        self._context.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR
        self._rect = mujoco.MjrRect(0, 0, width, height)
        self._untouched = mujoco.MjvPerturb()

    def render(
        self,
        data: Any,
        camera: Any,
        option: Any,
        layers: Layers | None = None,
        rows: tuple[int, int] | None = None,
    ) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
        """RGB (h, w, 3) and distance along the optical axis (h, w) [m] from an `MjvCamera`.

        With `layers` nothing else is drawn, not even the sky behind, which takes a third of a picture's time without
        a GPU; near geoms before far ones save the pixels that these would hide. `rows`: the first and the one after
        the last that are drawn.
        """
        self._gl.make_current()
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = layers is None
        self._lay_out(data, camera, option, layers)
        rect = self._rect if rows is None else self._band(*rows)
        rgb = np.empty((rect.height, rect.width, 3), np.uint8)
        z = np.empty(rgb.shape[:2], np.float32)
        mujoco.mjr_render(rect, self._scene, self._context)
        mujoco.mjr_readPixels(rgb, z, rect, self._context)
        return rgb[::-1], self._metres(z[::-1])

    def _lay_out(self, data: Any, camera: Any, option: Any, layers: Layers | None) -> None:
        """Put the geoms into the scene: everything, or the `layers` in their order."""
        model, everything = self._model, mujoco.mjtCatBit.mjCAT_ALL.value
        groups = model.geom_group.copy()
        for number, layer in enumerate(layers or (slice(None),)):
            model.geom_group[:] = HIDDEN
            model.geom_group[layer] = groups[layer]
            if number == 0:
                mujoco.mjv_updateScene(model, data, option, None, camera, everything, self._scene)
            else:
                mujoco.mjv_addGeoms(model, data, option, self._untouched, everything, self._scene)
        model.geom_group[:] = groups

    def _band(self, first: int, end: int) -> Any:
        """Narrow the scene's view to some rows; where in the frame buffer they are drawn."""
        height = self._rect.height
        for eye in self._scene.camera:
            top, span = eye.frustum_top, eye.frustum_bottom - eye.frustum_top
            eye.frustum_top, eye.frustum_bottom = top + span * first / height, top + span * end / height
        return mujoco.MjrRect(0, 0, self._rect.width, end - first)

    def geoms(self, data: Any, camera: Any, option: Any, layers: Layers | None = None) -> NDArray[np.int32]:
        """The geom (h, w) that each pixel shows, -1 for none; costs as much as a picture."""
        self._gl.make_current()
        flags, scene = self._scene.flags, self._scene
        self._lay_out(data, camera, option, layers)
        flags[mujoco.mjtRndFlag.mjRND_SEGMENT] = flags[mujoco.mjtRndFlag.mjRND_IDCOLOR] = True
        rgb = np.empty((self._rect.height, self._rect.width, 3), np.uint8)
        mujoco.mjr_render(self._rect, scene, self._context)
        mujoco.mjr_readPixels(rgb, None, self._rect, self._context)
        flags[mujoco.mjtRndFlag.mjRND_SEGMENT] = flags[mujoco.mjtRndFlag.mjRND_IDCOLOR] = False
        numbers = np.full(1 << 16, -1, np.int32)  # two of the three bytes of a colour: there are MAX_GEOMS at most
        for geom in scene.geoms[: scene.ngeom]:
            if geom.objtype == mujoco.mjtObj.mjOBJ_GEOM:
                numbers[geom.segid + 1] = geom.objid
        shown = rgb[::-1, :, 1].astype(np.uint16)
        shown <<= 8
        shown |= rgb[::-1, :, 0]
        return np.take(numbers, shown)

    def _metres(self, z: NDArray[np.float32]) -> NDArray[np.float32]:
        """Undo the perspective of a reversed z-buffer (1 near, 0 far), as `mujoco.Renderer` does."""
        extent = self._model.stat.extent
        near, far = np.float32(self._model.vis.map.znear * extent), np.float32(self._model.vis.map.zfar * extent)
        offset = np.float32(0.5) * (far + near) / (far - near) - np.float32(0.5)
        scale = np.float32(far * near) / (far - near)
        metres = np.empty(z.shape, np.float32)
        # float32 would lose millimetres far away.
        np.divide(scale, np.add(z, offset, dtype=np.float64), out=metres, dtype=np.float64, casting="same_kind")
        return metres

    def close(self) -> None:
        """Free the GL context, in the thread that made it."""
        if self._context is not None:
            self._context.free()
            self._context = None
            self._gl.free()

    __del__ = close
