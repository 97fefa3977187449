"""Spoken or typed text as words: lower case, without punctuation and politeness, cut into clauses. Pure."""

import re
import unicodedata
from collections.abc import Container

Words = tuple[str, ...]

DETERMINERS = frozenset({"the", "a", "an", "my", "your", "our", "that", "this", "some", "any", "those", "these"})
"""Words before a noun that say nothing about which object is meant beyond "one of these"."""

_LEAD = re.compile(
    r"^(?:(?:hey|hello|hi|ok|okay|jarvis|robot|tidybot|please|now|so|well|and|then|also|first(?=\s+\w+\s+\w)|finally|just|kindly|"
    r"(?:would|do) you mind|(?:can|could|would|will) you(?: please)?|"
    r"i(?: would|'d)? (?:like|want|need) you to|you (?:should|must|have to|need to)|let's|let us)\s+)+"
)
_TAIL = re.compile(
    r"(?:\s+(?:please|right now|now|quickly|at once|for me|for us|thanks|thank you|will you|would you|if you can|robot|"
    r"jarvis|again|and))+$"
)
_PART = re.compile(r"\s*[;.!?]+\s*(?:and\s+)?(?:then\s+)?|,?\s+(?:and\s+)?(?:then|after that|afterwards),?\s+")
_COMMA = re.compile(r"\s*,[\s,]*(?:and\s+)?")
_IS = re.compile(r"\b(what|where|who|there|that|it)'s\b")
_SAY = re.compile(r"^(?:say|announce)\s+(.+)$")


def normalise(text: str, keep: str = "") -> str:
    """Lower-case words separated by single spaces; accents and punctuation go, except the marks in `keep`."""
    folded = unicodedata.normalize("NFKD", text.lower().replace("’", "'").replace("_", " "))
    letters = "".join(c for c in folded if not unicodedata.combining(c))
    return " ".join(re.sub(rf"[^\w'{re.escape(keep)}]+", " ", letters).split())


def expand(text: str) -> str:
    """Normalised text with `what's` written as `what is`."""
    return _IS.sub(r"\1 is", text)


def clauses(text: str) -> list[str]:
    """The commands of a text that are said one after the other, each without its politeness.

    What follows "say" is kept whole.
    """
    found: list[str] = []
    rest = expand(normalise(text, ",;.!?"))
    while rest:
        saying = _SAY.match(_LEAD.sub("", rest))
        cut = None if saying else _PART.search(rest)
        head, rest = (rest, "") if cut is None else (rest[: cut.start()], rest[cut.end() :])
        if bare := without_politeness(head if saying else _commas_as_and(head)):
            found.append(bare)
    return found


def _commas_as_and(text: str) -> str:
    """A comma is an "and": `the mug, the can and the ball`; but `no, the red mug` is one answer."""
    return re.sub(r"^no and ", "no ", _COMMA.sub(" and ", text.strip(" ,")))


def without_politeness(text: str) -> str:
    """A clause without "could you please ..." and "... right now"; "" when nothing else is in it."""
    bare = _LEAD.sub("", text.strip(" ,;.!?") + " ").strip()
    while (shorter := _TAIL.sub("", bare)) != bare:
        bare = shorter
    return bare


def without_determiners(words: Words) -> Words:
    """Words without leading determiners."""
    while words and words[0] in DETERMINERS:
        words = words[1:]
    return words


def infinitive(word: str, verbs: Container[str]) -> str:
    """`bringing` as `bring`, as in "would you mind bringing me ..."; words that are no form of `verbs` stay."""
    stem = word.removesuffix("ing")
    if stem == word or word in verbs:
        return word
    return next((v for v in (stem, f"{stem}e", stem[:-1]) if v in verbs), word)


def enumeration(names: list[str], last: str = "and") -> str:
    """Names as spoken: `a, b and c`."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} {last} {names[-1]}" if names else ""
