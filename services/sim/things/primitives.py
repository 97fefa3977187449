"""Building blocks of objects: geoms with material and friction, and round walls of flat pieces."""

import math
from collections.abc import Iterable

from common.scene import ObjectSpec

_CLEAR = 0.3
"""Opacity of what is transparent [-]; chosen: tinted glass or a drink."""
CONTACT = 'condim="4" friction="1 .02 .0005" solref=".005 1" solimp=".95 .99 .001"'
_WALLS = 16
"""Flat pieces of a round wall: across their corners it is 2 % wider than its diameter; with 10 it was 5 %, which the
gripper takes for a bad hold."""
GROUP = 1
"""Geom group of what stands on tables [MuJoCo group]: it does not reach the lidar, whose rays skip the group."""


def material(spec: ObjectSpec) -> str:
    """The name of the material that gives an object its gloss, "" for a matt one."""
    return f"gloss_{round(100 * spec.gloss)}" if spec.gloss else ""


def materials(specs: Iterable[ObjectSpec]) -> str:
    """MJCF of the materials of all glossy objects."""
    shares = {material(spec): 0.5 + spec.gloss / 2 for spec in specs if spec.gloss}
    return "".join(f'<material name="{n}" specular="{s:g}" shininess="{s:g}"/>' for n, s in sorted(shares.items()))


def geom(spec: ObjectSpec, shape: str, share: float, rgba: tuple[float, ...] | None = None) -> str:
    """A geom of an object with a `share` of its mass, in its colour or in `rgba`."""
    red, green, blue, alpha = rgba or spec.rgba
    colour = f"{red:g} {green:g} {blue:g} {min(alpha, _CLEAR) if spec.transparent else alpha:g}"
    looks = f'material="{material(spec)}" rgba="{colour}"' if spec.gloss else f'rgba="{colour}"'
    return f'<geom {shape} mass="{spec.mass * share:.5f}" {looks} group="{GROUP}" {CONTACT} conaffinity="3"/>'


def ring(
    spec: ObjectSpec, radius: float, half: float, thickness: float, lean: float, share: float, widest: float
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
            f'type="box" size="{thickness} {width:.5f} {half}" pos="{r * math.cos(a):.5f} {r * math.sin(a):.5f} 0.0" '
            f'quat="{quat}"'
        )
        parts.append(geom(spec, shape, share / _WALLS))
    return "".join(parts)
