"""What geoms look like to those who draw no pictures on them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

_NO_COLOUR = (0.5, 0.5, 0.5, 1.0)
"""The RGBA of a geom that was given none (MuJoCo's XML reference, body/geom)."""
HIDDEN_GROUP = 4
"""First geom group that is not drawn: collision shapes are in it and above [MuJoCo group]."""
SKY = (200, 215, 232)
"""RGB of what a camera sees where nothing is: a blue between those of the scenes' sky."""


def geom_colours(model: Any) -> NDArray[np.float64]:
    """RGB (n, 3) in shares of the geoms of a model, as MuJoCo draws them: the material's colour unless the geom has its
    own, times the mean of the material's picture."""
    own = np.asarray(model.geom_rgba, np.float64)
    colours = own[:, :3].copy()
    plain = (own == _NO_COLOUR).all(axis=1)
    for material in set(model.geom_matid.tolist()) - {-1}:
        made_of = model.geom_matid == material
        colours[made_of & plain] = model.mat_rgba[material, :3]
        colours[made_of] *= _mean_picture(model, material)
    return colours


def _mean_picture(model: Any, material: int) -> NDArray[np.float64]:
    """Mean RGB (3,) in shares of a material's texture, ones where it has none."""
    import mujoco

    texture = int(np.ravel(model.mat_texid[material])[int(mujoco.mjtTextureRole.mjTEXROLE_RGB)])
    if texture < 0:
        return np.ones(3)
    at, channels = int(model.tex_adr[texture]), int(model.tex_nchannel[texture])
    count = int(model.tex_width[texture]) * int(model.tex_height[texture]) * channels
    pixels = model.tex_data[at : at + count].reshape(-1, channels)[:, :3]
    return np.asarray(pixels.mean(axis=0) / 255)
