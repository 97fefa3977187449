"""Loudness of the microphone's sound: automatic gain, and the level of background voices."""

from collections import deque
from itertools import islice

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
BACK, SPAN = round(5.0 * RATE / FRAME), round(4.0 * RATE / FRAME)
"""Frames after which, and over which, voices are background that still go on: those from 5 to 9 s ago (chosen:
commands are shorter)."""
UNVOICED = 0.4
"""Share of the time that may be pauses of the voices, and the quantile of their loudness that counts (chosen)."""
LOUDER = 6.0
"""How much louder than the background a voice has to be [dB] (chosen: several people who talk vary by half of it)."""


class Gain:
    """Amplifies a stream of frames whose loudest of late is too quiet; leaves others as they are."""

    def __init__(self) -> None:
        self._peak = LOUD * FULL_SCALE

    def __call__(self, frame: NDArray[np.int16]) -> NDArray[np.int16]:
        self._peak = max(float(frame.max()), -float(frame.min()), self._peak * RELEASE)
        factor = min(MOST_GAIN, LOUD * FULL_SCALE / max(1.0, self._peak))
        return (frame * np.float32(factor)).astype(np.int16) if factor > 1.0 else frame


class BackgroundVoices:
    """Level of voices that go on for seconds, as of a television or of guests who talk.

    Only who is louder speaks to the robot. A command is over before it counts itself.
    """

    def __init__(self) -> None:
        self._powers: deque[float] = deque(maxlen=SMOOTHED)
        self._levels: deque[float] = deque(maxlen=BACK + SPAN)

    def push(self, power: float, voiced: bool) -> float:
        """By how much a frame of mean power `power`, with those just before it, is louder than the background [dB];
        infinite without voices there."""
        self._powers.append(power)
        level = 10 * float(np.log10(max(sum(self._powers) / len(self._powers), 1.0)))
        self._levels.append(level if voiced else -np.inf)
        if len(self._levels) < SPAN + BACK:
            return np.inf
        before, since = (sorted(islice(self._levels, *part)) for part in ((0, SPAN), (SPAN, None)))
        going_on = since[int(BACK * UNVOICED)] > -np.inf
        return level - before[int(SPAN * UNVOICED)] if going_on else np.inf
