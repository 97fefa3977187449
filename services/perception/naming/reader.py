"""Reads what is printed on an object: RapidOCR on its crop. Optional: `pip install 'tidybot-zenoh[ocr]'`."""

import importlib.util
import math
import re
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from services.perception.naming.crop import Crop
from services.perception.naming.sides import flattened
from services.perception.naming.text import Line, merged, sure_words

MISSING = "what is printed on things is not read: pip install 'tidybot-zenoh[ocr]', or set perception.read = false"
SIDE = 360
"""Pixels of the longer side that a crop is enlarged to. Chosen: letters of 8 pixels in a crop of 120 get the 24 that
the reader's network was trained on."""
LARGEST = 4.0
"""Factor of enlargement from which no more letters are read, only more time is spent."""
CONFIDENT = 0.6
"""Confidence of a line below which it is noise rather than print; measured on drawn packages."""
LETTERS = 2
"""Fewest letters of a line."""
ENOUGH = 0.8
"""Confidence of a line from which no other turn of the picture is tried."""
MOST_SIDES = 2
"""Sides of an object that are read, those that face the camera most."""
OWN = 0.4
"""Share of a line's field that must be the object's: what stands behind it has print as well. Depth has holes."""
LEAST_RANGE = 40.0
"""Levels (of 255) that are stretched over all at least: less is noise."""


def installed() -> bool:
    """The packages of the extra are there."""
    return all(importlib.util.find_spec(name) for name in ("rapidocr_onnxruntime", "rapidfuzz"))


class Reader:
    """Lives in the worker; loads its networks at the first crop."""

    def __init__(self) -> None:
        self._ocr: Any = None
        self.broken = ""

    def read(self, crop: Crop) -> list[Line] | None:
        """The lines on an object; those that run up or down its side as well. None when the package does not work here,
        and `broken` says why."""
        if self._ocr is None and not self._load():
            return None
        lines: list[Line] = []
        if crop.lens is not None and crop.believed is not None:
            # Straight on, letters are read that a slanting view squeezes.
            for side in flattened(crop.rgb, crop.lens, crop.believed)[:MOST_SIDES]:
                lines = merged(lines, self._best(levelled(side)))
                if sure_words(lines):
                    return lines
        # The whole picture has what is beyond the edges, where the object is not quite as believed.
        return merged(lines, self._best(levelled(crop.rgb, crop.mask), np.asarray(crop.mask)))

    def _best(self, picture: NDArray[np.uint8], mask: NDArray[np.bool_] | None = None) -> list[Line]:
        """The lines of a picture (h, w, 3), turned until they are read best; with a `mask` (h, w) those within it."""
        best: list[Line] = []
        for quarter in (0, 1, 3, 2):
            turned = enlarged(np.ascontiguousarray(np.rot90(picture, quarter)))
            found = self._lines(turned, np.rot90(mask, quarter) if mask is not None else None)
            if not found:  # nothing looks like print, nor does on its side
                break
            lines = [line for line in found if line.confidence >= CONFIDENT and _letters(line.text) >= LETTERS]
            if _worth(lines) > _worth(best):
                best = lines
            if any(line.confidence >= ENOUGH and len(line.text) > LETTERS for line in best):
                break
        return best

    def _load(self) -> bool:
        try:
            from rapidocr_onnxruntime import RapidOCR

            self._ocr = RapidOCR(
                intra_op_num_threads=1, inter_op_num_threads=1, det_limit_side_len=SIDE, text_score=0.0
            )
        except ImportError as error:
            self.broken = f"{error}; on Debian or Ubuntu: apt-get install libgl1 libglib2.0-0"
        return not self.broken

    def _lines(self, picture: NDArray[np.uint8], mask: NDArray[np.bool_] | None) -> list[Line]:
        """All that looks like a line, however badly it is read."""
        found, _ = self._ocr(picture[..., ::-1])
        lines = []
        for corners, text, score in found or ():
            line = Line(re.sub(r"\s+", " ", str(text)).strip(), float(score))
            own = mask is None or _share(np.asarray(corners, float), mask, picture.shape[0] / mask.shape[0]) >= OWN
            if own:
                lines.append(line)
        return lines


def _share(corners: NDArray[np.float64], mask: NDArray[np.bool_], factor: float) -> float:
    """How much of a line's field, by its corners (4, 2) in a picture enlarged by `factor`, is in the mask (h, w)."""
    (left, top), (right, bottom) = corners.min(0) / factor, corners.max(0) / factor
    field = mask[max(0, int(top)) : math.ceil(bottom) + 1, max(0, int(left)) : math.ceil(right) + 1]
    return float(field.mean()) if field.size else 0.0


def levelled(rgb: NDArray[np.uint8], mask: NDArray[np.bool_] | None = None) -> NDArray[np.uint8]:
    """A picture (h, w, 3) from black to white whatever the light, by the pixels in the mask (h, w)."""
    pixels = rgb[mask] if mask is not None and mask.any() else rgb.reshape(-1, 3)
    low, high = np.percentile(pixels, (1, 99))
    stretched = (rgb.astype(np.float32) - low) * (255.0 / max(high - low, LEAST_RANGE))
    return np.asarray(np.clip(stretched, 0, 255).astype(np.uint8))


def enlarged(rgb: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A picture (h, w, 3) whose longer side has SIDE pixels, if no more than LARGEST times as many as before."""
    h, w = rgb.shape[:2]
    factor = min(LARGEST, SIDE / max(h, w))
    size = max(1, round(w * factor)), max(1, round(h * factor))
    return np.asarray(Image.fromarray(rgb).resize(size, Image.Resampling.BICUBIC))


def _letters(text: str) -> int:
    return sum(c.isascii() and c.isalnum() for c in text)


def _worth(lines: list[Line]) -> float:
    return sum(line.confidence * _letters(line.text) for line in lines)
