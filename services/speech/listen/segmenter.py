"""Segmentation of a stream of sound into utterances, with wake word detection in each while it lasts."""

from dataclasses import dataclass

import numpy as np

from common.sound import RATE, Samples
from services.speech.config import SpeechConfig
from services.speech.listen.loudness import FRAME, LOUDER, BackgroundVoices, Gain
from services.speech.listen.vad import STOP_AT, Endpointer, VoiceDetector
from services.speech.listen.wake_word import WakeWord

PRE_ROLL = int(0.4 * RATE)
"""Samples kept from before an utterance is noticed (chosen: the detector's delay and a soft beginning)."""


@dataclass(frozen=True)
class Segment:
    """An utterance (n,) with a little from before it; `over` is False for one that only pauses, `examined` True when
    nothing was said since its last pause. `wake` is the score of the wake word."""

    samples: Samples
    over: bool
    wake: float
    examined: bool = False


class Segmenter:
    """Cuts sound into utterances: `push` takes samples and returns those that pause or end in them."""

    def __init__(self, config: SpeechConfig) -> None:
        self._detector = VoiceDetector()
        self._endpointer = Endpointer(config.end_silence, config.max_utterance)
        self._gain, self._background = Gain(), BackgroundVoices()
        self._wakes = config.wake_word
        self._wake: WakeWord | None = None
        self._pause = round(config.interrupt_pause * RATE / FRAME)
        self._short = config.interrupt_longest * RATE
        self._frames: list[Samples] = []
        self._rest = np.zeros(0, np.int16)
        self._examined = False

    @property
    def speaking(self) -> bool:
        """True in mid-utterance."""
        return self._endpointer.speaking

    @property
    def wake(self) -> float:
        """The wake word's score in the utterance under way."""
        return self._wake.score if self._wake and self.speaking else 0.0

    def load(self) -> None:
        """Load the wake word's model now rather than at the first utterance."""
        if self._wakes and self._wake is None:
            self._wake = WakeWord()

    def push(self, samples: Samples) -> list[Segment]:
        """Take 16 kHz samples (n,); returns the utterances that pause or end in them."""
        found = []
        stream = np.concatenate([self._rest, samples])
        usable = len(stream) // FRAME * FRAME
        self._rest = stream[usable:]
        for start in range(0, usable, FRAME):
            segment = self._frame(stream[start : start + FRAME])
            if segment is not None:
                found.append(segment)
        return found

    def finish(self) -> Segment | None:
        """The utterance that a stream cut off."""
        return self._end() if self.speaking else None

    def forget(self) -> None:
        """Drop what was heard so far."""
        self._frames, self._rest, self._examined = [], np.zeros(0, np.int16), False
        self._endpointer.reset()
        self._detector.reset()

    def _frame(self, frame: Samples) -> Segment | None:
        before = self.speaking
        probability = self._detector(self._gain(frame))
        power = float(np.mean(np.square(frame, dtype=np.float32)))
        if self._background.push(power, probability > STOP_AT) < LOUDER:
            probability = 0.0
        ended = self._endpointer.push(probability)
        self._frames.append(frame)
        if not self.speaking:
            self._frames = self._frames[-(PRE_ROLL // FRAME) :]
            return None
        if not before:
            self.load()
            if self._wake:
                self._wake.restart()
                self._wake(np.concatenate(self._frames))
        elif self._wake:
            self._wake(frame)
        if ended:
            return self._end()
        if self._endpointer.quiet == 0:
            self._examined = False
        elif self._endpointer.quiet == self._pause and len(self._frames) * FRAME <= self._short + PRE_ROLL:
            self._examined = True
            return Segment(np.concatenate(self._frames), False, self.wake)
        return None

    def _end(self) -> Segment:
        segment = Segment(np.concatenate(self._frames), True, self.wake, self._examined)
        self.forget()
        return segment
