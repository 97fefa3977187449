"""Speech to a command: crop, normalise, take out noise, recognise."""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from common.scene import Scene
from services.speech.config import SpeechConfig
from services.speech.listen.vad import RATE, VoiceDetector, speech_span
from services.speech.recognise.denoise import noise_ratio, reduce_noise
from services.speech.recognise.grammar import Grammar
from services.speech.recognise.packed_network import return_memory
from services.speech.recognise.recogniser import Array, Heard, MoonshineRecogniser, Recogniser, Scope, Sound
from services.speech.recognise.sphinx import SphinxRecogniser

BEFORE, AFTER = 0.2, 0.6
MIN_SAMPLES = 4000
NOISY = 20.0  # [dB]


def without_wake(text: str, phrases: Iterable[str]) -> str:
    """What follows the wake word, or the whole text."""
    for phrase in phrases:
        if f"{text} ".startswith(f"{phrase} "):
            return text[len(phrase) :].strip()
    return text


def prepare(audio: Array, detector: VoiceDetector) -> Sound | None:
    """The part with speech and a little around it, at full scale; with noise, also without it. None: nobody speaks."""
    span = speech_span(audio, detector)
    if span is None:
        return None
    renditions = [audio]
    if noise_ratio(audio, span) < NOISY:
        renditions.append(reduce_noise(audio, span))
    start, end = max(0, span[0] - int(BEFORE * RATE)), min(len(audio), span[1] + int(AFTER * RATE))
    missing = max(0, span[1] + int(AFTER * RATE) - end)
    if end - start < MIN_SAMPLES:
        return None
    scaled = []
    for rendition in renditions:
        part = rendition[start:end]
        peak = float(np.abs(part).max())
        if peak < 1e-4:
            return None
        scaled.append(np.pad(part * np.float32(0.95 / peak), (0, missing)))
    return Sound(np.stack(scaled), (span[1] - span[0]) / RATE)


class Ear:
    """The whole path from samples to a verdict; models load at construction, so make it in the worker."""

    def __init__(self, config: SpeechConfig, scene: Scene, found: dict[Scope, Grammar]) -> None:
        self._detector, self._wake = VoiceDetector(), config.wake
        self._recogniser: Recogniser
        if config.recogniser == "pocketsphinx":
            self._recogniser = SphinxRecogniser(config, scene)
        else:
            self._recogniser = MoonshineRecogniser(config, found)

    def hear(self, samples: NDArray[np.int16], scope: Scope = "command") -> Heard:
        """What 16 kHz int16 samples (n,) say."""
        sound = prepare(samples.astype(np.float32) / np.float32(32768), self._detector)
        if sound is None:
            return Heard("", "silence", 0.0)
        heard = self._recogniser.hear(sound, scope)
        return_memory()
        return replace(heard, text=without_wake(heard.text, self._wake))
