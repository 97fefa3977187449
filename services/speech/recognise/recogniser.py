"""An utterance to a command: recognised under the grammar; a likelihood ratio accepts, asks or rejects."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from common.language.wordings import INTERRUPTS
from common.scene import Scene
from services.speech.config import SpeechConfig
from services.speech.recognise.grammar import Grammar, vocabulary
from services.speech.recognise.scoring import cost, judged, paced

if TYPE_CHECKING:
    from services.speech.recognise.moonshine import Decoded

Array = NDArray[np.float32]
Verdict = Literal["accept", "ask", "reject", "silence"]
Scope = Literal["command", "woken", "interrupt"]
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
        from services.speech.recognise.moonshine import Moonshine
        from services.speech.recognise.token_trie import Vocabulary

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
        return [f"[{wake}] {_either(line for lines in INTERRUPTS.values() for line in lines)}"]
    sentences = [line for line in config.commands if not _is_part(line)]
    return [f"{wake} [{_either(sentences)}]", *(line for line in config.commands if _is_part(line))]


def grammars(config: SpeechConfig, scene: Scene) -> dict[Scope, Grammar]:
    """One grammar for each scope.

    Raises:
        PatternError: a pattern that cannot be used.
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
