"""Sources of sound: clients, the microphone, or a recording in its place."""

from pathlib import Path

import numpy as np

from common import topics
from common.bus.port import Io
from common.sound import RATE, Samples, read_wav, resample
from services.speech.config import SpeechConfig
from services.speech.sound_card import Microphone
from services.speech.speak.player import CHUNK


class SoundSources:
    """All sources together, at 16 kHz.

    Raises:
        AudioError: the configured recording cannot be read.
    """

    def __init__(self, config: SpeechConfig, io: Io) -> None:
        self._io = io
        self._recording: Samples | None = read_wav(Path(config.wav)) if config.wav else None
        self._microphone = Microphone() if config.microphone else None

    def take(self, listening: bool) -> list[tuple[Samples, bool]]:
        """The samples since the last step, each piece with whether it is meant for the robot.

        `listening`: the brain listens; only then the recording goes on.
        """
        found: list[tuple[Samples, bool]] = []
        for chunk in self._io.take_all(topics.AUDIO_PCM):
            if len(chunk.data) % 2 or not 4000 <= chunk.rate <= 192000:
                self._io.count_drop(topics.AUDIO_PCM.key, "not 16 bit samples at 4 to 192 kHz")
                continue
            samples = np.frombuffer(chunk.data, "<i2").astype(np.int16)
            samples = samples if chunk.rate == RATE else resample(samples.astype(np.float32), chunk.rate)
            found.append((samples, chunk.addressed))
        if self._microphone:
            room = self._microphone.take()
            if not found:  # two sources mixed would be understood by nobody
                found += [(samples, False) for samples in room]
        if self._recording is not None and listening:
            found.append((self._recording[:CHUNK], False))
            self._recording = self._recording[CHUNK:] if len(self._recording) > CHUNK else None
            if self._recording is None:
                found.append((np.zeros(RATE, np.int16), False))
        return found

    def close(self) -> None:
        """Close the microphone."""
        if self._microphone:
            self._microphone.close()
