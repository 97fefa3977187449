"""A text cut into clauses, without the sounds of hesitation and the politeness around each. Pure."""

import re

from common.language.contractions import expand
from common.language.lexicon import A_VERB
from common.language.normalise import normalise
from common.language.politeness import without_lead, without_politeness
from common.language.speeches import LONG_SPEECH, TO_BE_SAID

_FILLER = re.compile(
    r",\s*(?:duck|love|pet|hen|dear|petal|poppet|mate|pal)\s*(?=, (?:the|a|my|i|we)\b)|"
    r"\s*\b(?:u+m+|(?<!^uh )u+h+(?!,? huh\b| uh$)|e+r+m*|h+m+|a+h+|o+h+)\b,?|,\s*(?:like|you know)\s*,"
    r"|\b(?:u+r*gh+|e+w+|yu+ck|yikes|phew|blimey|crikey|gosh)\b[,!]*"
    r"|\b(?:let (?:me|us) (?:think|see)|i was thinking|what was it(?: called)?|how do you (?:say|call it)|"
    r"what do you call (?:it|them|that|those))"
    r"(?:,? (?:again|now|then|so|well|oh|ah|yes|yeah|ok|okay|right|no)\b)+,?|\blet me think,? (?=the|a|my)"
    rf"|\b(?:you know|like),?(?= {A_VERB}\b)"
    r"|\b(?:(?:the|my) )?(?:whatsit|thingy|thingie|wotsit|whatchamacallit|thingamajig|doodah),?(?= (?:the|my)\b)"
)
"""Sounds of somebody who thinks while speaking."""
_STUTTER = re.compile(
    r"\b(?!(?:no|uh|stop|cancel|abort|very|really|hurry|quick|again|wait|chop|tidy|clean|clear)\b|do,? do not\b)"
    r"(\w+)(?:,? \1\b)+"
    r"|\b((?!no\b|and\b|then\b)[a-z]{2,}(?: (?!and\b|then\b|or\b)\w+){1,3})(?:,? \2\b)+"
)
"""Words that somebody who hesitates says twice; but `no no`, `stop stop`, `if it is not tidy tidy it`."""
_PART = re.compile(
    r"\s*[;.!?]+\s*(?:and\s+)?(?:then\s+)?"
    r"|,?\s+(?:(?:and|but)\s+)?(?:(?:only|just)\s+)?(?:then|after (?:that|which)|afterwards|thereafter|"
    r"(?:once|when|as soon as) (?:that|this|it) (?:is|has been) done|when done),?\s+|,\s*(?:and "
    r")?(?:finally|lastly|last|next),?\s+(?!to\b)|,\s*(?:and )?(?=(?:say|announce)\b)"
)
_BEHIND_SPEECH = re.compile(
    r",\s*(?:and\s+)?(?=(?:wait (?:for )?(?:\w+ ){1,3}(?:second|minute|hour)s?|come (?:right |straight )?back)\b)"
    rf"|,\s*and\s+(?={A_VERB}\b)|,?\s+(?:and\s+)?then\s+(?={A_VERB}\b)"
    rf"|,?\s+and\s+(?:then\s+)?(?={A_VERB} (?:right |straight )?back\b)"
    r"|,\s*(?=(?:he|she|they) (?:will not|will never|can not|do not|does not|is not|are not|never) \w+)"
)
"""Between what is to be said and the next command."""
_COMMA = re.compile(r"\s*,[\s,]*(?:and\s+)?")


def without_fillers(text: str) -> str:
    """Normalised text without `um`, `er` and words said twice; what is to be said stays as it is."""
    if LONG_SPEECH.match(without_lead(text)):
        return text
    said = TO_BE_SAID.search(text)
    head, tail = (text[: said.start()], text[said.start() :]) if said else (text, "")
    return f"{_STUTTER.sub(lambda twice: twice[1] or twice[2], _FILLER.sub('', head))}{tail}".strip(" ,")


def clauses(text: str) -> list[str]:
    """The clauses of a text one after the other, each without its politeness; what follows "say" is kept whole."""
    return cut_clauses(without_fillers(expand(normalise(text, ",;.!?"))))


def cut_clauses(rest: str) -> list[str]:
    """The same of normalised text with its marks."""
    found: list[str] = []
    while rest:
        saying = LONG_SPEECH.match(without_lead(rest))
        cut = (_BEHIND_SPEECH if saying else _PART).search(rest)
        head, rest = (rest, "") if cut is None else (rest[: cut.start()], rest[cut.end() :])
        if bare := without_politeness(head if saying else _commas_as_and(without_lead(head))):
            found.append(bare)
    return found


def _commas_as_and(text: str) -> str:
    """A comma is an "and": `the mug, the can and the ball`; but `no, the red mug` is one answer, and speech is kept."""
    said = TO_BE_SAID.search(text)
    head, speech = (text[: said.end()], text[said.end() :]) if said else (text, "")
    return re.sub(r"^no and ", "no ", _COMMA.sub(" and ", head.lstrip(" ,")) + speech).rstrip(" ,")
