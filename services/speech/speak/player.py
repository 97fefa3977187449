"""The robot's voice on the bus and on the speakers: one sentence at a time, a tenth of a second of it a step."""

import numpy as np

from common import messages as m
from common import topics
from common.bus.port import Io, Job
from common.sound import RATE, Samples
from services.speech.sound_card import Speakers
from services.speech.speak.voice import Voice, voice

CHUNK = RATE // 10
"""Samples published per step: the service steps at 10 Hz."""


class TtsPlayer:
    """Synthesis runs in the worker; the voice is loaded at once with `preload`, else when first used."""

    def __init__(self, io: Io, speakers: bool, seconds: float, preload: bool = False) -> None:
        self._io, self._seconds = io, seconds
        self._speakers = Speakers() if speakers else None
        self._voice: Job[Voice] | None = io.submit(voice) if preload else None
        self._synthesis: Job[Samples] | None = None
        self._sound = np.zeros(0, np.int16)
        self._sequence = 0
        self.saying = ""

    def say(self, text: str) -> None:
        """Begin a sentence; one that is being said is broken off."""
        self.stop()
        loaded = self._voice = self._voice or self._io.submit(voice)
        self.saying = text
        self._synthesis = self._io.submit(lambda: loaded.result().speak(text), seconds=self._seconds)

    def step(self, now: float) -> bool:
        """Play the next tenth of a second; True when the sentence has ended in this step."""
        if self._synthesis is None:
            return False
        if not len(self._sound):
            if not self._synthesis.poll(now):
                return False
            self._sound = self._synthesis.result()
            if self._speakers:
                self._speakers.play(self._sound)
        part, self._sound = self._sound[:CHUNK], self._sound[CHUNK:]
        last = not len(self._sound)
        chunk = m.AudioChunk(t=now, data=part.tobytes(), rate=RATE, seq=self._sequence, end=last)
        self._sequence += 1
        self._io.publish(topics.AUDIO_OUT, chunk)
        if last:
            self._synthesis, self.saying = None, ""
        return last

    def stop(self) -> None:
        """Break off the sentence, at once."""
        self._synthesis, self.saying = None, ""
        self._sound = np.zeros(0, np.int16)
        if self._speakers:
            self._speakers.stop()
