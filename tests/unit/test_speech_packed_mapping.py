"""The packed dictionaries of the voice, and its sound at our rate."""

import gzip
import json
from fractions import Fraction
from pathlib import Path

import msgspec
import numpy as np
import pytest
from hibari.g2p import G2P

from common.sound import RATE, resample
from services.speech.prepared import prepared
from services.speech.speak.dictionaries import assets
from services.speech.speak.packed_mapping import PackedMapping, write
from services.speech.speak.pronounce import Pronunciation


def pronunciation() -> Pronunciation:
    with prepared() as folder:
        return Pronunciation(folder)


def test_a_table_reads_like_the_dictionary_it_was_made_from(tmp_path: Path) -> None:
    def packed(words: dict[str, object]) -> PackedMapping:
        write(msgspec.json.decode(json.dumps(words), type=dict[str, msgspec.Raw]), tmp_path / "words")
        return PackedMapping(tmp_path / "words")

    words: dict[str, object] = {"mug": "mˈʌɡ", "": 1, "é": {"DT": 0.5}, "Mug": ["a", None], "mugs": "z", "zoo": "x"}
    table = packed(words)
    assert dict(table) == words
    assert len(table) == len(words)
    assert list(table) == sorted(words, key=str.encode)
    assert [word in table for word in ("mug", "mu", "mugss", "a", "zz", "ê")] == [True] + [False] * 5
    assert table.get("cup") is None and 3 not in table
    with pytest.raises(KeyError):
        table["cup"]
    assert dict(packed({})) == {} and "a" not in packed({})


def test_the_packed_dictionaries_of_the_voice_are_the_librarys_own() -> None:
    name = "lexicon_us_gold.json.gz"
    own = json.loads(gzip.decompress((assets() / name).read_bytes()))
    assert dict(pronunciation().lexicon.golds.d) == own


def test_it_pronounces_as_the_library_does() -> None:
    ours, theirs = pronunciation(), G2P()
    for text in ("I read the live records; they read 12.5 at 10:30.", "Did you say: bring me Dr. Smith's teacup?"):
        assert ours(text) == theirs(text)


@pytest.mark.parametrize(("rate", "count"), [(24000, 7000), (48000, 20001), (44100, 9000), (8000, 500), (24000, 1)])
def test_sound_is_resampled_as_scipy_does_it(rate: int, count: int) -> None:
    from scipy.signal import resample_poly  # takes a second to load

    ratio = Fraction(RATE, rate)
    samples = np.random.default_rng(rate + count).normal(0.0, 6000.0, count)
    expected = resample_poly(samples, ratio.numerator, ratio.denominator)
    found = resample(samples, rate)
    assert found.dtype == np.int16 and found.shape == expected.shape
    assert np.abs(found - np.clip(expected, -32768, 32767)).max() <= 0.501
