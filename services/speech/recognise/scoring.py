"""Hypothesis scoring: the likeliest of the grammar's sentences, and how sure it is. Pure."""

import math
from collections.abc import Callable, Iterable
from typing import Generic, NamedTuple, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from common.language.normalise import DETERMINERS, normalise
from common.messages import Transcription
from services.speech.config import SpeechConfig

Array = NDArray[np.float32]
CANDIDATES = 6
"""Best sentences that are scored a second time. Chosen: the time of that grows with it."""
MAX_DEFICIT = 8.0
"""Natural logarithm of how much less likely than the best a sentence may be to be scored a second time."""
PLAUSIBLE = -1.2
"""Log-likelihood ratio per token to the free transcription, below which the second scoring cannot save a sentence."""
TEMPERATURE = 1.4
"""By how much differences of log-probability are too large. Chosen on one voice in noise, where sentences that were not
said had up to 0.86 of the probability without it."""
PAUSES = 0.35
"""Time without letters in a sentence by voice detection [s], fitted to the voices of the corpus."""
SECONDS_PER_CHARACTER = 0.045
"""Time of a letter [s], fitted likewise."""
TEMPO_SPREAD = 0.25
"""Standard deviation of the logarithm of a sentence's time. Chosen: three times that of the corpus's voices."""


class ScoredSentence(Protocol):
    """A sentence, the log-probability of its tokens, and how many these are."""

    @property
    def text(self) -> str: ...
    @property
    def log_probability(self) -> float: ...
    @property
    def tokens(self) -> int: ...


S = TypeVar("S", bound=ScoredSentence)


class Choice(NamedTuple, Generic[S]):
    """A sentence, its log-likelihood ratio per token to the free transcription, and its `share` 0..1: how probable it
    is among those that the grammar allows, with all that mean the same. `worth`: the log-probability of each of these,
    and of the free transcription."""

    sentence: S
    ratio: float
    share: float
    worth: list[tuple[S, float]]


def rescored(
    sentences: list[S], free: S, prior: Callable[[str], float], score_again: Callable[[list[S]], list[float]]
) -> Choice[S]:
    """The likeliest of the `sentences`, best first.

    Where they differ both were chosen to fit even the noise of the input variants that they were found in. So all are
    scored a second time on others, in which the same noise sounds different to the network. `prior` is a sentence's
    cost before anything was heard, a negative log-probability.
    """
    best = sentences[0]
    worth = [s.log_probability - prior(s.text) for s in sentences[:CANDIDATES]]
    if normalise(free.text) == best.text:
        share = _share(best, sentences[:CANDIDATES], worth)
        ratio = (best.log_probability - free.log_probability) / best.tokens
        return Choice(best, ratio, share, list(zip(sentences, worth, strict=False)))
    rivals = [s for s, value in zip(sentences, worth, strict=False) if value >= worth[0] - MAX_DEFICIT]
    *totals, free_total = score_again([*rivals, free])
    again = [total - prior(rival.text) for total, rival in zip(totals, rivals, strict=True)]
    k = int(np.argmax(again))
    both = [
        (rival, (rival.log_probability - prior(rival.text) + b) / 2) for rival, b in zip(rivals, again, strict=True)
    ]
    share = _share(rivals[k], rivals, [value for _, value in both])
    both.append((free, (free.log_probability + free_total) / 2 - prior(free.text)))
    command = rivals[k]
    first = (command.log_probability - free.log_probability) / command.tokens
    second = (totals[k] - prior(command.text) - free_total) / command.tokens
    # What is far from any command has a free transcription that fits its own variant only, and so none the other.
    return Choice(command, second if first >= PLAUSIBLE else min(second, first), share, both)


def likeliest(
    transcriptions: list[S], again: list[float], cost: Callable[[str], float]
) -> tuple[S, float, list[tuple[S, float]]]:
    """The likeliest of different transcriptions, with the `cost` of what each says, its share 0..1 of the probability
    of all of them, with those that mean the same, and each with its log-probability.

    `again` are the log-probabilities in the second scoring.
    """
    worth = [(t.log_probability + a) / 2 - cost(t.text) for t, a in zip(transcriptions, again, strict=True)]
    chosen = transcriptions[int(np.argmax(worth))]
    return chosen, _share(chosen, transcriptions, worth), list(zip(transcriptions, worth, strict=True))


def ranked(worth: Iterable[tuple[str, float]]) -> tuple[Transcription, ...]:
    """Texts with their log-probabilities as transcriptions with shares of the probability, the likeliest first.

    Of texts that mean the same only the likeliest is among them.
    """
    best: dict[tuple[str, ...], tuple[str, float]] = {}
    for text, value in sorted(worth, key=lambda one: -one[1]):
        if meaning := meant(text):
            best.setdefault(meaning, (text, value))
    odds = [math.exp((value - max(v for _, v in best.values())) / TEMPERATURE) for _, value in best.values()]
    shares = (round(odd / sum(odds), 3) for odd in odds)
    return tuple(Transcription(text=text, score=p) for (text, _), p in zip(best.values(), shares, strict=True) if p)


def _share(chosen: S, sentences: list[S], worth: list[float]) -> float:
    """Probability of what `chosen` means among the `sentences` with these log-probabilities."""
    odds = np.exp((np.array(worth) - max(worth)) / TEMPERATURE)
    same = [meant(s.text) == meant(chosen.text) for s in sentences]
    return float(odds[same].sum() / odds.sum())


def meant(text: str) -> tuple[str, ...]:
    """The words of a transcription that distinguish its meaning from others."""
    return tuple(word for word in normalise(text).split() if word not in DETERMINERS and word != "please")


def time_scaled(samples: Array, factor: float) -> Array:
    """Samples (n,) played `factor` times as fast, their pitch with them: (n / factor,), resampled by FFT."""
    length = round(len(samples) / factor)
    found: Array = (np.fft.irfft(np.fft.rfft(samples), length) / factor).astype(np.float32)
    return found


def prior_cost(text: str, seconds: float, config: SpeechConfig) -> float:
    """Cost of a sentence however it sounds, as a negative log-probability: words that people hardly use to a robot,
    and a length that does not fit the `seconds` that it took."""
    rare = sum(config.rare.get(word, 0.0) for word in text.split())
    usual = PAUSES + SECONDS_PER_CHARACTER * len(text)
    return rare + config.tempo_weight * (math.log(max(seconds, 0.05) / usual) / TEMPO_SPREAD) ** 2 / 2
