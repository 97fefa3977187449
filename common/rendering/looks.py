"""What geoms look like to those who draw no pictures on them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

SKY = (200, 215, 232)
"""RGB of what a camera sees where nothing is: a blue between those of the scenes' sky."""


def geom_colours(model: Any) -> NDArray[np.float64]:
    """RGB (n, 3) in shares of the geoms of a model: their own, or the material's with the mean of its picture."""
    import mujoco

    colours = np.array(model.geom_rgba[:, :3], np.float64)
    role = int(mujoco.mjtTextureRole.mjTEXROLE_RGB)
    for material in set(model.geom_matid.tolist()) - {-1}:
        colour = np.array(model.mat_rgba[material, :3], np.float64)
        texture = int(np.ravel(model.mat_texid[material])[role])
        if texture >= 0:
            at, channels = int(model.tex_adr[texture]), int(model.tex_nchannel[texture])
            count = int(model.tex_width[texture]) * int(model.tex_height[texture]) * channels
            pixels = model.tex_data[at : at + count].reshape(-1, channels)[:, :3]
            colour *= pixels.mean(axis=0) / 255
        colours[model.geom_matid == material] = colour
    return colours
