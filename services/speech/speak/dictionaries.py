"""Hibari's dictionaries as mapped files: as Python keeps them, 280,000 entries take 75 MB."""

import gzip
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import msgspec

from services.speech.speak import packed_mapping
from services.speech.speak.packed_mapping import PackedMapping

GOLD, SILVER, TAGGER = "lexicon_us_gold", "lexicon_us_silver", "tagger"
TAGDICT, WEIGHTS = "tagdict", "weights"
Words = dict[str, msgspec.Raw]


class TaggerModel(msgspec.Struct):
    """The file of the part-of-speech tagger."""

    tags: list[str]
    vocab: list[str]
    tagdict: Words
    weights: Words


def assets() -> Path:
    """The library's folder, found without importing it."""
    spec = find_spec("hibari")
    assert spec is not None and spec.origin is not None, "hibari-tts is a dependency"
    return Path(spec.origin).parent / "assets"


def write(folder: Path) -> None:
    """Write the dictionaries of its American voices into a folder."""
    for name in (GOLD, SILVER):
        packed_mapping.write(msgspec.json.decode(_unzipped(name), type=Words), folder / name)
    model = msgspec.json.decode(_unzipped(TAGGER), type=TaggerModel)
    packed_mapping.write(model.tagdict, folder / TAGDICT)
    packed_mapping.write(model.weights, folder / WEIGHTS)
    (folder / TAGGER).write_bytes(msgspec.json.encode({"tags": model.tags, "vocab": model.vocab}))


def tagger(folder: Path) -> dict[str, Any]:
    """The tagger's model as the library takes it."""
    model: dict[str, Any] = msgspec.json.decode((folder / TAGGER).read_bytes())
    return model | {name: PackedMapping(folder / name) for name in (TAGDICT, WEIGHTS)}


def _unzipped(name: str) -> bytes:
    return gzip.decompress((assets() / f"{name}.json.gz").read_bytes())
