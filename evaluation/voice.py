"""The person's voice: sentences as 16 kHz samples, with a breath before and silence after, in a noisy room if asked."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from services.speech.speak import Voice

RATE = 16000
LEAD, TAIL = 0.3, 1.2
Samples = NDArray[np.int16]


@cache
def _voice() -> Voice:
    return Voice()


@cache
def _sentence(text: str) -> Samples:
    return _voice().speak(text)


def utter(text: str, noise: float | None = None, seed: int = 0) -> Samples:
    """Samples (n,); `noise` is the signal-to-noise ratio [dB] of white noise over the whole."""
    quiet = np.zeros(round(LEAD * RATE), np.int16), np.zeros(round(TAIL * RATE), np.int16)
    speech = _sentence(text)
    whole = np.concatenate((quiet[0], speech, quiet[1]))
    if noise is None:
        return whole
    loudness = float(np.sqrt(np.mean(np.square(speech.astype(np.float64)))))
    hiss = np.random.default_rng([seed, 29]).normal(0.0, loudness * 10 ** (-noise / 20), len(whole))
    return np.clip(whole + hiss, -32768, 32767).astype(np.int16)
