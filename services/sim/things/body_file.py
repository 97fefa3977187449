"""A body from any MJCF file: what it looks like and what collides, as one rigid object of our world.

Joints stay where the file has them. Geoms that touch nothing are only looked at; where there are none, those that
collide are. A file without colliding geoms, and a hollow mesh that is looked at as well, gets convex parts of what it
looks like: by CoACD (the extra `convex`), or else the convex hull.
"""

from functools import cache
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from common.files.body_file import load, middle, standing
from common.geometry import Array
from common.rendering.encode import png
from common.scene import ObjectSpec, body_name
from services.sim.robot import HULL_GROUP
from services.sim.things.convex import hollow, parts
from services.sim.things.mesh import xml
from services.sim.things.primitives import CONTACT, GROUP
from services.sim.things.thinning import FACES, corners, simplified

PIXELS = 512
"""Longest side of a texture: from 0.3 m a camera of 640 px sees 2 pixels a millimetre."""
USUAL_DENSITY = 300.0
"""Mass over the volume of the bounding box [kg/m^3] of what has none of its own; chosen: groceries have 150 to 900."""
LEAST_DENSITY = 40.0
"""Mass over the volume of the bounding box [kg/m^3] below which a model is called implausibly light: an empty carton
has 60."""


class Built:
    """`geoms` of the body, `assets` of the model, `files` by name, and `warning` when something is odd."""

    def __init__(self, spec: ObjectSpec) -> None:
        self.assets, self.geoms, self.warning = "", "", ""
        self.files: dict[str, bytes] = {}
        self._spec, self._name = spec, body_name(spec)
        self._model, self._data = load(Path(spec.model))
        self._turn = standing(spec.up)
        self._middle = middle(self._model, self._data, self._turn)
        self._made: set[str] = set()
        seen, solid = _roles(self._model)
        looks = {int(self._model.geom_dataid[g]) for g in seen if self._model.geom_dataid[g] >= 0}
        self._share = FACES / max(FACES, sum(int(self._model.mesh_facenum[n]) for n in looks))
        for g in seen:
            self._look(g)
        if solid:
            for g in solid:
                # What is looked at and collides at once was drawn as it is to be, whatever MuJoCo's hull makes of it.
                if g in seen and self._is_hollow(g):
                    self._hulls([g])
                else:
                    self._solid(g)
        else:
            self._hulls(seen)
        x, y, z = spec.size
        volume = x * y * z
        self.mass = spec.mass or float(self._model.body_subtreemass[0])
        told = f"{spec.name}: {100 * x:.0f} x {100 * y:.0f} x {100 * z:.0f} cm"
        if not self.mass:
            self.mass = USUAL_DENSITY * volume
            self.warning = f"{told} have no mass in {spec.model}; {1000 * self.mass:.0f} g are taken"
        elif self.mass < LEAST_DENSITY * volume:
            self.warning = f"{told} are implausibly light with {1000 * self.mass:.0f} g"
        if self.warning:
            self.warning += "; the world file may give its `mass`"

    @property
    def inertia(self) -> str:
        """Mass, and moments of a solid box of the object's extents."""
        x, y, z = (v * v for v in self._spec.size)
        moments = " ".join(f"{self.mass / 12 * v:.3e}" for v in (y + z, x + z, x + y))
        return f'<inertial pos="0 0 0" mass="{self.mass:.5f}" diaginertia="{moments}"/>'

    def _place(self, g: int) -> str:
        at = self._turn @ self._data.geom_xpos[g] - self._middle
        quat = np.zeros(4)
        mujoco.mju_mat2Quat(quat, (self._turn @ self._data.geom_xmat[g].reshape(3, 3)).ravel())
        return f'pos="{_text(at, 6)}" quat="{_text(quat, 6)}"'

    def _look(self, g: int) -> None:
        model = self._model
        material, rgba = int(model.geom_matid[g]), model.geom_rgba[g].copy()
        kind, extra = _TYPES[int(model.geom_type[g])], ""
        if material >= 0:
            rgba = model.mat_rgba[material].copy()
            extra = f' material="{self._material(material)}"'
        rgba[3] = 1.0
        colour = "" if extra else f' rgba="{_text(rgba, 3)}"'
        shape = f'size="{_text(model.geom_size[g], 6)}"'
        if kind == "mesh":
            shape = f'mesh="{self._mesh(int(model.geom_dataid[g]))}"'
        self.geoms += (
            f'<geom type="{kind}" {shape} {self._place(g)}{colour}{extra} group="{GROUP}" contype="0" conaffinity="0" '
            'mass="0"/>'
        )

    def _solid(self, g: int) -> None:
        model = self._model
        kind = _TYPES[int(model.geom_type[g])]
        shape = f'size="{_text(model.geom_size[g], 6)}"'
        if kind == "mesh":
            shape = f'mesh="{self._hull(*corners(model, int(model.geom_dataid[g])))}"'
        self._collider(f'type="{kind}" {shape} {self._place(g)}')

    def _is_hollow(self, g: int) -> bool:
        mesh = int(self._model.geom_dataid[g])
        return _TYPES[int(self._model.geom_type[g])] == "mesh" and hollow(*corners(self._model, mesh))

    def _hulls(self, seen: list[int]) -> None:
        """Convex parts of everything that is looked at."""
        for g in seen:
            if _TYPES[int(self._model.geom_type[g])] != "mesh":
                self._solid(g)
                continue
            for vertices, faces in parts(*corners(self._model, int(self._model.geom_dataid[g]))):
                self._collider(f'type="mesh" mesh="{self._hull(vertices, faces)}" {self._place(g)}')

    def _collider(self, shape: str) -> None:
        self.geoms += f'<geom {shape} mass="0" group="{HULL_GROUP}" {CONTACT} conaffinity="3"/>'

    def _hull(self, vertices: Array, faces: NDArray[np.int64]) -> str:
        name = f"hull_{self._name}_{len(self._made)}"
        self._made.add(name)
        corners, triangles = _text(vertices, 6), _text(faces)
        self.assets += f'<mesh name="{name}" inertia="shell" vertex="{corners}" face="{triangles}"/>'
        return name

    def _mesh(self, number: int) -> str:
        name = f"look_{self._name}_{number}"
        if name not in self._made:
            self._made.add(name)
            self.assets += xml(name, simplified(self._model, number, self._share))
        return name

    def _material(self, number: int) -> str:
        name = f"skin_{self._name}_{number}"
        if name in self._made:
            return name
        self._made.add(name)
        model = self._model
        rgba, texture = model.mat_rgba[number].copy(), _texture_of(model, number)
        rgba[3] = 1.0
        picture = ""
        if texture >= 0:
            self.files[f"{name}.png"] = _png(model, texture)
            self.assets += f'<texture name="{name}" type="2d" file="{name}.png"/>'
            picture = f' texture="{name}"'
        self.assets += (
            f'<material name="{name}"{picture} rgba="{_text(rgba, 3)}" specular="{model.mat_specular[number]:.3f}" '
            f'shininess="{model.mat_shininess[number]:.3f}"/>'
        )
        return name


@cache
def built(spec: ObjectSpec, changed: float) -> Built:
    """The body of an object whose file was `changed` last [s]."""
    return Built(spec)


def body(spec: ObjectSpec) -> Built:
    """The body of an object that names a file."""
    return built(spec, Path(spec.model).stat().st_mtime)


_TYPES = {
    int(t): t.name.removeprefix("mjGEOM_").lower()
    for t in (
        mujoco.mjtGeom.mjGEOM_SPHERE, mujoco.mjtGeom.mjGEOM_CAPSULE, mujoco.mjtGeom.mjGEOM_ELLIPSOID,
        mujoco.mjtGeom.mjGEOM_CYLINDER, mujoco.mjtGeom.mjGEOM_BOX, mujoco.mjtGeom.mjGEOM_MESH,
    )
}  # fmt: skip
SEE_THROUGH = 0.5
"""Opacity below which a colliding geom beside others is a collision shape that was made visible for debugging."""


def _roles(model: Any) -> tuple[list[int], list[int]]:
    """The geoms that are looked at, and those that collide."""
    usable = [g for g in range(model.ngeom) if int(model.geom_type[g]) in _TYPES]
    solid = [g for g in usable if model.geom_contype[g] or model.geom_conaffinity[g]]
    seen = [g for g in usable if g not in solid]
    if seen or not solid:
        return seen, solid
    opaque = [g for g in solid if _opacity(model, g) >= SEE_THROUGH]
    clear = [g for g in solid if g not in opaque]
    return (opaque, clear) if opaque and clear else (solid, solid)


def _opacity(model: Any, g: int) -> float:
    material = int(model.geom_matid[g])
    return float(model.mat_rgba[material, 3] if material >= 0 else model.geom_rgba[g, 3])


def _texture_of(model: Any, material: int) -> int:
    """The picture of a material, -1 for none."""
    found = np.ravel(model.mat_texid[material])
    role = int(mujoco.mjtTextureRole.mjTEXROLE_RGB)
    return int(found[role]) if found[role] >= 0 else int(found.max())


def _png(model: Any, number: int) -> bytes:
    width, height, depth = (int(v[number]) for v in (model.tex_width, model.tex_height, model.tex_nchannel))
    at = int(model.tex_adr[number])
    data = np.array(model.tex_data[at : at + width * height * depth], np.uint8).reshape(height, width, depth)
    image = Image.fromarray(np.ascontiguousarray(data[..., :3]))
    image.thumbnail((PIXELS, PIXELS), Image.Resampling.LANCZOS)
    return png(image)


def _text(values: Any, digits: int = 0) -> str:
    return " ".join(f"{v:g}" for v in np.round(values, digits).ravel().tolist())
