"""One renderer for the streamed state, by EGL, OSMesa or ray casting. Use it in one thread only."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array, turn_matrix
from common.rendering.backend import choose
from common.rendering.looks import SKY

FAR = 25.0
"""Depth [m] from which there is nothing: beyond the largest flat."""
NEAR = 0.02
"""Depth [m] by which something has to be behind all that is seen to be hidden; chosen: far more than depth's error."""
LAYERS = 12
"""Parts into which what is drawn is sorted by distance [count]; chosen: with more nothing is gained."""


@dataclass(frozen=True)
class View:
    """A free camera that looks at a point: distance [m], azimuth and elevation [deg]."""

    lookat: tuple[float, float, float]
    distance: float
    azimuth: float
    elevation: float


@dataclass(frozen=True)
class Surfaces:
    """What pixels show: `gloss` (h, w) [0 matt .. 1 like a mirror], `clear` (h, w) where it is transparent."""

    gloss: Array
    clear: NDArray[np.bool_]


def looks(model: Any) -> tuple[Array, NDArray[np.bool_]]:
    """The gloss (n,) [0 matt .. 1 like a mirror] of each geom, and whether (n,) it is transparent.

    MuJoCo's materials have `specular` and `shininess` of .5 unless they say otherwise, which is matt here.
    """
    material = model.geom_matid
    share = np.append(np.minimum(model.mat_specular, model.mat_shininess), 0.0)[material]
    alpha = model.geom_rgba[:, 3]
    return np.clip(2.0 * share - 1.0, 0.0, 1.0), (alpha > 0.0) & (alpha < 1.0)


class Renderer:
    """Holds the model, the state and a GL context."""

    def __init__(self, mjcf: str, wanted: str, files: dict[str, bytes] | None = None) -> None:
        self.backend = choose(wanted)
        import mujoco

        self._mujoco = mujoco
        self.model: Any = mujoco.MjModel.from_xml_string(mjcf, files or {})
        self.data: Any = mujoco.MjData(self.model)
        self._gl: dict[tuple[int, int], Any] = {}
        self._option = mujoco.MjvOption()
        self._option.geomgroup[:] = (1, 1, 1, 1, 0, 0)
        self._gloss, self._clear = looks(self.model)

    def load(self, qpos: bytes, mocap: bytes) -> None:
        """Put the model into a streamed state.

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

    def rgbd(self, camera: str, width: int, height: int) -> tuple[NDArray[np.uint8], NDArray[np.floating]]:
        """RGB (height, width, 3) and depth (height, width) [m] of a camera of the model."""
        number = self.model.camera(camera).id
        if self.backend == "raycast":
            return self._cast(number, width, height)[:2]
        sight = self._in_sight(number, width / height)
        rgb, depth = self._drawn(number, width, height, sight)
        if (sight & self._clear).any():
            depth = self._drawn(number, width, height, sight & ~self._clear)[1]
        return rgb, depth

    def band(self, camera: str, width: int, height: int, rows: tuple[int, int]) -> NDArray[np.uint8]:
        """RGB (n, width, 3) of some rows, the first and the one after the last, of a camera's picture."""
        number, (first, end) = self.model.camera(camera).id, rows
        if self.backend == "raycast":
            return self._cast(number, width, height)[0][first:end]
        sight = self._in_sight(number, width / height, (1 - 2 * end / height, 1 - 2 * first / height))
        return self._drawn(number, width, height, sight, rows)[0]

    def surfaces(self, camera: str, depth: NDArray[np.floating]) -> Surfaces | None:
        """Which pixels of a camera show what depth cameras have their trouble with; None: nothing of it in sight.

        `depth` (h, w) [m]: of the same state, without what is transparent, 0 for nothing.
        """
        number, (height, width) = self.model.camera(camera).id, depth.shape
        sight = self._in_sight(number, width / height)
        hard = sight & (self._clear | (self._gloss > 0.0))
        rows = [found for g in np.flatnonzero(hard).tolist() if (found := self._rows(number, g, depth)) is not None]
        if not rows:
            return None
        # What reaches into none of these rows hides nothing of it.
        first, end = min(a for a, _ in rows), max(b for _, b in rows)
        sight = self._in_sight(number, width / height, (1 - 2 * end / height, 1 - 2 * first / height))
        if self.backend == "raycast":
            shown = self._cast(number, width, height)[2]
        else:
            shown = self._offscreen(width, height).geoms(
                self.data, self._fixed(number), self._option, self._layers(number, sight)
            )
        # The last entry is for pixels that show nothing, number -1.
        return Surfaces(np.append(self._gloss, 0.0)[shown], np.append(self._clear, False)[shown])

    def _rows(self, camera: int, geom: int, depth: NDArray[np.floating]) -> tuple[int, int] | None:
        """The rows, the first and the one after the last, in which a geom may be seen; None where all that is seen
        there is nearer."""
        height, width = depth.shape
        data, radius = self.data, float(self.model.geom_rbound[geom])
        x, y, z = (data.geom_xpos[geom] - data.cam_xpos[camera]) @ data.cam_xmat[camera].reshape(3, 3)
        near = -z - radius
        if radius == 0.0 or near < NEAR:
            return 0, height
        focal = height / 2 / np.tan(np.radians(self.model.cam_fovy[camera]) / 2)
        # Between the near and the far side of its bounding sphere, a pixel wider.
        across = [focal * (x + r) / d for r in (-radius, radius) for d in (near, near + 2 * radius)]
        down = [-focal * (y + r) / d for r in (-radius, radius) for d in (near, near + 2 * radius)]
        left, right = (max(0, min(width, round(width / 2 + u))) for u in (min(across) - 1, max(across) + 1))
        first, end = (max(0, min(height, round(height / 2 + v))) for v in (min(down) - 1, max(down) + 1))
        seen = depth[first:end, left:right]
        shows = seen.size and (seen.max() > near - NEAR or seen.min() == 0.0)
        return (first, end) if shows else None

    def _fixed(self, camera: int) -> Any:
        found = self._mujoco.MjvCamera()
        found.type, found.fixedcamid = self._mujoco.mjtCamera.mjCAMERA_FIXED, camera
        return found

    def _layers(self, camera: int, geoms: NDArray[np.bool_]) -> list[NDArray[np.intp]]:
        """The numbers of these geoms (n,) from near to far; the last are planes, which have no end."""
        apart = np.linalg.norm(self.data.geom_xpos - self.data.cam_xpos[camera], axis=1)
        apart[self.model.geom_rbound == 0] = np.inf
        chosen = np.flatnonzero(geoms)
        return np.array_split(chosen[np.argsort(apart[chosen], kind="stable")], LAYERS)

    def _drawn(
        self, camera: int, width: int, height: int, geoms: NDArray[np.bool_], rows: tuple[int, int] | None = None
    ) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
        """RGB (n, w, 3) and depth (n, w) [m] of these geoms alone, 0 where there is none."""
        rgb, depth = self._offscreen(width, height).render(
            self.data, self._fixed(camera), self._option, self._layers(camera, geoms), rows
        )
        empty = depth >= FAR
        rgb[empty], depth[empty] = SKY, 0.0
        return rgb, depth

    def _cast(
        self, camera: int, width: int, height: int
    ) -> tuple[NDArray[np.uint8], NDArray[np.float64], NDArray[np.int32]]:
        from common.rendering.raycast import image

        rotation = self.data.cam_xmat[camera].reshape(3, 3)
        fovy, body = float(self.model.cam_fovy[camera]), int(self.model.cam_bodyid[camera])
        return image(self.model, self.data, self.data.cam_xpos[camera], rotation, fovy, width, height, body)

    def move(self, camera: str, offset: Array, turn: Array) -> None:
        """Displace a camera from where the model has it, until the next state is loaded.

        `offset` (3,) [m] and `turn` (3,) [rad, a rotation vector] in its optical frame.
        """
        number, flip = self.model.camera(camera).id, np.diag([1.0, -1.0, -1.0])
        optical = self.data.cam_xmat[number].reshape(3, 3) @ flip
        self.data.cam_xpos[number] += optical @ offset
        self.data.cam_xmat[number] = (optical @ turn_matrix(turn) @ flip).ravel()

    def focal(self, camera: str, height: int) -> float:
        """Focal length [px] of a camera's pictures of so many rows."""
        return height / 2 / float(np.tan(np.radians(float(self.model.camera(camera).fovy[0])) / 2))

    def _in_sight(self, camera: int, aspect: float, rows: tuple[float, float] = (-1.0, 1.0)) -> NDArray[np.bool_]:
        """The geoms (n,) whose bounding sphere reaches into a camera's view; GL without a GPU is slow to find out.

        `rows`: its lower and its upper end, from -1 to 1.
        """
        model, data = self.model, self.data
        x, y, z = ((data.geom_xpos - data.cam_xpos[camera]) @ data.cam_xmat[camera].reshape(3, 3)).T
        half = np.tan(np.radians(model.cam_fovy[camera]) / 2)
        side, radius = half * aspect, model.geom_rbound
        low, high = (half * share for share in rows)
        seen = np.abs(x) < radius * np.hypot(1, side) - z * side
        seen &= (y < radius * np.hypot(1, high) - z * high) & (-y < radius * np.hypot(1, low) + z * low)
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
            self._gl[width, height] = Offscreen(self.model, self.backend, width, height)
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
