"""Reads what is printed on an object: RapidOCR on its crop. Optional: `pip install 'tidybot-zenoh[ocr]'`."""

import importlib.util
import re
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from services.perception.naming.crop import Crop
from services.perception.naming.text import Line

MISSING = "what is printed on things is not read: pip install 'tidybot-zenoh[ocr]', or set perception.read = false"
SIDE = 360
"""Pixels of the longer side that a crop is enlarged to. Chosen: letters of 8 pixels in a crop of 120 get the 24 that
the reader's network was trained on."""
LARGEST = 4.0
"""Factor of enlargement from which no more letters are read, only more time is spent."""
CONFIDENT = 0.6
"""Confidence of a line below which it is noise rather than print (bench.naming)."""
LETTERS = 2
"""Fewest letters of a line."""
ENOUGH = 0.8
"""Confidence of a line from which no other turn of the picture is tried."""


def installed() -> bool:
    """The packages of the extra are there."""
    return all(importlib.util.find_spec(name) for name in ("rapidocr_onnxruntime", "rapidfuzz"))


class Reader:
    """Lives in the worker; loads its networks at the first crop."""

    def __init__(self) -> None:
        self._ocr: Any = None
        self.broken = ""

    def read(self, crop: Crop) -> list[Line] | None:
        """The lines on an object, from top to bottom; those that run up or down its side as well. None when the package
        does not work here, and `broken` says why."""
        if self._ocr is None and not self._load():
            return None
        picture = enlarged(crop.rgb)
        best: list[Line] = []
        for quarter in (0, 1, 3):
            lines = self._lines(np.ascontiguousarray(np.rot90(picture, quarter)))
            if _worth(lines) > _worth(best):
                best = lines
            if any(line.confidence >= ENOUGH and len(line.text) > LETTERS for line in best):
                break
        return best

    def _load(self) -> bool:
        try:
            from rapidocr_onnxruntime import RapidOCR

            self._ocr = RapidOCR(intra_op_num_threads=1, inter_op_num_threads=1, det_limit_side_len=SIDE)
        except ImportError as error:
            self.broken = f"{error}; on Debian or Ubuntu: apt-get install libgl1 libglib2.0-0"
        return not self.broken

    def _lines(self, picture: NDArray[np.uint8]) -> list[Line]:
        found, _ = self._ocr(picture[..., ::-1])
        lines = [Line(re.sub(r"\s+", " ", str(text)).strip(), float(score)) for _, text, score in found or ()]
        return [line for line in lines if line.confidence >= CONFIDENT and _letters(line.text) >= LETTERS]


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
