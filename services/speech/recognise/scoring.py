"""Which of the sentences that the grammar allows was said, and how sure that is. Pure."""

import math
from collections.abc import Callable
from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from common.language.normalise import normalise
from services.speech.config import SpeechConfig

Array = NDArray[np.float32]
CANDIDATES, HOPELESS, PLAUSIBLE = 6, 8.0, -1.2
# How long sentences take by voice detection: fitted to the voices of the corpus, whose spread is a third of this.
PAUSES, SECONDS_PER_CHARACTER, TEMPO_SPREAD = 0.35, 0.045, 0.25


class Found(Protocol):
    """A sentence, the log-probability of its tokens, and how many these are."""

    @property
    def text(self) -> str: ...
    @property
    def log_probability(self) -> float: ...
    @property
    def tokens(self) -> int: ...


F = TypeVar("F", bound=Found)


def judged(
    found: list[F], free: F, weigh: Callable[[str], float], again: Callable[[list[F]], list[float]]
) -> tuple[F, float]:
    """The likeliest of the sentences `found`, best first, and its likelihood ratio per token to the `free` one.

    Where they differ both were chosen to fit even the noise of the renditions that they were found in. So all are
    judged `again` by others, in which the same noise sounds different to the network. `weigh` tells a sentence's cost.
    """
    best = found[0]
    if normalise(free.text) == best.text:
        return best, (best.log_probability - free.log_probability) / best.tokens
    least = best.log_probability - weigh(best.text) - HOPELESS
    rivals = [f for f in found[:CANDIDATES] if f.log_probability - weigh(f.text) >= least]
    *totals, freely = again([*rivals, free])
    k = int(np.argmax([total - weigh(rival.text) for total, rival in zip(totals, rivals, strict=True)]))
    command = rivals[k]
    first = (command.log_probability - free.log_probability) / command.tokens
    score = (totals[k] - weigh(command.text) - freely) / command.tokens
    # What is far from any command has a free transcription that fits its own rendition only, and so none the other.
    return command, score if first >= PLAUSIBLE else min(score, first)


def paced(samples: Array, factor: float) -> Array:
    """Samples (n,) played `factor` times as fast, with all that they contain."""
    length = round(len(samples) / factor)
    found: Array = (np.fft.irfft(np.fft.rfft(samples), length) / factor).astype(np.float32)
    return found


def cost(text: str, seconds: float, config: SpeechConfig) -> float:
    """What speaks against a sentence however it sounds: words that people hardly use to a robot, and a length that
    does not fit the time that it took."""
    rare = sum(config.rare.get(word, 0.0) for word in text.split())
    usual = PAUSES + SECONDS_PER_CHARACTER * len(text)
    return rare + config.tempo_weight * (math.log(max(seconds, 0.05) / usual) / TEMPO_SPREAD) ** 2 / 2
