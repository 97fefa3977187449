"""Yes, no, or a correction: what an answer to "Did you say ...?" means. Pure."""

import re
from typing import Literal

from common.language.clauses import without_fillers
from common.language.contractions import expand
from common.language.contrasts import contrasted
from common.language.meaning import asks_for
from common.language.normalise import Words, normalise
from common.language.politeness import without_politeness
from services.brain.language.senses import ANSWERS

Reply = Literal["yes", "no", "cancel", "correction"]
_CORRECTION = re.compile(
    r"^(?:neither(?!.* nor\b)|none of (?:them|those)|"
    r"not at all|not really|no way|no|nope|yes|yeah|yep|wrong|not that|i said|i meant|i mean|i want(?:ed)?|i "
    r"need|i would like|actually|"
    r"rather|almost|nearly|close|not quite|oops|whoops|ugh|sorry|wait|but|(?:pardon|excuse) me|"
    r"i (?:asked for|was (?:on|talking|speaking) about|was after)|"
    r"i (?:believe|think)(?= i (?:said|meant)\b))[ ,;.!?]+"
)


_BAFFLED = re.compile(
    r"^\s*(?:(?:what|huh|eh|hm+|sorry|pardon)\s*[?!]+|(?:good|great|dear) (?:grief|lord|heavens|god)[,!]+)\s*(?=\w)",
    re.IGNORECASE,
)
"""A cry before the answer proper: `what? no`."""
_MISHEARD = re.compile(r"^no,? (?:not )?(?:the )?\w+(?: \w+)? (?=i (?:said|meant)\s)")
_MORE = re.compile(r"\b(?:and|as well|too|also|then)\b")
"""Words of an answer that asks for more than was asked about."""
_REJECTED = re.compile(
    r"^(?:not|neither|(?:i |we )?(?:did not|never) (?:say|said|mean|meant|ask for|want)(?: a word about)?) "
    r"(?P<wrong>.+)$"
)
"""A part of an answer that says only what was not meant."""
_SAID = re.compile(r"\s+(?:(?:is|was) what )?i (?:said|meant|asked for)$")
_OBJECTION = re.compile(r"^no,? (?:i|we|he|she|it|they|the \w+) (?:\w+ )??(?:still|already|never)\b")
"""A no, and why nothing is to be done: `no, the apple is still good`."""


LONGEST_ANSWER = 9
"""Most words of one answer of several (chosen: the longest wordings of yes and no have about as many)."""
SURE = {"yes": 0.85, "no": 0.6}
"""Least probability of an answer that no wording says (chosen on lists left out: a false yes costs more)."""


def reply(text: str, asked: str = "") -> tuple[Reply, str]:
    """The kind of answer, and for a correction the words without its "no, I said".

    By its wording, or as it is most likely meant as an answer to whether the command `asked` was meant.
    """
    text = _BAFFLED.sub("", text)
    kind, rest = by_wording(text)
    parts = pieces(text) if asked else []
    if parts and all(rejected(part) or _kind(part) == "no" for part in parts):
        return "no", ""
    if kind == "correction" and "?" not in text:
        sense, p = ANSWERS.likeliest(text, asked, kind)
        if p >= SURE.get(sense, 1.0) and not (sense == "yes" and _MORE.search(text)):
            return sense, ""  # type: ignore[return-value]
    return kind, rest


def by_wording(text: str) -> tuple[Reply, str]:
    """The same by the wordings alone."""
    if (kind := _kind(bare := without_fillers(expand(normalise(text))))) is not None:
        return kind, ""
    if _OBJECTION.match(bare):
        return "no", ""
    rest = without_lead(text)
    return "correction", without_politeness(_SAID.sub("", rest)) or rest


def without_lead(text: str) -> str:
    """An answer with its marks, without what stands before what is meant: `no, I said`."""
    rest = _MISHEARD.sub("", without_fillers(expand(normalise(text, ",;.!?"))))
    while (shorter := _CORRECTION.sub("", rest)) != rest:
        rest = shorter
    return rest.strip(" ,;.!?")


def pieces(answer: str) -> list[str]:
    """The parts of an answer between its marks, which are gone."""
    parts = re.split(r"[,;.!?]+|\bbut\b", normalise(answer, ",;.!?"))
    return [bare for part in parts if (bare := _CORRECTION.sub("", part.strip()))]


def rejected(part: str) -> str:
    """What a part of an answer says was not meant, where it says no more than that; "" of other parts."""
    found = _REJECTED.match(part) if contrasted(part) == part else None
    return found["wrong"] if found else ""


def is_reply(text: str) -> bool:
    """Is it yes or no alone?"""
    return _kind(text) in ("yes", "no")


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
