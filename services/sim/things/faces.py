"""The outside of a thing that has print or a pattern: a mesh to look at over the geoms that collide."""

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from common.kinds import PLATE_FOOT, kind_of
from common.scene import ObjectSpec, body_name
from services.sim.robot import HULL_GROUP
from services.sim.things import mesh, texture
from services.sim.things.primitives import GROUP

Points = list[tuple[float, float]]
FLOOR = 0.006
"""Thickness [m] of the bottom of mugs, bowls and plates."""
HANDLE = 0.0048
"""Half the thickness [m] of a mug's handle."""


class Face(NamedTuple):
    """MJCF of one thing's face: its assets, its geom, and its picture by file name."""

    assets: str
    geom: str
    files: dict[str, bytes]


class _Outline(NamedTuple):
    """The printed part of an outline and the rest of it, from the bottom's middle outside and up, then inside down."""

    printed: Points
    plain: list[Points]


def has_face(spec: ObjectSpec) -> bool:
    """True for an object with print or a pattern on it."""
    return bool(spec.label) or spec.pattern != "plain"


def hidden(geoms: str) -> str:
    """The geoms changed so that they collide and are not drawn."""
    return geoms.replace(f'group="{GROUP}"', f'group="{HULL_GROUP}"')


def face(spec: ObjectSpec) -> Face:
    """Mesh, material and picture of a thing."""
    name = f"face_{body_name(spec)}"
    ground, second = texture.rgb(spec.rgba), texture.rgb(spec.second or (0.92, 0.92, 0.90, 1.0))
    if kind_of(spec.kind).shape == "box":
        shape = mesh.box(spec.size)
        png = texture.sides(spec.label, ground, second, spec.pattern, spec.size, spine=spec.kind == "book")
    else:
        outline = _outline(spec)
        shape = _turned(spec, outline)
        heights = [h for _, h in outline.printed]
        around = math.pi * spec.size[0]
        png = texture.around(spec.label, ground, second, spec.pattern, around, max(heights) - min(heights))
    share = 0.5 + spec.gloss / 2
    assets = (
        f'<texture name="{name}" type="2d" file="{name}.png"/><material name="{name}" texture="{name}" '
        f'specular="{share:g}" shininess="{share:g}"/>{mesh.xml(name, shape)}'
    )
    geom = f'<geom type="mesh" mesh="{name}" material="{name}" group="{GROUP}" contype="0" conaffinity="0" mass="0"/>'
    return Face(assets, geom, {f"{name}.png": png})


def _turned(spec: ObjectSpec, outline: _Outline) -> mesh.Mesh:
    """The solid of revolution, its middle at the origin."""
    heights = [h for _, h in outline.printed]
    low, high = min(heights), max(heights)
    printed = mesh.turned(list(pairwise(outline.printed)), low, high, texture.TRIM)
    parts = [printed]
    for points in outline.plain:
        trim = mesh.turned(list(pairwise(points)), 0.0, 1.0, 0.0)
        parts.append(trim.painted(0.5, texture.TRIM / 2))
    if spec.kind == "mug":
        parts.append(_handle(spec).painted(0.5, texture.TRIM / 2))
    return mesh.joined(parts).moved((0.0, 0.0, -spec.size[2] / 2))


def _handle(spec: ObjectSpec) -> mesh.Mesh:
    r, h = spec.size[0] / 2, spec.size[2]
    angles = np.linspace(-math.pi / 2, math.pi / 2, 14)
    reach = kind_of("mug").handle
    path = np.stack([r - 0.002 + reach * np.cos(angles), np.zeros(14), h / 2 + 0.28 * h * np.sin(angles)], 1)
    return mesh.tube(path, np.full(14, HANDLE))


def _outline(spec: ObjectSpec) -> _Outline:
    kind, r, h = kind_of(spec.kind), spec.size[0] / 2, spec.size[2]
    if kind.shape == "sphere":
        angles = np.linspace(-math.pi / 2, math.pi / 2, 17)
        return _Outline([(r * math.cos(a), h / 2 + h / 2 * math.sin(a)) for a in angles], [])
    match spec.kind:
        case "mug" | "cup":
            inner = r - kind_of("mug").wall
            inside = [(r, h), (inner, h), (inner, FLOOR), (0.0, FLOOR)]
            return _Outline([(r, 0.0), (r, h)], [[(0.0, 0.0), (r, 0.0)], inside])
        case "bowl" | "plate":
            foot = kind.foot(spec.size) if spec.kind == "bowl" else PLATE_FOOT * r
            inside = [(r, h), (r - 0.006, h), (max(foot - 0.004, 0.01), FLOOR), (0.0, FLOOR)]
            return _Outline([(foot, 0.0), (r, h)], [[(0.0, 0.0), (foot, 0.0)], inside])
        case "bottle":
            neck, cap = 0.014, 0.016
            shoulder = [(r, 0.66 * h), (0.8 * r, 0.71 * h), (neck, 0.77 * h), (neck, 0.94 * h)]
            top = [(neck, 0.94 * h), (cap, 0.94 * h), (cap, h), (0.0, h)]
            return _Outline([(r, 0.0), *shoulder], [[(0.0, 0.0), (r, 0.0)], top])
        case "jar":
            lid = [(0.86 * r, 0.82 * h), (0.94 * r, 0.82 * h), (0.94 * r, h), (0.0, h)]
            return _Outline([(r, 0.0), (r, 0.76 * h), (0.86 * r, 0.82 * h)], [[(0.0, 0.0), (r, 0.0)], lid])
        case _:
            rim = [(r, h - 0.004), (0.96 * r, h), (0.90 * r, h), (0.89 * r, h - 0.003), (0.0, h - 0.003)]
            return _Outline([(r, 0.004), (r, h - 0.004)], [[(0.0, 0.0), (0.95 * r, 0.0), (r, 0.004)], rim])
