"""Graspable objects as MJCF bodies of primitive geoms, origin at the centre of the bounding box."""

import math
from functools import cache
from typing import NamedTuple

from common.kinds import PLATE_FOOT, kind_of
from common.scene import ObjectSpec, body_name
from services.sim.layout import Placement
from services.sim.things import body_file, faces, forms
from services.sim.things.primitives import geom, ring


def _mug(spec: ObjectSpec) -> str:
    r, h = spec.size[0] / 2, spec.size[2]
    handle = "".join(
        geom(spec, f'type="capsule" fromto="{a}" size="0.0045"', 0.04)
        for a in (
            f"{r - 0.002} 0 {h * 0.28} {r + 0.022} 0 {h * 0.22}",
            f"{r + 0.022} 0 {h * 0.22} {r + 0.022} 0 {-h * 0.20}",
            f"{r + 0.022} 0 {-h * 0.20} {r - 0.002} 0 {-h * 0.28}",
        )
    )
    return _cup(spec, 0.68, 0.2) + handle


def _bowl(spec: ObjectSpec) -> str:
    r, h = spec.size[0] / 2, spec.size[2]
    kind = kind_of(spec.kind)
    base_r = kind.foot(spec.size)
    bottom = geom(spec, f'type="cylinder" size="{base_r + 0.004} 0.005" pos="0 0 {-h / 2 + 0.005}"', 0.3)
    half = h / 2 / math.cos(kind.lean)
    return ring(spec, (r + base_r) / 2, half, kind.wall / 2, kind.lean, 0.7, r) + bottom


def _bottle(spec: ObjectSpec) -> str:
    r, h = spec.size[0] / 2, spec.size[2]
    body, neck = 0.72 * h, 0.22 * h
    return (
        geom(spec, f'type="cylinder" size="{r} {body / 2}" pos="0 0 {-h / 2 + body / 2}"', 0.85)
        + geom(spec, f'type="cylinder" size="0.014 {neck / 2}" pos="0 0 {h / 2 - 0.06 * h - neck / 2}"', 0.1)
        + geom(
            spec, f'type="cylinder" size="0.016 {0.03 * h}" pos="0 0 {h / 2 - 0.03 * h}"', 0.05, (0.9, 0.9, 0.9, 1.0)
        )
    )


def _cup(spec: ObjectSpec, wall: float = 0.75, floor: float = 0.25) -> str:
    """`wall`, `floor`: their shares of the mass."""
    r, h = spec.size[0] / 2, spec.size[2]
    bottom = geom(spec, f'type="cylinder" size="{r - 0.003} 0.004" pos="0 0 {-h / 2 + 0.004}"', floor)
    return ring(spec, r, h / 2, kind_of("mug").wall / 2, 0.0, wall, r) + bottom


def _plate(spec: ObjectSpec) -> str:
    r, h = spec.size[0] / 2, spec.size[2]
    foot = PLATE_FOOT * r
    bottom = geom(spec, f'type="cylinder" size="{foot + 0.003} 0.003" pos="0 0 {-h / 2 + 0.003}"', 0.5)
    half, lean = math.hypot(r - foot, h) / 2, math.atan2(r - foot, h)
    return ring(spec, (r + foot) / 2, half, 0.0025, lean, 0.5, r) + bottom


_BODIES = {
    "mug": _mug,
    "bowl": _bowl,
    "bottle": _bottle,
    "cup": _cup,
    "plate": _plate,
}
"""Bodies of several geoms; every other kind is the solid of its row in `common.kinds`."""


def geoms(spec: ObjectSpec) -> str:
    """The geoms of one object that collide, and are seen where nothing is drawn over them."""
    if spec.form is not None:
        return forms.FORMS[spec.form](spec)
    if spec.kind in _BODIES:
        return _BODIES[spec.kind](spec)
    x, y, z = (v / 2 for v in spec.size)
    shape = kind_of(spec.kind).shape
    if shape == "sphere":
        ball = f'type="sphere" size="{x}"' if x == y == z else f'type="ellipsoid" size="{x} {y} {z}"'
        return geom(spec, ball, 1.0).replace('condim="4"', 'condim="6"')
    if shape == "turned":
        return geom(spec, f'type="cylinder" size="{x} {z}"', 1.0)
    return geom(spec, f'type="box" size="{x} {y} {z}"', 1.0)


class Made(NamedTuple):
    """What one object adds to the model: geoms (and mass) of its body, assets, and pictures by file name."""

    geoms: str
    assets: str = ""
    files: dict[str, bytes] = {}
    warning: str = ""


@cache
def made(spec: ObjectSpec) -> Made:
    """The object's body: from its file, or its kind's, with a face where it has one."""
    if spec.model:
        body = body_file.body(spec)
        return Made(body.inertia + body.geoms, body.assets, body.files, body.warning)
    if not faces.has_face(spec):
        return Made(geoms(spec))
    face = faces.face(spec)
    return Made(faces.hidden(geoms(spec)) + face.geom, face.assets, face.files)


def body_xml(placed: Placement) -> str:
    """A free body at its pose."""
    name = body_name(placed.spec)
    pos, quat = (" ".join(map(str, values)) for values in (placed.position, placed.quat))
    return f'<body name="{name}" pos="{pos}" quat="{quat}"><freejoint name="{name}"/>{made(placed.spec).geoms}</body>'
