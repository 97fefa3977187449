"""A map as map_server reads it: for tests of those who write one."""

import re
from pathlib import Path

import numpy as np
from PIL import Image

from common.files.map_file import FREE, GREY, OCCUPIED, UNKNOWN, GridMap


def read_map(path: Path) -> GridMap:
    """The map of a `.yaml` file, of modes `trinary` and `scale`, and the picture beside it."""
    keys = dict(re.findall(r"^(\w+): (.*)$", path.read_text(), re.MULTILINE))
    x, y, yaw = (float(v) for v in keys["origin"].strip("[]").split(","))
    assert (keys["negate"], yaw) == ("0", 0.0)
    dark = 1.0 - np.asarray(Image.open(path.parent / keys["image"])) / 255.0
    occupied, free = float(keys["occupied_thresh"]), float(keys["free_thresh"])
    cells = np.where(dark > occupied, OCCUPIED, np.where(dark < free, FREE, UNKNOWN)).astype(np.uint8)
    assert set(np.unique(dark)) <= {1.0 - level / 255.0 for level in GREY.values()}
    return GridMap(cells[::-1], float(keys["resolution"]), (x, y))
