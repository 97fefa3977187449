"""What the microphone in a home hears beside the person: noise that the recordings of `bench.speech` are mixed with."""

from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np

from common.sound import Samples, read_wav
from evaluation.person.ego_noise import EgoNoise
from evaluation.person.voice import Floats, hum, loudness, reverberant, with_noise, with_silence

KINDS = ("white", "hum", "room", "babble", "drive")
"""Hiss; the hum of a room (1/f); with its echoes; others who talk; the robot's fan and drive, at their own level."""
TALKERS = 6
"""Voices that talk at once in `babble`."""
SPEED = 0.3
"""How fast the robot drives for `drive` [m/s]."""


def noisy(samples: Samples, kind: str, snr: float, seed: int, talk: Sequence[Path] = ()) -> Samples:
    """16 kHz samples with silence around them and noise `snr` [dB] below the words over all; `talk`: recordings for
    babble. Repeats for a `seed`."""
    rng = np.random.default_rng([seed, KINDS.index(kind)])
    whole = with_silence(samples)
    level = loudness(samples)
    if kind == "drive":
        return EgoNoise(seed, level).over(whole, SPEED)
    heard = reverberant(whole, rng) if kind == "room" else whole.astype(np.float64)
    if kind == "white":
        noise = rng.normal(0.0, 1.0, len(whole))
    else:
        noise = _babble(len(whole), talk, rng) if kind == "babble" else hum(len(whole), rng)
    return with_noise(heard, noise, level, snr)


def _babble(count: int, talk: Sequence[Path], rng: np.random.Generator) -> Floats:
    """Several recordings at once, each repeated from a random place on (count,); root mean square 1."""
    total = np.zeros(count)
    for k in rng.integers(len(talk), size=TALKERS):
        voice = _read(talk[k]).astype(np.float64)
        voice = np.resize(np.roll(voice, int(rng.integers(len(voice)))), count)
        total += voice / np.sqrt(np.mean(np.square(voice)))
    scaled: Floats = total / np.sqrt(np.mean(np.square(total)))
    return scaled


@cache
def _read(path: Path) -> Samples:
    return read_wav(path)
