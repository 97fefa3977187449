"""Speech to a command: crop, normalise, recognise, and accept, ask or reject by likelihood ratio."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from common.scene import Scene
from services.speech.config import SpeechConfig
from services.speech.denoise import noise_ratio, reduce_noise
from services.speech.grammar import Grammar, vocabulary
from services.speech.judge import cost, judged, paced
from services.speech.vad import RATE, VoiceDetector, speech_span
from services.speech.weights import return_memory

if TYPE_CHECKING:
    from services.speech.moonshine import Decoded

Array = NDArray[np.float32]
Verdict = Literal["accept", "ask", "reject", "silence"]
Scope = Literal["command", "woken", "interrupt"]
BEFORE, AFTER = 0.2, 0.6
MIN_SAMPLES = 4000
NOISY = 20.0  # [dB]
PACES = (16 / 15, 15 / 16)


@dataclass(frozen=True)
class Heard:
    """What was understood, without the wake word. `verdict`: accept, ask (perhaps), reject (no command), silence."""

    text: str
    verdict: Verdict
    confidence: float
    free: str = ""


@dataclass(frozen=True)
class Sound:
    """An utterance ready for recognition: 16 kHz samples (renditions, n) in -1..1, the recording first, and how many
    `seconds` of it are speech."""

    renditions: Array
    seconds: float

    def paced(self) -> Array:
        """Renditions at other paces (with their pitch), filled with silence to one length: the recording faster, and
        slower without its noise, or else itself."""
        found = [paced(self.renditions[k], factor) for k, factor in zip((0, -1), PACES, strict=True)]
        longest = max(map(len, found))
        return np.stack([np.pad(f, (0, longest - len(f))) for f in found])


class Recogniser(Protocol):
    """Turns an utterance into a command.

    `scope` is the grammar: a command, a command after the wake word or the wake word alone, or stop and cancel only.
    """

    def hear(self, sound: Sound, scope: Scope) -> Heard: ...


class MoonshineRecogniser:
    """Moonshine under the grammar."""

    def __init__(self, config: SpeechConfig, grammars: dict[Scope, Grammar]) -> None:
        from services.speech.moonshine import Moonshine
        from services.speech.tokens import Vocabulary

        self._config = config
        self._model = Moonshine(config.beam)
        self._words = {scope: Vocabulary(self._model.tokens, grammar) for scope, grammar in grammars.items()}

    def hear(self, sound: Sound, scope: Scope) -> Heard:
        config = self._config
        utterance = self._model.encode(sound.renditions)
        free = self._model.free(utterance)

        def weigh(text: str) -> float:
            return cost(text, sound.seconds, config)

        found = self._model.best(utterance, self._words[scope], weigh)
        if not found:
            return Heard("", "reject", 0.0, free.text)
        command, score = judged(found, free, weigh, lambda these: self._again(these, sound))
        confidence = confidence_of(score, config)
        if score >= config.accept_score:
            return Heard(command.text, "accept", confidence, free.text)
        verdict: Verdict = "ask" if score >= config.ask_score else "reject"
        return Heard(command.text, verdict, confidence, free.text)

    def _again(self, sentences: list["Decoded"], sound: Sound) -> list[float]:
        return self._model.log_probabilities(self._model.encode(sound.paced()), sentences)


def confidence_of(score: float, config: SpeechConfig) -> float:
    """0..1: one at a likelihood ratio of 0, one half at the threshold of acceptance."""
    return round(math.exp(min(0.0, score) * math.log(2) / -config.accept_score), 3)


def patterns(config: SpeechConfig, scope: Scope) -> list[str]:
    """The lines of a scope's grammar."""
    if scope == "command":
        return list(config.commands)
    wake = _either(config.wake)
    if scope == "interrupt":
        return [f"[{wake}] {_either((*config.stop, *config.cancel))}"]
    sentences = [line for line in config.commands if not _is_part(line)]
    return [f"{wake} [{_either(sentences)}]", *(line for line in config.commands if _is_part(line))]


def grammars(config: SpeechConfig, scene: Scene) -> dict[Scope, Grammar]:
    """One grammar for each scope.

    Raises:
        GrammarError: a pattern that cannot be used.
    """
    words = vocabulary(scene, config.objects, config.places, config.colours)
    commands = Grammar(patterns(config, "command"), words)
    interrupts = Grammar(patterns(config, "interrupt"), {})
    return {"command": commands, "woken": commands.introduced(config.wake), "interrupt": interrupts}


def _is_part(line: str) -> bool:
    name, equals, _ = line.partition("=")
    return bool(equals) and name.strip().isidentifier()


def _either(patterns: Iterable[str]) -> str:
    return "(" + " | ".join(patterns) + ")"


class Interrupts:
    """Which of the words that end everything were said."""

    def __init__(self, config: SpeechConfig) -> None:
        self._stop, self._cancel = Grammar(config.stop, {}), Grammar(config.cancel, {})

    def of(self, text: str) -> Literal["stop", "cancel", ""]:
        """stop, cancel, or neither."""
        if self._stop.accepts(text):
            return "stop"
        return "cancel" if self._cancel.accepts(text) else ""


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
            from services.speech.sphinx import SphinxRecogniser

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
