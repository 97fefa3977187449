"""The wake word "hey jarvis": openWakeWord's detector (https://github.com/dscripka/openWakeWord), run on utterances."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from common.runtime import StartError

CHUNK = 1280
"""Samples that the detector takes at once: 80 ms, fixed by openWakeWord."""
MEMORY = 48000
"""Samples of silence that the detector begins with; its network sees the last 2 s."""


class WakeWord:
    """Score 0..1 of the wake word in the utterance so far. It listens only to utterances, which spares the CPU."""

    def __init__(self) -> None:
        try:
            from pyopen_wakeword import Model, OpenWakeWord, OpenWakeWordFeatures

            self._features = OpenWakeWordFeatures.from_builtin()
            self._model = OpenWakeWord.from_builtin(Model.HEY_JARVIS)
        except (ImportError, OSError) as error:
            raise StartError(f"speech.wake_word needs pyopen-wakeword and glibc 2.35: {error}") from None
        self._rest = np.zeros(0, np.int16)
        self.score = 0.0
        self._features.new_audio_samples = MEMORY  # of silence; it would begin with 8 s, of which it uses 2
        self._push(np.zeros(CHUNK, np.int16))
        self._silence = self._state()

    def restart(self) -> None:
        """A new utterance, after silence."""
        self._rest = np.zeros(0, np.int16)
        self.score = 0.0
        for owner, name, value in self._silence:
            setattr(owner, name, value.copy() if isinstance(value, np.ndarray) else value)

    def __call__(self, samples: NDArray[np.int16]) -> float:
        """The highest score since `restart`, with these 16 kHz samples (n,) heard."""
        stream = np.concatenate([self._rest, samples])
        usable = len(stream) // CHUNK * CHUNK
        self._rest = stream[usable:]
        for start in range(0, usable, CHUNK):
            self._push(stream[start : start + CHUNK])
        return self.score

    def _push(self, chunk: NDArray[np.int16]) -> None:
        for embedding in self._features.process_streaming(chunk.tobytes()):
            for score in self._model.process_streaming(embedding):
                self.score = max(self.score, float(score))

    def _state(self) -> list[tuple[Any, str, Any]]:
        """What the detector remembers: filling it with silence takes time, copying it none."""
        kept: list[tuple[Any, str]] = [
            (self._features, name) for name in ("new_audio_samples", "audio", "new_mels", "mels")
        ]
        kept += [(self._model, name) for name in ("new_embeddings", "embeddings")]
        copied: list[tuple[Any, str, Any]] = []
        for owner, name in kept:
            value = getattr(owner, name)
            copied.append((owner, name, value.copy() if isinstance(value, np.ndarray) else value))
        return copied
