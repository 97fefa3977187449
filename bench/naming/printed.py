"""Packages with printed fronts for benches: cartons and cans in families that look alike, as one MuJoCo model.

The members of a family have one shape, one size within 3 % and one ground colour; the print and the band differ.
"""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

SIDES = 32
"""Flat faces of a can."""
TEXTURE = (512, 768)
"""Pixels of a front, width and height."""
PRODUCTS = (
    ("tomato soup", "potato soup", "onion soup"), ("corn flakes", "bran flakes", "oat flakes"),
    ("green tea", "black tea", "mint tea"), ("orange juice", "apple juice", "grape juice"),
    ("vitamin forte", "iron complex", "magnesium"), ("plum jam", "cherry jam", "peach jam"),
    ("baking powder", "custard powder", "cocoa powder"), ("sea salt", "brown sugar", "rice flour"),
)  # fmt: skip
GROUNDS = ((196, 40, 38), (235, 200, 60), (240, 240, 232), (70, 120, 190), (60, 130, 80), (225, 225, 225))
INKS = ((250, 250, 245), (30, 30, 40), (180, 30, 30), (20, 70, 150), (30, 110, 50), (240, 190, 20), (120, 40, 120))
FAR = -50.0
"""Where [m] what is not shown stands."""


@dataclass(frozen=True)
class Package:
    """One product: its `words`, whether it is a can, full extents [m] (depth, width, height), and its family."""

    words: str
    can: bool
    size: tuple[float, float, float]
    family: int


def packages(seed: int, folder: Path) -> tuple[list[Package], str]:
    """The packages of a seed and the model that has them, each a free body named after its number.

    The model has a table top at 0.75 m, lamps, and the camera `head` at 1.30 m, which looks along x, 0.62 rad down.
    """
    rng = np.random.default_rng(seed)
    found: list[Package] = []
    assets, bodies = "", ""
    for family, products in enumerate(PRODUCTS):
        can = bool(rng.random() < 0.4)
        width, height = rng.uniform(0.06, 0.075) if can else rng.uniform(0.055, 0.12), rng.uniform(0.09, 0.2)
        depth = width if can else rng.uniform(0.03, 0.07)
        ground = GROUNDS[rng.integers(len(GROUNDS))]
        for words in products:
            n, scale = len(found), rng.uniform(0.985, 1.015)
            size = (depth * scale, width * scale, height * scale)
            found.append(Package(words, can, size, family))
            path = folder / f"{seed}-{n}.png"
            _front(words, ground, rng).save(path)
            vertices, texture, faces = _can(size) if can else _carton(size)
            shine = rng.uniform(0.0, 0.6)
            assets += (
                f'<texture name="t{n}" type="2d" file="{path}"/>'
                f'<material name="m{n}" texture="t{n}" specular="{shine}" shininess="{shine}"/>'
                f'<mesh name="g{n}" vertex="{_row(vertices)}" texcoord="{_row(texture)}" face="{_row(faces)}"/>'
            )
            bodies += (
                f'<body name="p{n}" pos="{FAR} {n} 0"><freejoint/>'
                f'<geom type="mesh" mesh="g{n}" material="m{n}" density="300"/></body>'
            )
    return (
        found,
        f"""<mujoco><compiler meshdir="/" texturedir="/"/>
      <visual><headlight ambient="0.4 0.4 0.4" diffuse="0.2 0.2 0.2"/>
      <global offwidth="1280" offheight="960"/></visual>
      <asset>{assets}</asset>
      <worldbody><light name="lamp" pos="0 0 2.4" directional="false" diffuse="0.7 0.7 0.7"/>
      <camera name="head" pos="0 0 1.30" xyaxes="0 -1 0 {math.sin(0.62)} 0 {math.cos(0.62)}" fovy="62"/>
      <geom type="box" size="3 2 0.02" pos="2 0 0.73" rgba="0.62 0.5 0.38 1"/>
      <geom type="plane" size="9 9 1" rgba="0.8 0.78 0.74 1"/>{bodies}</worldbody></mujoco>""",
    )


def _front(words: str, ground: tuple[int, int, int], rng: np.random.Generator) -> Image.Image:
    """A label: the words on its ground, a band below, a picture of some kind."""
    width, height = TEXTURE
    picture = Image.new("RGB", TEXTURE, ground)
    draw = ImageDraw.Draw(picture)
    band, ink = (INKS[i] for i in rng.choice(len(INKS), 2, replace=False))
    if abs(sum(ink) - sum(ground)) < 200:  # nobody prints what cannot be read
        ink = (20, 20, 20) if sum(ground) > 380 else (250, 250, 250)
    top = int(height * rng.uniform(0.62, 0.8))
    draw.rectangle((0, top, width, top + int(height * rng.uniform(0.08, 0.2))), fill=band)
    x, y, r = width * rng.uniform(0.3, 0.7), height * rng.uniform(0.45, 0.55), width * rng.uniform(0.08, 0.16)
    draw.ellipse((x - r, y - r, x + r, y + r), fill=INKS[rng.integers(len(INKS))])
    for line, word in enumerate(words.upper().split()):
        size = min(120, int(1.55 * width * 0.9 / len(word)))
        font = ImageFont.load_default(size)
        draw.text((width / 2, height * (0.12 + 0.17 * line)), word, font=font, fill=ink, anchor="mm")
    draw.text(
        (width / 2, height * 0.95),
        f"{rng.integers(1, 9) * 50} g",
        font=ImageFont.load_default(40),
        fill=ink,
        anchor="mm",
    )
    return picture


def _carton(size: tuple[float, float, float]) -> tuple[list[float], list[float], list[int]]:
    """A box whose four upright faces show the front, its lid and bottom the ground."""
    x, y, z = (v / 2 for v in size)
    a, b, c, d = (-x, -y), (x, -y), (x, y), (-x, y)
    walls = [(b, c, True), (d, a, True), (c, d, False), (a, b, False)]
    faces = [([(*p, -z), (*q, -z), (*q, z), (*p, z)], printed) for p, q, printed in walls]
    faces += [([(*p, z) for p in (a, b, c, d)], False), ([(*p, -z) for p in (d, c, b, a)], False)]
    vertices: list[float] = []
    texture: list[float] = []
    triangles: list[int] = []
    for n, (corners, printed) in enumerate(faces):
        vertices += [v for corner in corners for v in corner]
        # The sides show the upper strip and the band alone: 5 % of the width, stretched.
        texture += [0, 1, 1, 1, 1, 0, 0, 0] if printed else [0.01, 1, 0.06, 1, 0.06, 0, 0.01, 0]
        triangles += [4 * n, 4 * n + 1, 4 * n + 2, 4 * n, 4 * n + 2, 4 * n + 3]
    return vertices, texture, triangles


def _can(size: tuple[float, float, float]) -> tuple[list[float], list[float], list[int]]:
    """A cylinder; the front goes around 40 % of it, twice."""
    radius, half = size[1] / 2, size[2] / 2
    vertices: list[float] = []
    texture: list[float] = []
    triangles: list[int] = []
    for n in range(SIDES):
        a, b = (2 * math.pi * (n + k) / SIDES for k in (0, 1))
        start = 4 * n
        for angle, k in ((a, n), (b, n + 1)):
            u = _around(k / SIDES)
            for z, v in ((-half, 1.0), (half, 0.0)):
                vertices += [radius * math.cos(angle), radius * math.sin(angle), z]
                texture += [u, v]
        triangles += [start, start + 2, start + 3, start, start + 3, start + 1]
    for z in (half, -half):
        middle = len(vertices) // 3
        vertices += [0.0, 0.0, z]
        texture += [0.01, 0.3]
        for n in range(SIDES):
            angle = 2 * math.pi * n / SIDES
            vertices += [radius * math.cos(angle), radius * math.sin(angle), z]
            texture += [0.01, 0.3]
        for n in range(SIDES):
            one, two = middle + 1 + n, middle + 1 + (n + 1) % SIDES
            triangles += [middle, one, two] if z > 0 else [middle, two, one]
    return vertices, texture, triangles


def _around(share: float) -> float:
    """Texture coordinate at a share of the way around: the front at 0 and at 0.5, its edge's colour between."""
    offset = (share + 0.25) % 0.5 - 0.25
    return min(1.0, max(0.0, 0.5 + offset / 0.4))


def _row(values: list[float] | list[int]) -> str:
    return " ".join(f"{v:.6g}" for v in values)
