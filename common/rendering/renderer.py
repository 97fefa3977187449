"""One renderer for the streamed state, by EGL, OSMesa or ray casting. Use it in one thread only."""

import os
import subprocess
import sys
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]
BACKENDS = ("egl", "osmesa", "raycast")
PROBE_SECONDS = 20.0
"""Time [s] for a GL library to show that it works."""
FAR = 25.0
"""Depth [m] from which there is nothing: beyond the largest flat."""
SKY = (200, 215, 232)
"""RGB of what a camera sees where nothing is: a blue between those of the scenes' sky."""
HIDDEN = 5
"""A MuJoCo geom group that is never drawn."""
_PROBE = (
    "import mujoco; m = mujoco.MjModel.from_xml_string('<mujoco/>'); d = mujoco.MjData(m); "
    "mujoco.mj_forward(m, d); r = mujoco.Renderer(m, 8, 8); r.update_scene(d); r.render(); r.close()"
)


@dataclass(frozen=True)
class View:
    """A free camera that looks at a point: distance [m], azimuth and elevation [deg]."""

    lookat: tuple[float, float, float]
    distance: float
    azimuth: float
    elevation: float


def works(backend: str) -> bool:
    """True when MuJoCo can render with that GL library; tried in a process of its own, since failures can crash."""
    if backend == "raycast":
        return True
    command = [sys.executable, "-c", _PROBE]
    try:
        return (
            subprocess.run(
                command, env={**os.environ, **environment(backend)}, capture_output=True, timeout=PROBE_SECONDS
            ).returncode
            == 0
        )
    except subprocess.TimeoutExpired:
        return False


@cache
def best() -> str:
    """The best backend of this machine."""
    return next(b for b in BACKENDS if works(b))


def choose(wanted: str) -> str:
    """The backend to use. MuJoCo settles on its GL library when it is first imported: before that `wanted` counts,
    after that only what the environment said then, or ray casting."""
    if "mujoco" in sys.modules:
        given = os.environ.get("MUJOCO_GL", "")
        return given if given in ("egl", "osmesa") and wanted in ("auto", given) else "raycast"
    backend = wanted if wanted != "auto" else best()
    os.environ |= environment(backend)
    return backend


def environment(backend: str) -> dict[str, str]:
    """What tells MuJoCo in a new process to render with a backend."""
    if backend == "raycast":
        return {"MUJOCO_GL": "disable"}
    return {"MUJOCO_GL": backend, "PYOPENGL_PLATFORM": backend}


class Renderer:
    """Holds the model, the state and a GL context."""

    def __init__(self, mjcf: str, wanted: str) -> None:
        self.backend = choose(wanted)
        import mujoco

        self._mujoco = mujoco
        self.model: Any = mujoco.MjModel.from_xml_string(mjcf)
        self.data: Any = mujoco.MjData(self.model)
        self._gl: dict[tuple[int, int], Any] = {}
        self._option = mujoco.MjvOption()
        self._option.geomgroup[:] = (1, 1, 1, 1, 0, 0)

    def load(self, qpos: bytes, mocap: bytes) -> None:
        """Take a streamed state.

        Raises:
            ValueError: it belongs to another model.
        """
        values = np.frombuffer(qpos)
        if values.shape != (self.model.nq,):
            raise ValueError(f"a state of {len(values)} numbers for a model of {self.model.nq}")
        self.data.qpos[:] = values
        if self.model.nmocap and len(mocap) == 24 * self.model.nmocap:
            self.data.mocap_pos[:] = np.frombuffer(mocap).reshape(-1, 3)
        self._mujoco.mj_kinematics(self.model, self.data)
        self._mujoco.mj_camlight(self.model, self.data)

    def rgbd(self, camera: str, width: int, height: int) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
        """RGB (height, width, 3) and depth (height, width) [m] of a camera of the model."""
        number = self.model.camera(camera).id
        if self.backend == "raycast":
            from common.rendering.raycast import render

            rotation = self.data.cam_xmat[number].reshape(3, 3)
            fovy = float(self.model.cam_fovy[number])
            body = int(self.model.cam_bodyid[number])
            return render(self.model, self.data, self.data.cam_xpos[number], rotation, fovy, width, height, body)
        fixed = self._mujoco.MjvCamera()
        fixed.type, fixed.fixedcamid = self._mujoco.mjtCamera.mjCAMERA_FIXED, number
        groups = self.model.geom_group.copy()
        self.model.geom_group[~self._in_sight(number, width / height)] = HIDDEN
        rgb, depth = self._offscreen(width, height).render(self.data, fixed, self._option, sky=False)
        self.model.geom_group[:] = groups
        empty = depth >= FAR
        rgb[empty], depth[empty] = SKY, 0.0
        return rgb, depth.astype(np.float64)

    def move(self, camera: str, offset: Array, turn: Array) -> None:
        """Displace a camera from where the model has it, until the next state is loaded.

        `offset` (3,) [m] and `turn` (3,) [rad, a rotation vector] in its optical frame.
        """
        number, flip = self.model.camera(camera).id, np.diag([1.0, -1.0, -1.0])
        optical = self.data.cam_xmat[number].reshape(3, 3) @ flip
        self.data.cam_xpos[number] += optical @ offset
        self.data.cam_xmat[number] = (optical @ Rotation.from_rotvec(turn).as_matrix() @ flip).ravel()

    def focal(self, camera: str, height: int) -> float:
        """Focal length [px] of a camera's pictures of so many rows."""
        return height / 2 / float(np.tan(np.radians(float(self.model.camera(camera).fovy[0])) / 2))

    def _in_sight(self, camera: int, aspect: float) -> NDArray[np.bool_]:
        """The geoms (n,) whose bounding sphere reaches into a camera's view; GL without a GPU is slow to find out."""
        model, data = self.model, self.data
        x, y, z = ((data.geom_xpos - data.cam_xpos[camera]) @ data.cam_xmat[camera].reshape(3, 3)).T
        up = np.tan(np.radians(model.cam_fovy[camera]) / 2)
        side, radius = up * aspect, model.geom_rbound
        seen = (np.abs(x) < radius * np.hypot(1, side) - z * side) & (np.abs(y) < radius * np.hypot(1, up) - z * up)
        return np.asarray(seen | (radius == 0), bool)

    def picture(self, view: View, width: int, height: int) -> NDArray[np.uint8]:
        """RGB (height, width, 3) of a free view."""
        if self.backend == "raycast":
            from common.rendering.raycast import render

            position, rotation = _pose(view)
            return render(self.model, self.data, position, rotation, 45.0, width, height)[0]
        camera = self._mujoco.MjvCamera()
        camera.lookat[:], camera.distance = view.lookat, view.distance
        camera.azimuth, camera.elevation = view.azimuth, view.elevation
        image: NDArray[np.uint8] = self._offscreen(width, height).render(self.data, camera, self._option)[0]
        return image

    def optical_pose(self, camera: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Position (3,) and rotation (3, 3) of the optical frame (x right, y down, z forward) in the base frame."""
        number, base = self.model.camera(camera).id, self.model.body("base").id
        turn = self.data.xmat[base].reshape(3, 3)
        position = turn.T @ (self.data.cam_xpos[number] - self.data.xpos[base])
        return position, turn.T @ self.data.cam_xmat[number].reshape(3, 3) @ np.diag([1.0, -1.0, -1.0])

    def _offscreen(self, width: int, height: int) -> Any:
        if (width, height) not in self._gl:
            from common.rendering.offscreen import Offscreen

            self.close()
            self.model.vis.global_.offwidth = max(width, self.model.vis.global_.offwidth)
            self.model.vis.global_.offheight = max(height, self.model.vis.global_.offheight)
            self._gl[width, height] = Offscreen(self.model, width, height)
        return self._gl[width, height]

    def close(self) -> None:
        """Free the GL context, in the thread that made it."""
        for gl in self._gl.values():
            gl.close()
        self._gl.clear()


def _pose(view: View) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Position and MuJoCo camera rotation (columns right, up, back) of a free view."""
    a, e = np.radians(view.azimuth), np.radians(view.elevation)
    forward = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([np.sin(a), -np.cos(a), 0.0])
    return np.array(view.lookat) - view.distance * forward, np.stack(
        [right, np.cross(right, forward), -forward], axis=1
    )
