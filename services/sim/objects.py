"""Graspable objects as MJCF bodies of primitive geoms, origin at the centre of the bounding box."""

import math
from collections.abc import Iterable

from common.kinds import kind_of
from common.scene import ObjectSpec, body_name
from services.sim.layout import Placement

_CONTACT = 'condim="4" friction="1 .02 .0005" solref=".005 1" solimp=".95 .99 .001"'
_CLEAR = 0.3
"""Opacity of what is transparent [-]; chosen: tinted glass or a drink."""
_WALLS = 16
"""Flat pieces of a round wall: across their corners it is 2 % wider than its diameter; with 10 it was 5 %, which the
gripper takes for a bad hold."""
# Nothing that stands on a table reaches the lidar: its rays skip this group.
GROUP = 1


def material(spec: ObjectSpec) -> str:
    """The name of the material that gives an object its gloss, "" for a matt one."""
    return f"gloss_{round(100 * spec.gloss)}" if spec.gloss else ""


def materials(specs: Iterable[ObjectSpec]) -> str:
    """The materials of all objects that shine: a highlight as strong and as small as they are glossy."""
    shares = {material(spec): 0.5 + spec.gloss / 2 for spec in specs if spec.gloss}
    return "".join(f'<material name="{n}" specular="{s:g}" shininess="{s:g}"/>' for n, s in sorted(shares.items()))


def _geom(spec: ObjectSpec, shape: str, share: float, rgba: tuple[float, ...] | None = None) -> str:
    red, green, blue, alpha = rgba or spec.rgba
    colour = f"{red:g} {green:g} {blue:g} {min(alpha, _CLEAR) if spec.transparent else alpha:g}"
    looks = f'material="{material(spec)}" rgba="{colour}"' if spec.gloss else f'rgba="{colour}"'
    return f'<geom {shape} mass="{spec.mass * share:.5f}" {looks} group="{GROUP}" {_CONTACT} conaffinity="3"/>'


def _ring(
    spec: ObjectSpec, radius: float, half: float, z: float, thickness: float, lean: float, share: float, widest: float
) -> str:
    """A wall of boxes around the z axis, closed up to the radius `widest`; `lean` tilts each outward."""
    width = widest * math.tan(math.pi / _WALLS) * 1.02
    parts = []
    for k in range(_WALLS):
        a = 2 * math.pi * k / _WALLS
        r = radius - thickness
        # First the tilt about the wall's own y axis, then the turn about the object's z axis.
        ca, sa, cl, sl = math.cos(a / 2), math.sin(a / 2), math.cos(lean / 2), math.sin(lean / 2)
        quat = f"{ca * cl:.6f} {-sa * sl:.6f} {ca * sl:.6f} {sa * cl:.6f}"
        shape = (
            f'type="box" size="{thickness} {width:.5f} {half}" pos="{r * math.cos(a):.5f} {r * math.sin(a):.5f} {z}" '
            f'quat="{quat}"'
        )
        parts.append(_geom(spec, shape, share / _WALLS))
    return "".join(parts)


def _mug(spec: ObjectSpec) -> str:
    r, h = spec.size[0] / 2, spec.size[2]
    bottom = _geom(spec, f'type="cylinder" size="{r - 0.003} 0.004" pos="0 0 {-h / 2 + 0.004}"', 0.2)
    handle = "".join(
        _geom(spec, f'type="capsule" fromto="{a}" size="0.0045"', 0.04)
        for a in (
            f"{r - 0.002} 0 {h * 0.28} {r + 0.022} 0 {h * 0.22}",
            f"{r + 0.022} 0 {h * 0.22} {r + 0.022} 0 {-h * 0.20}",
            f"{r + 0.022} 0 {-h * 0.20} {r - 0.002} 0 {-h * 0.28}",
        )
    )
    return _ring(spec, r, h / 2, 0.0, kind_of(spec.kind).wall / 2, 0.0, 0.68, r) + bottom + handle


def _bowl(spec: ObjectSpec) -> str:
    r, h = spec.size[0] / 2, spec.size[2]
    kind = kind_of(spec.kind)
    base_r = kind.foot(spec.size)
    bottom = _geom(spec, f'type="cylinder" size="{base_r + 0.004} 0.005" pos="0 0 {-h / 2 + 0.005}"', 0.3)
    half = h / 2 / math.cos(kind.lean)
    return _ring(spec, (r + base_r) / 2, half, 0.0, kind.wall / 2, kind.lean, 0.7, r) + bottom


def _bottle(spec: ObjectSpec) -> str:
    r, h = spec.size[0] / 2, spec.size[2]
    body, neck = 0.72 * h, 0.22 * h
    return (
        _geom(spec, f'type="cylinder" size="{r} {body / 2}" pos="0 0 {-h / 2 + body / 2}"', 0.85)
        + _geom(spec, f'type="cylinder" size="0.014 {neck / 2}" pos="0 0 {h / 2 - 0.06 * h - neck / 2}"', 0.1)
        + _geom(
            spec, f'type="cylinder" size="0.016 {0.03 * h}" pos="0 0 {h / 2 - 0.03 * h}"', 0.05, (0.9, 0.9, 0.9, 1.0)
        )
    )


_BODIES = {
    "mug": _mug,
    "bowl": _bowl,
    "bottle": _bottle,
}
"""Bodies of several geoms; every other kind is the solid of its row in `common.kinds`."""


def geoms(spec: ObjectSpec) -> str:
    """The geoms of one object."""
    if spec.kind in _BODIES:
        return _BODIES[spec.kind](spec)
    x, y, z = (v / 2 for v in spec.size)
    shape = kind_of(spec.kind).shape
    if shape == "sphere":
        return _geom(spec, f'type="sphere" size="{x}"', 1.0).replace('condim="4"', 'condim="6"')
    if shape == "turned":
        return _geom(spec, f'type="cylinder" size="{x} {z}"', 1.0)
    return _geom(spec, f'type="box" size="{x} {y} {z}"', 1.0)


def body_xml(placed: Placement) -> str:
    """A free body at its pose."""
    name = body_name(placed.spec)
    pos, quat = (" ".join(map(str, values)) for values in (placed.position, placed.quat))
    return f'<body name="{name}" pos="{pos}" quat="{quat}"><freejoint name="{name}"/>{geoms(placed.spec)}</body>'
