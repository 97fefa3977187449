"""Yes, no, or a correction: what an answer to "Did you say ...?" means. Pure."""

import re
from typing import Literal

from common.household import Household
from common.language.clauses import without_fillers
from common.language.contractions import expand
from common.language.contrasts import with_qualities
from common.language.discourse import commands
from common.language.exchange import PREPOSITIONS, replaced, with_thing
from common.language.lexicon import COMMANDING
from common.language.meaning import asks_for, is_question
from common.language.normalise import DETERMINERS, Words, infinitive, normalise
from common.language.politeness import without_politeness
from common.plan_rules import is_destination
from services.brain.language.senses import ANSWERS

Reply = Literal["yes", "no", "cancel", "correction"]
_CORRECTION = re.compile(
    r"^(?:neither(?!.* nor\b)|none of (?:them|those)|"
    r"not at all|not really|no way|no|nope|yes|yeah|yep|wrong|not that|i said|i meant|i mean|i want(?:ed)?|i "
    r"need|i would like|actually|"
    r"rather|almost|nearly|close|not quite|oops|whoops|ugh|sorry|wait|but)\s+"
)


_MISHEARD = re.compile(r"^no,? (?:not )?(?:the )?\w+(?: \w+)? (?=i (?:said|meant)\s)")
_CONTRAST = re.compile(r"^(?P<right>(?!not\b).+?),? (?:and |but )?not (?P<wrong>.+)$")
_SAID = re.compile(r"\s+i (?:said|meant)$")


LONGEST_ANSWER = 9
"""Most words of one answer of several (chosen: the longest wordings of yes and no have about as many)."""
LONGEST_NAME = 3
"""Most words of an answer that is a name alone and no sentence of its own (chosen)."""


SURE = {"yes": 0.85, "no": 0.6}
"""Least probability of an answer that no wording says (chosen on lists left out: a false yes costs more)."""


def reply(text: str, asked: str = "") -> tuple[Reply, str]:
    """The kind of answer, and for a correction the words without its "no, I said".

    By its wording, or as it is most likely meant as an answer to whether the command `asked` was meant.
    """
    kind, rest = by_wording(text)
    if kind == "correction" and "?" not in text:
        sense, p = ANSWERS.likeliest(text, asked, kind)
        if p >= SURE.get(sense, 1.0):
            return sense, ""  # type: ignore[return-value]
    return kind, rest


def by_wording(text: str) -> tuple[Reply, str]:
    """The same by the wordings alone."""
    rest = without_fillers(expand(normalise(text)))
    if (kind := _kind(rest)) is not None:
        return kind, ""
    rest = _MISHEARD.sub("", rest)
    while (shorter := _CORRECTION.sub("", rest)) != rest:
        rest = shorter
    return "correction", without_politeness(_SAID.sub("", rest)) or rest


def _kind(text: str) -> Literal["yes", "no", "cancel"] | None:
    """What a text without correction says, once or several times: `that is the one, yes, go ahead`."""
    for kind in ("yes", "no", "cancel"):
        if _says_only(tuple(text.split()), kind):
            return kind
    return None


def _says_only(words: Words, kind: Literal["yes", "no", "cancel"]) -> bool:
    """Are the words nothing but wordings of one answer, one after the other?"""
    reached = {0}
    for end in range(1, len(words) + 1):
        starts = [at for at in reached if end - at <= LONGEST_ANSWER]
        if any(asks_for(" ".join(words[at:end]), kind) for at in starts):
            reached.add(end)
    return bool(words) and len(words) in reached


def corrected(command: str, correction: str, household: Household) -> str:
    """The command with the thing or place exchanged that the correction names; a whole new command replaces it.

    "" after a correction without a word.
    """

    def is_place(words: Words) -> bool:
        return is_destination(" ".join(words), household)

    if contrast := _CONTRAST.match(correction):
        correction = with_qualities(command, contrast["wrong"], contrast["right"])
    if not correction:
        return ""
    if correction.split()[:1] in (["not"], ["but"]):
        correction = next(iter(commands(correction)), correction)
    thing = correction if correction.split()[0] in DETERMINERS else f"the {correction}"
    if set(correction.split()) <= household.words.colours.keys():
        thing = f"the {correction} one"
    if _is_command(correction):
        return with_thing(correction, normalise(command).split())
    exchanged = replaced(normalise(command), correction if correction.split()[0] in PREPOSITIONS else thing, is_place)
    return exchanged or correction


def answered(suggestion: str, answer: str, household: Household) -> str:
    """The command that an answer to a suggested one comes to: with another thing or place, or a command of its own.

    A name alone, `spatula`, is of what the suggestion is to be done with.
    """
    words = answer.split()
    names = len(words) <= LONGEST_NAME and not _is_command(answer) and not is_question(answer)
    begins = words[:1] and words[0] in DETERMINERS | PREPOSITIONS
    return corrected(suggestion, answer, household) if words and (begins or names) else answer


def _is_command(text: str) -> bool:
    words = without_politeness(text).split()
    return bool(words) and len(words) > 1 and infinitive(words[0], COMMANDING) in COMMANDING
