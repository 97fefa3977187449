"""The front end of speech recognition: voice activity, gain, noise reduction, then the recogniser."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from difflib import SequenceMatcher

import numpy as np
from numpy.typing import NDArray

from common.household import Household
from common.language.meaning import asks_for
from common.language.normalise import normalise
from common.language.spoken import is_understood, turns
from common.process.host import return_memory
from services.speech.config import SpeechConfig
from services.speech.listen.vad import RATE, VoiceDetector, speech_span
from services.speech.recognise.denoise import noise_ratio, reduce_noise
from services.speech.recognise.grammar import Grammar, known_names
from services.speech.recognise.recogniser import (
    Array,
    MoonshineRecogniser,
    PreparedUtterance,
    Recogniser,
    Recognition,
    Scope,
)
from services.speech.recognise.sphinx import SphinxRecogniser

BEFORE, AFTER = 0.2, 0.6
"""Sound kept around the speech [s]. Chosen: room for soft beginnings and endings, which voice detection misses."""
MIN_SAMPLES = 4000
"""Shortest sound that is worth recognising: a quarter of a second."""
NOISY = 20.0
"""Speech to noise [dB] below which a variant without the noise is recognised, too."""
PEAK = 0.95
"""Amplitude to which every variant is scaled, of 1."""
FREE = 0.5
"""Confidence of words that no grammar has vouched for. Chosen: below that from which the brain does not ask."""
WAKE_LIKENESS = 0.85
"""Least share of letters in common with the wake word (chosen: `they jarvins` has 0.91, `hey travis` 0.8)."""
SILENT_PEAK = 1e-4
"""Amplitude of what is silence whatever the detector says: a few steps of 16 bit."""


def without_wake(text: str, phrases: Iterable[str]) -> str:
    """Text after the wake word or what is written nearly so (`they jarvins`), or the whole text."""
    words = text.split()
    for phrase in phrases:
        width = len(phrase.split())
        if SequenceMatcher(None, " ".join(words[:width]).strip(","), phrase).ratio() >= WAKE_LIKENESS:
            return " ".join(words[width:])
    return text


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
    """The whole path from samples to a verdict; models load at construction, so make it in the worker."""

    def __init__(self, config: SpeechConfig, household: Household, found: dict[Scope, Grammar]) -> None:
        self._detector, self._wake, self._config = VoiceDetector(), config.wake, config
        self._names = known_names(config, household, ())
        self._recogniser: Recogniser
        if config.recogniser == "pocketsphinx":
            self._recogniser = SphinxRecogniser(config, household)
        else:
            self._recogniser = MoonshineRecogniser(config, found)

    def recognise(self, samples: NDArray[np.int16], scope: Scope = "command") -> Recognition:
        """What 16 kHz int16 samples (n,) say, without the wake word."""
        utterance = prepare(samples.astype(np.float32) / np.float32(32768), self._detector)
        if utterance is None:
            return Recognition("", "silence", 0.0)
        found = self._recogniser.recognise(utterance, scope)
        return_memory()
        text = without_wake(found.text, self._wake)
        if scope != "interrupt" and (freely := self._freely(found, text)):
            return replace(found, text=freely, verdict="accept", confidence=min(found.confidence, FREE))
        return replace(found, text=text)

    def learn(self, household: Household, names: Sequence[str]) -> None:
        """Listen for the names of this household, and for these of things as well."""
        self._recogniser.learn(household, names)
        self._names = known_names(self._config, household, names)

    def _freely(self, found: Recognition, text: str) -> str:
        """The free transcription where it tells more than the grammar holds, "" where it does not.

        That is what the planner would understand, or what makes something else of what the grammar accepted: "who put
        the mug there" is no "put the mug there".
        """
        heard = without_wake(normalise(found.free), self._wake)
        if found.verdict == "accept":
            more = text and turns(heard, text) and not asks_for(text, "stop", "cancel", "yes", "no")
        else:
            more = is_understood(self._marked(found.free), self._names)
        return self._marked(found.free) if more else ""

    def _marked(self, free: str) -> str:
        """A transcription with its commas, without the wake word."""
        return without_wake(normalise(free, ",").strip(" ,"), self._wake).strip(" ,")
