"""The front end of speech recognition: voice activity, gain, noise reduction, then the recogniser."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from common.household import Household
from common.process.host import return_memory
from common.sound import RATE
from services.speech.config import SpeechConfig
from services.speech.listen.vad import VoiceDetector, speech_span
from services.speech.recognise.denoise import noise_ratio, reduce_noise
from services.speech.recognise.free_text import cost, freely, without_itself
from services.speech.recognise.grammar import Grammar, known_names
from services.speech.recognise.recogniser import Array, PreparedUtterance, Recogniser, Recognition, Scope
from services.speech.recognise.wake_text import without_wake
from services.speech.recognise.word_ngrams import WordNgrams, classes

BEFORE, AFTER = 0.2, 0.6
"""Sound kept around the speech [s]. Chosen: room for soft beginnings and endings, which voice detection misses."""
MIN_SAMPLES = 4000
"""Shortest sound that is worth recognising: a quarter of a second."""
NOISY = 20.0
"""Speech to noise [dB] below which a variant without the noise is recognised, too."""
PEAK = 0.95
"""Amplitude to which every variant is scaled, of 1."""
SILENT_PEAK = 1e-4
"""Amplitude of what is silence whatever the detector says: a few steps of 16 bit."""


def prepare(audio: Array, detector: VoiceDetector) -> PreparedUtterance | None:
    """Samples (n,) at 16 kHz cropped to the speech and scaled, with noise also a variant without it.

    None when nobody speaks.
    """
    span = speech_span(audio, detector)
    if span is None:
        return None
    variants = [audio]
    if noise_ratio(audio, span) < NOISY:
        variants.append(reduce_noise(audio, span))
    start, end = max(0, span[0] - int(BEFORE * RATE)), min(len(audio), span[1] + int(AFTER * RATE))
    missing = max(0, span[1] + int(AFTER * RATE) - end)
    if end - start < MIN_SAMPLES:
        return None
    scaled = []
    for variant in variants:
        part = variant[start:end]
        peak = float(np.abs(part).max())
        if peak < SILENT_PEAK:
            return None
        scaled.append(np.pad(part * np.float32(PEAK / peak), (0, missing)))
    return PreparedUtterance(np.stack(scaled), (span[1] - span[0]) / RATE)


class FrontEnd:
    """Recognition from samples to verdict; loads models at construction, so it is made in the worker."""

    def __init__(self, config: SpeechConfig, household: Household, found: dict[Scope, Grammar]) -> None:
        from services.speech.recognise import moonshine

        self._detector, self._config = VoiceDetector(), config
        self._know(household, ())
        model = moonshine.load(config.beam)
        self._recogniser = Recogniser(
            config,
            model,
            found,
            lambda text: cost(text, self._names, config),
            lambda text, whole: self._expected(text, whole),
        )

    def _know(self, household: Household, names: Sequence[str]) -> None:
        self._names = known_names(self._config, household, names)
        self._expected = WordNgrams(classes(self._config, household, names), self._config.wake)

    def recognise(self, samples: NDArray[np.int16], scope: Scope = "command", detected: float = 0.0) -> Recognition:
        """Recognise 16 kHz int16 samples (n,); `detected` is the wake word detector's score for them."""
        utterance = prepare(samples.astype(np.float32) / np.float32(32768), self._detector)
        if utterance is None:
            return Recognition("", "silence", 0.0)
        found = self._recogniser.recognise(utterance, scope, detected)
        return_memory()
        if scope == "interrupt":
            return replace(found, text=without_wake(found.text, self._config.wake))
        return without_itself(freely(found, self._names, self._config))

    def learn(self, household: Household, names: Sequence[str]) -> None:
        """Add the names of this household, and these names of things, to the grammars."""
        self._recogniser.learn(household, names)
        self._know(household, names)
