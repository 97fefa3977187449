"""Moonshine base-en through onnxruntime: free greedy decoding and beam search under the command grammar.

Jeffries et al., "Moonshine: Speech Recognition for Live Transcription and Voice Commands", 2024. For the
weights see `common/speech_weights.py`.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from common import speech_weights
from common.inference import session
from common.sound import RATE
from services.speech.prepared import ENCODER, prepared
from services.speech.recognise.decoder import Cache, Decoder
from services.speech.recognise.grammar import State
from services.speech.recognise.token_trie import BOS, EOS, AnyTokens, TokenTrie, letters, read_tokens

Array = NDArray[np.float32]
TOKENS_PER_SECOND = 6.5
"""Most tokens per second of sound: the limit that Moonshine's authors recommend against endless repetition."""
BEAM_THRESHOLD = 10.0
"""Natural logarithm of how much less likely than the best a hypothesis may be to stay in the beam."""
FREE_BEAM = 8
"""Hypotheses of the search without a grammar (chosen: half of those under one, for the time they take)."""
REPLACED = 4
"""Most first words of a transcription that may be two misheard ones (chosen: `hey jarvis` as `he is a john is`)."""


@dataclass(frozen=True)
class Decoded:
    """Text, the sum of its tokens' log-probabilities, and the tokens with the final one."""

    text: str
    log_probability: float
    numbers: tuple[int, ...]

    @property
    def tokens(self) -> int:
        """Tokens of the text, the final one included [count]."""
        return len(self.numbers)


@dataclass(frozen=True)
class BeamHypothesis:
    """A beginning of a sentence: its log-probability, what its whole words cost, its tokens, the grammar's state after
    it, what it reads."""

    total: float
    cost: float
    numbers: tuple[int, ...]
    state: State
    text: str

    @property
    def worth(self) -> float:
        """Log-probability with the cost of its words."""
        return self.total - self.cost


@dataclass(frozen=True)
class EncodedUtterance:
    """The encoder's result as the decoder attends to it, the number of input variants, the most tokens in it."""

    attended: Cache
    variants: int
    limit: int


@cache
def networks() -> tuple[Any, Decoder]:
    """Encoder and decoder, shared by all that live in one process."""
    with prepared() as folder:
        return session(folder / ENCODER), Decoder(folder)


def load(beam: int) -> "Moonshine":
    """The shipped networks with their tokens; `beam`: hypotheses that the search keeps."""
    return Moonshine(*networks(), read_tokens(speech_weights.folder() / "tokenizer.bin"), beam)


class Moonshine:
    """Speech to text by one encoder and one decoder; not for use by several threads at once.

    An utterance may be given in several input variants of equal length (as recorded, noise taken out): their token
    probabilities are averaged, so that a word must be plausible in all of them.
    """

    def __init__(self, encoder: Any, decoder: Decoder, tokens: list[str], beam: int) -> None:
        self._encoder, self._decoder, self.tokens, self._beam = encoder, decoder, tokens, beam
        self._any = AnyTokens(tokens)

    def encode(self, variants: Array) -> EncodedUtterance:
        """Encode 16 kHz samples (variants, n) of one utterance."""
        hidden = self._encoder.run(None, {"input_values": variants.astype(np.float32)})[0]
        limit = max(2, int(variants.shape[1] / RATE * TOKENS_PER_SECOND) + 2)
        return EncodedUtterance(self._decoder.cross_attention_cache(hidden), len(variants), limit)

    def free(self, utterance: EncodedUtterance) -> Decoded:
        """The transcription without any grammar, the likeliest token at a time.

        Something was said, as voice detection knows: in noise the network would rather end at once.
        """
        scores, cache = self._first(utterance)
        scores = scores.copy()
        scores[:, EOS] = -np.inf
        numbers: list[int] = []
        total = 0.0
        for _ in range(utterance.limit):
            best = int(scores[0].argmax())
            total += float(scores[0, best])
            if best == EOS:
                break
            numbers.append(best)
            scores, cache = self._decoder.step(utterance.attended, cache, [0], [best])
        return Decoded(self._spelled(numbers), total, (*numbers, EOS))

    def freely(
        self, utterance: EncodedUtterance, prior: Callable[[str], float], expected: Callable[[str], float]
    ) -> list[Decoded]:
        """Different transcriptions without any grammar by beam search, as they are spelled, the likeliest first.

        `expected` is the cost of the words with which a text begins, in the search too: no other word of like sound
        crowds out one that is said to a robot.
        """
        found = self._search(utterance, self._any, prior, FREE_BEAM, expected)
        return [Decoded(self._spelled(f.numbers[:-1]), f.log_probability, f.numbers) for f in found]

    def _spelled(self, numbers: Iterable[int]) -> str:
        return "".join(self.tokens[n] for n in numbers).strip()

    def best(self, utterance: EncodedUtterance, trie: TokenTrie, prior: Callable[[str], float]) -> list[Decoded]:
        """Different sentences of the grammar by beam search, the likeliest first; empty when none fits into the length.

        The `prior` cost of a whole sentence is taken from its log-probability. Of hypotheses that read the same only
        the best is kept, so that the beam is not filled with spellings ("Stop", "stop.", "stop,").
        """
        return self._search(utterance, trie, prior, self._beam)

    def _search(
        self,
        utterance: EncodedUtterance,
        trie: TokenTrie | AnyTokens,
        prior: Callable[[str], float],
        width: int,
        expected: Callable[[str], float] = lambda text: 0.0,
    ) -> list[Decoded]:
        """The sentences of a beam of that `width`."""
        scores, cache = self._first(utterance)
        beam = [BeamHypothesis(0.0, 0.0, (), trie.start, "")]
        finished: dict[str, tuple[float, Decoded]] = {}
        for _ in range(utterance.limit):
            for row, hypothesis in enumerate(beam):
                if hypothesis.text.strip() and trie.is_final(hypothesis.state):
                    _finish(hypothesis, float(scores[row, EOS]), prior, finished)
            leader = max((worth for worth, _ in finished.values()), default=-np.inf)
            kept = self._continued(beam, scores, trie, leader, width, expected)
            if not kept:
                break
            beam = [hypothesis for hypothesis, _ in kept]
            rows, last = [row for _, row in kept], [hypothesis.numbers[-1] for hypothesis in beam]
            scores, cache = self._decoder.step(utterance.attended, cache, rows, last)
        return [found for _, found in sorted(finished.values(), key=lambda f: -f[0])]

    def _first(self, utterance: EncodedUtterance) -> tuple[Array, Array]:
        """Scores and cache after the token that begins every sentence."""
        return self._decoder.step(utterance.attended, self._decoder.empty_cache(utterance.variants), [0], [BOS])

    def _continued(
        self,
        beam: list[BeamHypothesis],
        scores: Array,
        trie: TokenTrie | AnyTokens,
        leader: float,
        width: int,
        expected: Callable[[str], float],
    ) -> list[tuple[BeamHypothesis, int]]:
        """The best hypotheses one token longer, each with the row of the one it goes on from.

        `leader` is the log-probability of the best sentence that is finished.
        """
        options: dict[str, tuple[BeamHypothesis, int]] = {}
        for row, hypothesis in enumerate(beam):
            allowed, after = trie.allowed(hypothesis.state)
            values = scores[row, allowed]
            for k in _highest(values, 2 * width):
                number, total = int(allowed[k]), hypothesis.total + float(values[k])
                added = letters(self.tokens[number])
                text = hypothesis.text + added
                if text not in options or total > options[text][0].total:
                    cost = expected(hypothesis.text) if added.startswith(" ") else hypothesis.cost
                    longer = BeamHypothesis(total, cost, (*hypothesis.numbers, number), after[k], text)
                    options[text] = longer, row
        kept = sorted(options.values(), key=lambda o: -o[0].worth)[:width]
        return [o for o in kept if o[0].worth > max(leader, kept[0][0].worth) - BEAM_THRESHOLD]

    def begun_with(self, numbers: tuple[int, ...], sentence: Decoded) -> list[Decoded]:
        """The sentence with these tokens in place of none of its words, of its first one, and so on.

        The text of each is what follows on these tokens.
        """
        starts = [k for k, n in enumerate(sentence.numbers[:-1]) if self.tokens[n].startswith(" ") or k == 0]
        cuts = [*starts, sentence.tokens - 1][: REPLACED + 1]
        rest = ["".join(self.tokens[n] for n in sentence.numbers[cut:-1]).strip() for cut in cuts]
        return [Decoded(text, 0.0, (*numbers, *sentence.numbers[cut:])) for text, cut in zip(rest, cuts, strict=True)]

    def log_probabilities(self, utterance: EncodedUtterance, sentences: list[Decoded]) -> list[float]:
        """Log-probability of each sentence for these input variants, in the tokens that it was found in."""
        totals = [0.0] * len(sentences)
        cache, before = self._decoder.empty_cache(utterance.variants), [0] * len(sentences)
        alive = list(range(len(sentences)))
        last = [BOS] * len(alive)
        for i in range(max(s.tokens for s in sentences)):
            scores, cache = self._decoder.step(utterance.attended, cache, before, last)
            for row, k in enumerate(alive):
                totals[k] += float(scores[row, sentences[k].numbers[i]])
            before = [row for row, k in enumerate(alive) if sentences[k].tokens > i + 1]
            alive = [alive[row] for row in before]
            last = [sentences[k].numbers[i] for k in alive]
        return totals


def _highest(values: Array, count: int) -> list[int]:
    """Indices of the highest values, the highest first."""
    some = np.argpartition(values, -count)[-count:] if len(values) > count else np.arange(len(values))
    found: list[int] = some[np.argsort(values[some])[::-1]].tolist()
    return found


def _finish(
    hypothesis: BeamHypothesis,
    ending: float,
    prior: Callable[[str], float],
    finished: dict[str, tuple[float, Decoded]],
) -> None:
    """Enter a hypothesis as a whole sentence if it is the best so far; `ending` is the log-probability of its end."""
    total = hypothesis.total + ending
    worth = total - prior(hypothesis.text.strip())
    if hypothesis.text not in finished or worth > finished[hypothesis.text][0]:
        finished[hypothesis.text] = worth, Decoded(hypothesis.text.strip(), total, (*hypothesis.numbers, EOS))
