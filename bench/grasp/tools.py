"""Shapes that no kind of the simulation has, for `python -m bench.grasp --unknown`: hoops, thin blades, wires, handles.

Each is an MJCF file of primitives, in metres, with z upwards as it rests.
"""

import functools
import itertools
import math
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from common.files.body_file import extents
from common.scene import ObjectSpec

SPREAD = (0.85, 1.15)
"""Smallest and largest size, as a share of what is written here."""


def _geom(kind: str, size: tuple[float, ...], at: tuple[float, ...], more: str = "") -> str:
    sizes, place = (" ".join(f"{v:.5f}" for v in values) for values in (size, at))
    return f'<geom type="{kind}" size="{sizes}" pos="{place}" {more}/>'


def _wire(points: list[tuple[float, float, float]], radius: float) -> str:
    """Round rods from point to point."""
    found = ""
    for a, b in itertools.pairwise(points):
        ends = " ".join(f"{v:.5f}" for v in (*a, *b))
        found += f'<geom type="capsule" size="{radius:.5f}" fromto="{ends}"/>'
    return found


def _arc(
    turns: Iterator[float], place: Callable[[float, float], tuple[float, float, float]]
) -> list[tuple[float, ...]]:
    return [place(math.cos(t), math.sin(t)) for t in turns]


def _hoop(k: float) -> str:
    """A basket with a hoop of 11 mm over it."""
    points = _arc(iter(np.linspace(0, math.pi, 9)), lambda c, s: (0.055 * k * c, 0.0, (0.05 + 0.075 * s) * k))
    walls = [((x, y), (0.004 if x else 0.06, 0.004 if y else 0.045)) for x, y in ((1, 0), (-1, 0), (0, 1), (0, -1))]
    box = "".join(
        _geom("box", (k * w, k * d, 0.025 * k), (0.056 * k * x, 0.041 * k * y, 0.025 * k)) for (x, y), (w, d) in walls
    )
    return box + _geom("box", (0.06 * k, 0.045 * k, 0.003), (0, 0, 0.003)) + _wire(points, 0.0055)


def _can(k: float) -> str:
    """A watering can: a body too wide for the hand, a handle of 14 mm behind and a spout before it."""
    handle = [(-0.05 * k, 0, 0.09 * k), (-0.1 * k, 0, 0.085 * k), (-0.1 * k, 0, 0.035 * k), (-0.05 * k, 0, 0.025 * k)]
    body = _geom("cylinder", (0.055 * k, 0.055 * k), (0, 0, 0.055 * k))
    return body + _wire(handle, 0.007) + _wire([(0.05 * k, 0, 0.03 * k), (0.13 * k, 0, 0.11 * k)], 0.008)


def _scissors(k: float) -> str:
    """Two blades of 4 mm, crossed, and two eyes of rods of 7."""
    blades = "".join(_geom("box", (0.05 * k, 0.008, 0.002), (0.05 * k, 0, 0.005), f'euler="0 0 {a}"') for a in (6, -6))
    turns = np.linspace(0, math.tau, 9)
    eyes = "".join(
        _wire(_arc(iter(turns), lambda c, s, y=y: ((-0.045 + 0.024 * c) * k, (y + 0.017 * s) * k, 0.005)), 0.0045)
        for y in (0.024, -0.024)
    )
    return blades + eyes + _geom("box", (0.025 * k, 0.009 * k, 0.003), (0, 0, 0.005))


def _whisk(k: float) -> str:
    """A handle of 18 mm and six wires of 3 that bulge to 60."""
    along = np.linspace(0, 1, 8)
    wires = ""
    for turn in np.arange(3) * math.pi / 3:
        for side in (1, -1):
            shape = [(s, 0.03 * side * math.sin(math.pi * s**0.7)) for s in along]
            wires += _wire(
                [((0.11 * s) * k, b * math.cos(turn) * k, b * math.sin(turn) * k + 0.03 * k) for s, b in shape], 0.0018
            )
    return wires + _wire([(-0.12 * k, 0, 0.016 * k), (0, 0, 0.03 * k)], 0.009)


def _spatula(k: float) -> str:
    """A flat blade of 3 mm and a flat handle of 9."""
    blade = _geom("box", (0.05 * k, 0.035 * k, 0.0015), (0.07 * k, 0, 0.0045))
    return blade + _geom("box", (0.09 * k, 0.009 * k, 0.0045), (-0.06 * k, 0, 0.0045))


def _teacup(k: float) -> str:
    """A low cup with a wide mouth, of flat walls, and a handle of 8 mm."""
    walls = ""
    for turn in np.arange(12) * math.tau / 12:
        x, y = 0.042 * k * math.cos(turn), 0.042 * k * math.sin(turn)
        walls += _geom("box", (0.002, 0.0116 * k, 0.03 * k), (x, y, 0.03 * k), f'euler="0 0 {math.degrees(turn):.2f}"')
    handle = [(0.042 * k, 0, 0.048 * k), (0.066 * k, 0, 0.044 * k), (0.066 * k, 0, 0.02 * k), (0.042 * k, 0, 0.015 * k)]
    return walls + _geom("cylinder", (0.04 * k, 0.003), (0, 0, 0.003)) + _wire(handle, 0.004)


def _tray(k: float) -> str:
    """A flat open box with walls of 5 mm, wider than the hand either way."""
    walls = [((x, y), (0.0025 if x else 0.09, 0.0025 if y else 0.065)) for x, y in ((1, 0), (-1, 0), (0, 1), (0, -1))]
    sides = "".join(
        _geom("box", (w * (k if w > 0.01 else 1), d * (k if d > 0.01 else 1), 0.02 * k),
              (0.0875 * k * x, 0.0625 * k * y, 0.02 * k))
        for (x, y), (w, d) in walls
    )  # fmt: skip
    return sides + _geom("box", (0.09 * k, 0.065 * k, 0.002), (0, 0, 0.002))


TOOLS: dict[str, tuple[Callable[[float], str], float]] = {
    "hoop": (_hoop, 0.18), "watering can": (_can, 0.3), "scissors": (_scissors, 0.08), "whisk": (_whisk, 0.12),
    "spatula": (_spatula, 0.09), "teacup": (_teacup, 0.16), "open tray": (_tray, 0.25),
}  # fmt: skip
"""Geoms by size, and mass [kg]."""


def tool(name: str, shape: str, rng: np.random.Generator) -> ObjectSpec:
    """An object of that shape, its size drawn."""
    make, mass = TOOLS[shape]
    k = float(rng.uniform(*SPREAD))
    path = Path(_folder()) / f"{shape} {k}.xml"
    path.write_text(f'<mujoco><worldbody><body name="{shape}">{make(k)}</body></worldbody></mujoco>')
    return ObjectSpec(
        name=name,
        kind="",
        colour="grey",
        size=extents(path, "z"),
        mass=mass,
        model=str(path),
        rgba=(0.5, 0.5, 0.5, 1.0),
    )


@functools.cache
def _folder() -> str:
    return tempfile.mkdtemp(prefix="bench-grasp-")
