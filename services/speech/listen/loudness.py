"""Loudness of the microphone's sound: automatic gain, and the level of background voices."""

from collections import deque

import numpy as np
from numpy.typing import NDArray

from common.sound import RATE

FRAME = 512
"""Samples that the detector takes at once: 32 ms, fixed by Silero's network."""
FULL_SCALE = 32768
"""Steps of 16 bit samples to one side."""
LOUD = 0.3
"""Amplitude, of 1, that the loudest of a sound is brought to for voice detection, which misses words below -40 dB
(chosen: -10 dB)."""
MOST_GAIN = 16.0
"""Most that a stream is amplified for it (chosen: 24 dB, from what a microphone gives across a room)."""
RELEASE = 10 ** (-6.0 / 20 * FRAME / RATE)
"""What is left after a frame of the loudest that was heard: 6 dB less in a second (chosen: faster would lift the noise
between words, which sounds like a voice then)."""
SMOOTHED = round(0.25 * RATE / FRAME)
"""Frames over which loudness is averaged: a quarter of a second (chosen: a syllable)."""
GOING_ON = round(5.0 * RATE / FRAME)
"""Frames of late in which voices count as going on (chosen: commands are shorter)."""
VOICED = 0.6
"""Share of these with a voice, at least (chosen: the rest may be pauses of theirs)."""
MEMORY = round(12.0 * RATE / FRAME)
"""Frames whose quietest are the background: as long as the longest utterance, which so has the silence before it or
that of its own pauses among them."""
QUIETEST = 0.15
"""Quantile of their loudness that is the background's. One who talks is as quiet as the room for that share of the
time, several at once hardly quieter than their mean (chosen: at 0.1 a television is no background, at 0.2 two people
who talk in a quiet room are)."""
LOUDER = 8.0
"""How much louder than that a voice has to be [dB]. Chosen on three voices: 6 and 10 came to the same but for a person
6 dB above the others, whose words 10 cuts."""


class Gain:
    """Amplifies a stream of frames whose loudest of late is too quiet; leaves others as they are."""

    def __init__(self) -> None:
        self._peak = LOUD * FULL_SCALE

    def __call__(self, frame: NDArray[np.int16]) -> NDArray[np.int16]:
        self._peak = max(float(frame.max()), -float(frame.min()), self._peak * RELEASE)
        factor = min(MOST_GAIN, LOUD * FULL_SCALE / max(1.0, self._peak))
        return (frame * np.float32(factor)).astype(np.int16) if factor > 1.0 else frame


class BackgroundVoices:
    """Level of voices that go on for seconds, as of guests who talk or of a television.

    Only who is louder speaks to the robot. Nobody is the background to their own words, as a person pauses: the level
    is that of the quietest moments, as in minimum statistics (R. Martin, "Noise power spectral density estimation
    based on optimal smoothing and minimum statistics", 2001).
    """

    def __init__(self) -> None:
        self._powers: deque[float] = deque(maxlen=SMOOTHED)
        self._levels: deque[float] = deque(maxlen=MEMORY)
        self._voiced: deque[bool] = deque(maxlen=GOING_ON)

    def push(self, power: float, voiced: bool) -> float:
        """By how much a frame of mean power `power`, with those just before it, is louder than the background [dB];
        infinite without voices there."""
        self._powers.append(power)
        level = 10 * float(np.log10(max(sum(self._powers) / len(self._powers), 1.0)))
        self._levels.append(level)
        self._voiced.append(voiced)
        if len(self._voiced) < GOING_ON or sum(self._voiced) < VOICED * GOING_ON:
            return np.inf
        return level - sorted(self._levels)[int(len(self._levels) * QUIETEST)]
