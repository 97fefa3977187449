"""Hibari's words to sounds with its dictionaries packed: as Python keeps them, 280,000 entries take 75 MB."""

import gzip
from collections.abc import Callable
from pathlib import Path
from typing import Any

import hibari
import msgspec
from hibari.g2p import G2P
from hibari.g2p.lexicon import Lexicon
from hibari.g2p.tagger import Tagger
from hibari.g2p.tokenize import Tokenizer
from hibari.voices import DEFAULT, voice_path

from services.speech.speak.packed_mapping import PackedMapping

ASSETS = Path(hibari.__file__).parent / "assets"
Words = dict[str, msgspec.Raw]


class TaggerModel(msgspec.Struct):
    """The file of the part-of-speech tagger."""

    tags: list[str]
    vocab: list[str]
    tagdict: Words
    weights: Words


class Pronunciation(G2P):  # type: ignore[misc]
    """As the library's own, for its American voices; it is not asked to load its dictionaries."""

    def __init__(self) -> None:
        self._oov, self.unk, self.british = None, "", False
        self.lexicon = Lexicon(_table("lexicon_us_gold.json.gz"), _table("lexicon_us_silver.json.gz"))
        self.tokenizer = Tokenizer(msgspec.json.decode((ASSETS / "tokenizer_exceptions.json").read_bytes()))
        model = msgspec.json.decode(_unzipped("tagger.json.gz"), type=TaggerModel)
        packed: dict[str, Any] = {"tagdict": PackedMapping(model.tagdict), "weights": PackedMapping(model.weights)}
        self.tagger = Tagger({"tags": model.tags, "vocab": model.vocab, **packed})


def _table(name: str) -> PackedMapping:
    return PackedMapping(msgspec.json.decode(_unzipped(name), type=Words))


def _unzipped(name: str) -> bytes:
    return gzip.decompress((ASSETS / name).read_bytes())


class LeanHibari(hibari.Hibari):  # type: ignore[misc]
    """The library's default voice in a session of ours: its own keeps the space of the longest sentence."""

    def __init__(self, session: Callable[[Path, int], Any]) -> None:
        self.voice, self.model_path = DEFAULT, voice_path(DEFAULT)
        self.sess = session(Path(self.model_path), 1)
        self.vocab = msgspec.json.decode((ASSETS / "vocab.json").read_bytes())
        self._g2p = Pronunciation()
