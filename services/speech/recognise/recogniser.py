"""Recognition of one utterance under a grammar; a likelihood ratio decides between accept, ask and reject."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from common.household import Household
from common.language.normalise import normalise
from common.language.wordings import INTERRUPTS
from common.messages import Transcription
from services.speech.config import SpeechConfig
from services.speech.recognise.grammar import Grammar, vocabulary
from services.speech.recognise.scoring import likeliest, prior_cost, ranked, rescored, time_scaled
from services.speech.recognise.token_trie import TokenTrie
from services.speech.recognise.wake_text import clauses, without_wake

if TYPE_CHECKING:
    from services.speech.recognise.moonshine import Decoded, EncodedUtterance, Moonshine

Array = NDArray[np.float32]
Verdict = Literal["accept", "ask", "reject", "silence"]
Scope = Literal["command", "woken", "interrupt"]
CLEAR = 0.9
"""Certainty of a transcription from which no other is looked for. Chosen: of 40 everyday sentences, quiet or among
voices, none came to anything else, at two thirds of the CPU time where it was quiet."""
OTHERS = 12
"""Most transcriptions without a grammar that are scored a second time (chosen: twice those of the grammar; among other
voices the search finishes two hundred, and to score all takes four times as long as all else)."""
PACES = (16 / 15, 15 / 16)
"""Factors of speed for the second scoring. Chosen: a semitone up and down, far less than voices differ."""


@dataclass(frozen=True)
class Recognition:
    """What was understood, without the wake word. `verdict`: accept, ask (perhaps), reject (no command), silence.

    `free` is the transcription without any grammar (where the wake word was verified, without that, however it was
    transcribed), `certainty` 0..1 the geometric mean probability of its tokens, `share` 0..1 how probable it is among
    other transcriptions, 0 where these were not looked for. `mistaken`: what began the utterance was taken for the wake
    word and is something else. `alternatives`: all that it may have been, the likeliest first.
    """

    text: str
    verdict: Verdict
    confidence: float
    free: str = ""
    certainty: float = 0.0
    mistaken: bool = False
    share: float = 0.0
    alternatives: tuple[Transcription, ...] = ()


@dataclass(frozen=True)
class PreparedUtterance:
    """An utterance ready for recognition: 16 kHz samples (variants, n) in -1..1, the recording first, and how many
    `seconds` of it are speech."""

    variants: Array
    seconds: float

    def time_scaled(self) -> Array:
        """Variants (2, m) at other speeds, filled with silence to one length.

        The recording is faster, the last variant (without noise if there is one) slower.
        """
        found = [time_scaled(self.variants[k], factor) for k, factor in zip((0, -1), PACES, strict=True)]
        longest = max(map(len, found))
        return np.stack([np.pad(f, (0, longest - len(f))) for f in found])


class Recogniser:
    """Turns utterances into commands: Moonshine base-en under the grammar of a scope.

    `scope` is the grammar: a command, with or without the wake word, or the wake word alone (where `woken`, it is also
    verified that the wake word was said, of which the detector's score is `detected`); or stop and cancel only.
    Of transcriptions without the grammar that sound alike, `cost` tells which is unlikely to be said to the robot: a
    negative log-probability. `expected` is the same for the words with which a sentence begins, or a whole one.
    """

    def __init__(
        self,
        config: SpeechConfig,
        model: "Moonshine",
        grammars: dict[Scope, Grammar],
        cost: Callable[[str], float],
        expected: Callable[[str, bool], float],
    ) -> None:
        self._config, self._model, self._cost, self._expected = config, model, cost, expected
        self._tries = self._compiled(grammars)

    def learn(self, household: Household, names: Sequence[str]) -> None:
        """Add names of things to the grammars, beside those of the configuration and the household."""
        self._tries = self._compiled(grammars(self._config, household, names))

    def _compiled(self, found: dict[Scope, Grammar]) -> dict[Scope, TokenTrie]:
        return {scope: TokenTrie(self._model.tokens, grammar) for scope, grammar in found.items()}

    def recognise(self, utterance: PreparedUtterance, scope: Scope, detected: float = 0.0) -> Recognition:
        config = self._config
        encoded = self._model.encode(utterance.variants)
        free = self._model.free(encoded)

        def prior(text: str) -> float:
            return prior_cost(text, utterance.seconds, config)

        @cache
        def encoded_again() -> "EncodedUtterance":
            return self._model.encode(utterance.time_scaled())

        def score_again(sentences: list["Decoded"]) -> list[float]:
            return self._model.log_probabilities(encoded_again(), sentences)

        found = self._model.best(encoded, self._tries["interrupt" if scope == "interrupt" else "command"], prior)
        certainty = math.exp(free.log_probability / free.tokens)
        rest = self._after_wake(encoded, free, score_again, detected) if scope == "woken" else free.text
        mistaken, rest = rest is None, free.text if rest is None else rest
        if not found:
            return Recognition("", "reject", 0.0, rest, certainty, mistaken)
        command, score, share, worth = rescored(found, free, prior, score_again)
        confidence = round(share * confidence_of(score, config), 3)
        verdict = verdict_of(score, certainty, config)
        if not rest and verdict != "accept":
            return Recognition("", "ask", confidence, rest, certainty)
        texts = [(self._plain(rest if one is free else one.text), value) for one, value in worth]
        heard = Recognition(command.text, verdict, confidence, rest, certainty, mistaken, alternatives=ranked(texts))
        known = not rest or (verdict == "accept" and normalise(rest) == command.text)
        if scope == "interrupt" or mistaken or known or certainty >= CLEAR:
            return heard

        def worded(text: str) -> float:
            return prior(text) + self._expected(text, True)

        others = self._model.freely(encoded, worded, lambda text: self._expected(text, False))[:OTHERS]
        texts = [(text, value - self._expected(text, True)) for text, value in texts]
        return self._among_others(
            heard, others, score_again, lambda text: worded(text) + self._cost(text), scope == "woken", texts
        )

    def _among_others(
        self,
        heard: Recognition,
        others: list["Decoded"],
        score: Callable[[list["Decoded"]], list[float]],
        cost: Callable[[str], float],
        woken: bool,
        texts: list[tuple[str, float]],
    ) -> Recognition:
        """With the likeliest of other transcriptions, too, by what may be said to the robot in that time.

        `texts`: what else it may have been, with its log-probability.
        """
        if not others:
            return heard
        chosen, share, worth = likeliest(others, score(others), cost)
        worded = [(self._plain(one.text), value) for one, value in worth if not woken or self._wakes(one)]
        heard = replace(heard, alternatives=ranked([*texts, *worded]))
        if woken and not self._wakes(chosen):
            return heard  # in it the wake word reads otherwise: nobody knows where the command begins
        certainty = math.exp(chosen.log_probability / chosen.tokens)
        return replace(heard, free=self._plain(chosen.text) if woken else chosen.text, certainty=certainty, share=share)

    def _plain(self, text: str) -> str:
        return without_wake(clauses(text), self._config.wake).strip(" ,")

    def _wakes(self, sentence: "Decoded") -> bool:
        """Does a transcription begin with the wake word as it is written?"""
        return without_wake(spelled := clauses(sentence.text), self._config.wake) != spelled

    def _after_wake(
        self,
        encoded: "EncodedUtterance",
        free: "Decoded",
        score: Callable[[list["Decoded"]], list[float]],
        detected: float,
    ) -> str | None:
        """The free transcription after the words in whose place the wake word is likeliest; None where that and the
        detector's score, as independent evidence, speak against it."""
        wake = self._model.best(encoded, self._tries["woken"], lambda text: 0.0)
        if not wake:
            return None
        options = self._model.begun_with(wake[0].numbers[:-1], free)
        total, *others = score([free, *options])
        best = int(np.argmax(others))
        evidence = others[best] - total + log_odds(detected)
        return options[best].text if evidence >= self._config.wake_score else None


def verdict_of(score: float, certainty: float, config: SpeechConfig) -> Verdict:
    """Accept, ask or reject by a log-likelihood ratio; where the free transcription is doubtful, too, more is asked."""
    if score >= config.accept_score:
        return "accept"
    return "ask" if score >= (config.ask_score if certainty >= config.certain else config.guess_score) else "reject"


def confidence_of(score: float, config: SpeechConfig) -> float:
    """Confidence 0..1 of a log-likelihood ratio: one at 0 and above, one half at the threshold of acceptance."""
    return math.exp(min(0.0, score) * math.log(2) / -config.accept_score)


def log_odds(probability: float) -> float:
    """Natural logarithm of the odds of a probability, of which none counts as certain."""
    bounded = min(max(probability, 1e-3), 1 - 1e-3)
    return math.log(bounded / (1 - bounded))


def patterns(config: SpeechConfig, scope: Scope) -> list[str]:
    """The lines of a scope's grammar. The wake word may stand before everything, as its detector misses it in noise."""
    wake = _either(config.wake)
    if scope == "woken":
        return [wake]
    if scope == "interrupt":
        return [f"[{wake}] {_either(line for lines in INTERRUPTS.values() for line in lines)}"]
    sentences = [line for line in config.commands if not _is_part(line)]
    return [wake, f"[{wake}] {_either(sentences)}", *(line for line in config.commands if _is_part(line))]


def grammars(config: SpeechConfig, household: Household, names: Sequence[str] = ()) -> dict[Scope, Grammar]:
    """One grammar for each scope; `names` of things that people have taught are objects in it.

    Raises:
        PatternError: a pattern that cannot be used.
    """
    words = vocabulary(household, (*config.objects, *names), config.places, config.colours)
    return {
        "command": Grammar(patterns(config, "command"), words),
        "woken": Grammar(patterns(config, "woken"), {}),
        "interrupt": Grammar(patterns(config, "interrupt"), {}),
    }


def _is_part(line: str) -> bool:
    name, equals, _ = line.partition("=")
    return bool(equals) and name.strip().isidentifier()


def _either(patterns: Iterable[str]) -> str:
    return "(" + " | ".join(patterns) + ")"
