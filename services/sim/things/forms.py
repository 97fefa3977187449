"""Objects that are neither round nor boxes: fruit, toys and tools as bodies of several geoms.

Each is drawn in a box of its own extents `size` (x, y, z), lying or standing as it is found.
"""

from collections.abc import Callable
from itertools import pairwise

from common.floor_plan import Rgba
from common.scene import ObjectSpec
from services.sim.things.primitives import geom

STEEL: Rgba = (0.68, 0.70, 0.73, 1.0)
DARK: Rgba = (0.10, 0.10, 0.11, 1.0)
"""Colours (red, green, blue, opacity, 0 to 1) of metal, and of rubber and bristles."""


def _at(*values: float) -> str:
    return " ".join(f"{v:.5f}" for v in values)


def banana(spec: ObjectSpec) -> str:
    """Four rods along an arc in the plane; x is its length."""
    x, y, z = spec.size
    radius = z / 2
    bend = y - z
    points = [((n / 4 - 0.5) * (x - z), bend * (1 - (n / 2 - 1) ** 2) - bend / 2) for n in range(5)]
    parts = []
    for n, ((x0, y0), (x1, y1)) in enumerate(pairwise(points)):
        thick = radius * (0.82 if n in (0, 3) else 1.0)
        parts.append(geom(spec, f'type="capsule" fromto="{_at(x0, y0, 0, x1, y1, 0)}" size="{thick:.5f}"', 0.25))
    return "".join(parts)


def duck(spec: ObjectSpec) -> str:
    """A body, a head and a beak."""
    x, y, z = spec.size
    second = spec.second or (0.95, 0.55, 0.10, 1.0)
    body = f'type="ellipsoid" size="{_at(0.5 * x, 0.5 * y, 0.3 * z)}" pos="{_at(0, 0, -0.2 * z)}"'
    head = f'type="sphere" size="{0.24 * z:.5f}" pos="{_at(0.2 * x, 0, 0.26 * z)}"'
    beak = f'type="ellipsoid" size="{_at(0.12 * x, 0.12 * y, 0.05 * z)}" pos="{_at(0.2 * x + 0.28 * z, 0, 0.22 * z)}"'
    return geom(spec, body, 0.75) + geom(spec, head, 0.2) + geom(spec, beak, 0.05, second)


def car(spec: ObjectSpec) -> str:
    """A body, a cabin and four wheels that do not turn."""
    x, y, z = spec.size
    wheel = 0.2 * z
    parts = [
        geom(spec, f'type="box" size="{_at(x / 2, 0.42 * y, 0.22 * z)}" pos="{_at(0, 0, -0.16 * z)}"', 0.6),
        geom(spec, f'type="box" size="{_at(0.26 * x, 0.36 * y, 0.22 * z)}" pos="{_at(-0.05 * x, 0, 0.28 * z)}"', 0.2,
             spec.second or STEEL),
    ]  # fmt: skip
    for side in (-1, 1):
        for end in (-1, 1):
            at = _at(end * 0.3 * x, side * 0.44 * y, -z / 2 + wheel)
            shape = f'type="cylinder" size="{_at(wheel, 0.06 * y)}" pos="{at}" euler="1.5708 0 0"'
            parts.append(geom(spec, shape, 0.05, DARK))
    return "".join(parts)


def boat(spec: ObjectSpec) -> str:
    """A hull, a deck house and a funnel."""
    x, y, z = spec.size
    second = spec.second or (0.95, 0.95, 0.93, 1.0)
    hull = f'type="ellipsoid" size="{_at(x / 2, y / 2, 0.3 * z)}" pos="{_at(0, 0, -0.2 * z)}"'
    house = f'type="box" size="{_at(0.2 * x, 0.28 * y, 0.16 * z)}" pos="{_at(-0.05 * x, 0, 0.16 * z)}"'
    funnel = f'type="cylinder" size="{_at(0.07 * x, 0.14 * z)}" pos="{_at(-0.08 * x, 0, 0.36 * z)}"'
    return geom(spec, hull, 0.7) + geom(spec, house, 0.25, second) + geom(spec, funnel, 0.05)


def _handled(spec: ObjectSpec, share: float, head: str) -> str:
    """A round handle along -x, a steel shaft along +x, and what is at its end."""
    x, y, z = spec.size
    grip = min(y, z) / 2
    middle = x * share - x / 2
    handle = f'type="capsule" fromto="{_at(-x / 2 + grip, 0, 0, middle - grip, 0, 0)}" size="{grip:.5f}"'
    shaft = f'type="cylinder" fromto="{_at(middle - grip, 0, 0, x / 2, 0, 0)}" size="{0.35 * grip:.5f}"'
    return geom(spec, handle, 0.6) + geom(spec, shaft, 0.3, STEEL) + head


def screwdriver(spec: ObjectSpec) -> str:
    """A thick handle and a thin shaft."""
    return _handled(spec, 0.45, "")


def hammer(spec: ObjectSpec) -> str:
    """A handle and a head across its end."""
    x, y, z = spec.size
    head = f'type="box" size="{_at(0.08 * x, y / 2, z / 2)}" pos="{_at(x / 2 - 0.08 * x, 0, 0)}"'
    narrow = min(y, z) * 0.36
    handle = f'type="capsule" fromto="{_at(-x / 2 + narrow, 0, 0, x / 2 - 0.1 * x, 0, 0)}" size="{narrow:.5f}"'
    return geom(spec, handle, 0.35) + geom(spec, head, 0.65, STEEL)


def spoon(spec: ObjectSpec) -> str:
    """A flat handle and a bowl."""
    x, y, z = spec.size
    handle = f'type="box" size="{_at(0.36 * x, 0.12 * y, 0.3 * z)}" pos="{_at(-0.14 * x, 0, 0)}"'
    bowl = f'type="ellipsoid" size="{_at(0.16 * x, y / 2, z / 2)}" pos="{_at(0.34 * x, 0, 0)}"'
    return geom(spec, handle, 0.6) + geom(spec, bowl, 0.4)


def brush(spec: ObjectSpec) -> str:
    """A wooden back and bristles below it."""
    x, y, z = spec.size
    back = f'type="box" size="{_at(x / 2, y / 2, 0.22 * z)}" pos="{_at(0, 0, 0.28 * z)}"'
    hair = f'type="box" size="{_at(0.42 * x, 0.42 * y, 0.28 * z)}" pos="{_at(0, 0, -0.22 * z)}"'
    return geom(spec, back, 0.7) + geom(spec, hair, 0.3, spec.second or DARK)


FORMS: dict[str, Callable[[ObjectSpec], str]] = {
    "banana": banana, "duck": duck, "car": car, "boat": boat, "screwdriver": screwdriver, "hammer": hammer,
    "spoon": spoon, "brush": brush,
}  # fmt: skip
