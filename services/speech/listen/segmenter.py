"""Segmentation of a stream of sound into utterances, with wake word detection in each while it lasts."""

from dataclasses import dataclass

import numpy as np

from common.sound import RATE, Samples
from services.speech.config import SpeechConfig
from services.speech.listen.loudness import FRAME, LOUDER, BackgroundVoices, Gain
from services.speech.listen.own_voice import PAUSE, OwnVoice
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
    """Cuts sound into utterances: `push` takes samples and returns those that pause or end in them.

    Where the microphone hears the robot itself, what is said after it is no part of that utterance.
    """

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
        self._own = OwnVoice()

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

    def push(self, samples: Samples, own: bool = False) -> list[Segment]:
        """Take 16 kHz samples (n,); returns the utterances that pause or end in them. `own`: the robot speaks."""
        found = []
        stream = np.concatenate([self._rest, samples])
        usable = len(stream) // FRAME * FRAME
        self._rest = stream[usable:]
        for start in range(0, usable, FRAME):
            segment = self._frame(stream[start : start + FRAME], own)
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

    def _frame(self, frame: Samples, own: bool) -> Segment | None:
        before = self.speaking
        probability = self._detector(self._gain(frame))
        self._own.push(own, probability > STOP_AT)
        power = float(np.mean(np.square(frame, dtype=np.float32)))
        if not own and self._background.push(power, probability > STOP_AT) < LOUDER:
            probability = 0.0  # the robot itself is no background: who answers it need not be louder
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
        return self._pauses()

    def _pauses(self) -> Segment | None:
        """The utterance if it pauses, once and if it is short. One that the robot spoke in itself is over then."""
        found, over = None, self._endpointer.quiet >= PAUSE and self._own.ends
        short = len(self._frames) * FRAME <= self._short + PRE_ROLL
        if short and not self._examined and (over or self._endpointer.quiet == self._pause):
            self._examined = True
            found = Segment(np.concatenate(self._frames), False, self.wake)
        if over:
            self._frames, self._examined = self._frames[-PAUSE:], False
            self._endpointer.reset()
        return found

    def _end(self) -> Segment:
        segment = Segment(np.concatenate(self._frames), True, self.wake, self._examined)
        self.forget()
        return segment
