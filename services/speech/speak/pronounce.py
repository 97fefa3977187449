"""Hibari's pronunciation with memory-mapped dictionaries, and its voice in an onnxruntime session of ours."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import msgspec

from common.inference import session
from services.speech.speak.dictionaries import GOLD, SILVER, assets, tagger
from services.speech.speak.packed_mapping import PackedMapping


@contextmanager
def _without(module: str) -> Iterator[None]:
    """Have an import of the module fail, as where it is not installed."""
    before = sys.modules.get(module)
    sys.modules[module] = None  # type: ignore[assignment]
    try:
        yield
    finally:
        del sys.modules[module]
        if before is not None:
            sys.modules[module] = before


with _without("scipy.fft"):  # it takes 0.2 s and 12 MB; NumPy's is the library's own alternative
    import hibari
    from hibari.g2p import G2P
    from hibari.g2p.lexicon import Lexicon
    from hibari.g2p.tagger import Tagger
    from hibari.g2p.tokenize import Tokenizer
    from hibari.voices import DEFAULT, voice_path

SAMPLE_RATE = int(hibari.SAMPLE_RATE)
"""Samples per second of what it says."""


class Pronunciation(G2P):  # type: ignore[misc]
    """The library's own pronunciation for American voices, without loading its dictionaries."""

    def __init__(self, folder: Path) -> None:
        self._oov, self.unk, self.british = None, "", False
        self.lexicon = Lexicon(PackedMapping(folder / GOLD), PackedMapping(folder / SILVER))
        self.tokenizer = Tokenizer(msgspec.json.decode((assets() / "tokenizer_exceptions.json").read_bytes()))
        self.tagger = Tagger(tagger(folder))


class LeanHibari(hibari.Hibari):  # type: ignore[misc]
    """The library's default voice in a session of ours: its own keeps the space of the longest sentence."""

    def __init__(self, folder: Path) -> None:
        self.voice, self.model_path = DEFAULT, voice_path(DEFAULT)
        self.sess = session(Path(self.model_path))
        self.vocab = msgspec.json.decode((assets() / "vocab.json").read_bytes())
        self._g2p = Pronunciation(folder)
