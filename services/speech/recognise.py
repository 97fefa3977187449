"""Speech to a command: crop, normalise, recognise, and accept, ask or reject by likelihood ratio."""

import math
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from common.scene import Scene
from services.speech.config import SpeechConfig
from services.speech.grammar import Grammar, vocabulary
from services.speech.vad import RATE, VoiceDetector, speech_span

Array = NDArray[np.float32]
BEFORE, AFTER = 0.2, 0.6
MIN_SAMPLES = 4000


@dataclass(frozen=True)
class Heard:
    """What was understood. `verdict`: accept, ask (perhaps), reject (no command), silence."""

    text: str
    verdict: Literal["accept", "ask", "reject", "silence"]
    confidence: float
    free: str = ""


class Recogniser(Protocol):
    """Turns 16 kHz samples in -1..1 (n,) that contain speech into a command."""

    def hear(self, audio: Array) -> Heard: ...


class MoonshineRecogniser:
    """Moonshine under the grammar."""

    def __init__(self, config: SpeechConfig, grammar: Grammar) -> None:
        from services.speech.moonshine import Moonshine

        self._config = config
        self._model = Moonshine(grammar, config.beam)

    def hear(self, audio: Array) -> Heard:
        free, command = self._model.recognise(audio)
        if command is None:
            return Heard("", "reject", 0.0, free.text)
        score = (command.log_probability - free.log_probability) / command.tokens
        confidence = confidence_of(score, self._config)
        if score >= self._config.accept_score:
            return Heard(command.text, "accept", confidence, free.text)
        verdict: Literal["ask", "reject"] = "ask" if score >= self._config.ask_score else "reject"
        return Heard(command.text, verdict, confidence, free.text)


def confidence_of(score: float, config: SpeechConfig) -> float:
    """0..1: one at a likelihood ratio of 0, one half at the threshold of acceptance."""
    return round(math.exp(min(0.0, score) * math.log(2) / -config.accept_score), 3)


def command_grammar(config: SpeechConfig, scene: Scene) -> Grammar:
    """The configured patterns over the words of the scene.

    Raises:
        GrammarError: a pattern that cannot be used.
    """
    return Grammar(config.commands, vocabulary(scene, config.objects, config.places, config.colours))


def prepare(audio: Array, detector: VoiceDetector) -> Array | None:
    """The part with speech and a little around it, at full scale; None when nobody speaks."""
    span = speech_span(audio, detector)
    if span is None:
        return None
    start, end = max(0, span[0] - int(BEFORE * RATE)), min(len(audio), span[1] + int(AFTER * RATE))
    part = audio[start:end]
    peak = float(np.abs(part).max())
    if peak < 1e-4 or len(part) < MIN_SAMPLES:
        return None
    missing = span[1] + int(AFTER * RATE) - end
    scaled = part * (0.95 / peak)
    return np.concatenate([scaled, np.zeros(missing, np.float32)]) if missing > 0 else scaled


class Ear:
    """The whole path from samples to a verdict; models load at construction, so make it in the worker."""

    def __init__(self, config: SpeechConfig, scene: Scene, grammar: Grammar) -> None:
        self._detector = VoiceDetector()
        self._recogniser: Recogniser
        if config.recogniser == "pocketsphinx":
            from services.speech.sphinx import SphinxRecogniser

            self._recogniser = SphinxRecogniser(config, scene)
        else:
            self._recogniser = MoonshineRecogniser(config, grammar)

    def hear(self, samples: NDArray[np.int16]) -> Heard:
        """What 16 kHz int16 samples (n,) say."""
        audio = prepare(samples.astype(np.float32) / np.float32(32768), self._detector)
        return Heard("", "silence", 0.0) if audio is None else self._recogniser.hear(audio)
