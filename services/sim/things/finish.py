"""Textures of floors, walls and table tops, repeating every metre. Pure."""

from functools import cache

import numpy as np

from common.geometry import Array
from common.rendering.encode import png

SIZE = 256
"""Pixels of a metre: 4 mm each, finer than a camera sees from 1 m."""
GRAIN: dict[str, tuple[int, float, float]] = {
    # Seed, how coarse the grain is [px], and how much it changes the shade.
    "wood": (1, 3.0, 0.10), "tile": (2, 1.0, 0.02), "carpet": (3, 0.7, 0.10), "plaster": (4, 5.0, 0.03),
    "stripes": (5, 2.0, 0.02), "brick": (6, 2.0, 0.08), "cloth": (7, 0.8, 0.05), "stone": (8, 9.0, 0.10),
}  # fmt: skip
GROUND: dict[str, tuple[int, int, int]] = {
    "wood": (164, 122, 84), "tile": (206, 202, 194), "carpet": (128, 122, 130), "plaster": (222, 216, 204),
    "stripes": (214, 208, 190), "brick": (160, 98, 80), "cloth": (196, 204, 214), "stone": (150, 148, 150),
}  # fmt: skip


@cache
def picture(finish: str) -> bytes:
    """A square metre of a finish: PNG."""
    seed, coarse, depth = GRAIN[finish]
    rng = np.random.default_rng(seed)
    stretch = (coarse * 8, coarse) if finish == "wood" else (coarse, coarse)
    from scipy import ndimage

    grain = ndimage.gaussian_filter(rng.standard_normal((SIZE, SIZE)), stretch, mode="wrap")
    shade = 1.0 + depth * grain / grain.std() + _pattern(finish, rng)
    levels = np.clip(np.array(GROUND[finish]) * np.clip(shade, 0.3, 1.3)[..., None], 0, 255).astype(np.uint8)
    return png(levels)


def _pattern(finish: str, rng: np.random.Generator) -> Array:
    """Boards, joints and weave (SIZE, SIZE), as a change of shade."""
    row, column = np.mgrid[:SIZE, :SIZE] / SIZE
    match finish:
        case "wood":
            board = (column * 8).astype(int)
            return np.asarray(rng.uniform(-0.08, 0.08, 8)[board] - 0.3 * (column * 8 % 1 < 0.04))
        case "tile":
            joint = (column * 3 % 1 < 0.03) | (row * 3 % 1 < 0.03)
            tile = (row * 3).astype(int) * 3 + (column * 3).astype(int)
            return np.asarray(rng.uniform(-0.04, 0.04, 9)[tile] - 0.3 * joint)
        case "brick":
            course = (row * 12).astype(int)
            along = (column * 4 + 0.5 * (course % 2)) % 1
            return np.asarray(0.35 * ((along < 0.05) | (row * 12 % 1 < 0.14)))
        case "stripes":
            return np.asarray(-0.10 * (column * 8 % 1 < 0.5))
        case "cloth":
            return np.asarray(-0.12 * ((column * 10 % 1 < 0.5).astype(float) + (row * 10 % 1 < 0.5)))
        case _:
            return np.zeros((SIZE, SIZE))


def assets(finish: str) -> str:
    """The material of a finish and its picture."""
    name = f"finish_{finish}"
    # MuJoCo counts the repeats of a plane from its middle: 2 are one a metre.
    return (
        f'<texture name="{name}" type="2d" file="{name}.png"/>'
        f'<material name="{name}" texture="{name}" texuniform="true" texrepeat="2 2" specular="0.1" shininess="0.1"/>'
    )


def file(finish: str) -> tuple[str, bytes]:
    """Name and content of the picture that the material wants."""
    return f"finish_{finish}.png", picture(finish)
