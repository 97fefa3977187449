"""The person's voice: sentences as 16 kHz samples, a breath before and silence after, in a noisy room if asked."""

from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from common.sound import RATE, Samples
from evaluation.case import Speaker
from services.speech.speak.voice import voice

LEAD, TAIL = 0.3, 1.2
"""Silence [s] before and after a sentence."""
WAKE, GAP = "hey jarvis", 0.25
"""The wake word as it is recorded alone, and the pause [s] between it and a command recorded alone."""
ECHO, DIRECT = 0.3, 12.0
"""Reverberation of a furnished living room: decay by 60 dB in 0.3 s (ISO 3382-2 finds 0.3 to 0.6 s), and the level of
the direct sound over the echoes at one metre [dB]."""
Floats = NDArray[np.float64]


@cache
def _sentence(text: str) -> Samples:
    return voice().speak(text)


def utter(text: str, noise: float | None = None, seed: int = 0, speaker: Speaker | None = None) -> Samples:
    """Samples (n,); `noise` is the signal-to-noise ratio [dB] over the whole.

    White noise, or with `speaker.room` the hum of a room (1/f) and its echoes.
    """
    speaker = speaker or Speaker()
    speech = _spoken(text, speaker)
    whole = with_silence(speech)
    if noise is None and not speaker.room:
        return whole
    rng = np.random.default_rng([seed, 29])
    sound = reverberant(whole, rng) if speaker.room else whole.astype(np.float64)
    if noise is None:
        return _samples(sound)
    level = float(np.sqrt(np.mean(np.square(speech.astype(np.float64)))))
    hiss = hum(len(whole), rng) if speaker.room else rng.normal(0.0, 1.0, len(whole))
    return with_noise(sound, hiss, level, noise)


def with_silence(speech: Samples) -> Samples:
    """A breath before and silence after."""
    return np.pad(speech, (round(LEAD * RATE), round(TAIL * RATE)))


def with_noise(sound: Floats, noise: Floats, level: float, snr: float) -> Samples:
    """`sound` (n,) and `noise` (n,) of root mean square 1, which is `snr` [dB] below `level` [int16 steps]."""
    return _samples(sound + level * 10 ** (-snr / 20) * noise)


def _samples(sound: Floats) -> Samples:
    return np.clip(sound, -32768, 32767).astype(np.int16)


def loudness(samples: Samples) -> float:
    """Root mean square [int16 steps] of what is louder than a hundredth of the loudest: of words, not of pauses."""
    sound = np.abs(samples.astype(np.float64))
    words = sound[sound > 0.01 * sound.max(initial=0.0)]
    return float(np.sqrt(np.mean(np.square(words)))) if len(words) else 0.0


def _spoken(text: str, speaker: Speaker) -> Samples:
    """The recording of the sentence, or of the wake word and of the rest; else the robot's own voice at a pace."""
    recorded = {_key(k): np.frombuffer(v, "<i2").astype(np.int16) for k, v in speaker.recordings.items()}
    words = _key(text)
    if words in recorded:
        return recorded[words]
    rest = words.removeprefix(WAKE).strip()
    if rest != words and rest in recorded and WAKE in recorded:
        return np.concatenate((recorded[WAKE], np.zeros(round(GAP * RATE), np.int16), recorded[rest]))
    said = _sentence(text)
    if speaker.pace == 1.0:
        return said
    at = np.arange(0, len(said) - 1, speaker.pace)
    paced: Samples = np.interp(at, np.arange(len(said)), said).astype(np.int16)
    return paced


def _key(text: str) -> str:
    return " ".join("".join(c if c.isalnum() or c == "'" else " " for c in text.lower()).split())


def reverberant(samples: Samples, rng: np.random.Generator) -> Floats:
    """Through a room: the direct sound and a tail of noise that decays exponentially."""
    t = np.arange(round(ECHO * RATE)) / RATE
    tail = rng.normal(0.0, 1.0, len(t)) * 10 ** (-3 * t / ECHO)
    tail *= 10 ** (-DIRECT / 20) / np.sqrt(np.sum(np.square(tail)))
    tail[0] = 1.0
    return _convolved(samples.astype(np.float64), tail)[: len(samples)]


def _convolved(a: Floats, b: Floats) -> Floats:
    """The convolution (n + m - 1,) of two signals (n,) and (m,), as `scipy.signal.fftconvolve`.

    Importing scipy.signal for this alone takes 1 s and 30 MB in every process of an evaluation.
    """
    length = len(a) + len(b) - 1
    size = fft.next_fast_len(length, real=True)
    found: Floats = fft.irfft(fft.rfft(a, size) * fft.rfft(b, size), size)[:length]
    return found


def hum(count: int, rng: np.random.Generator) -> Floats:
    """Noise (n,) with a spectrum of 1/f from 20 Hz, root mean square 1: fans, fridge, street."""
    spectrum = np.fft.rfft(rng.normal(0.0, 1.0, count))
    frequency = np.maximum(np.fft.rfftfreq(count, 1 / RATE), 20.0)
    noise = np.fft.irfft(spectrum / np.sqrt(frequency), count)
    scaled: Floats = noise / np.sqrt(np.mean(np.square(noise)))
    return scaled
