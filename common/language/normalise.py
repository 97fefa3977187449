"""Spoken or typed text as words: lower case, without punctuation and politeness, cut into clauses. Pure."""

import re
import unicodedata
from collections.abc import Container

Words = tuple[str, ...]

DETERMINERS = frozenset({"the", "a", "an", "my", "your", "our", "that", "this", "some", "any", "those", "these"})
"""Words before a noun that say nothing about which object is meant beyond "one of these"."""

_FILLER = re.compile(r"\s*\b(?:u+m+|u+h+|e+r+m*|h+m+|a+h+|o+h+)\b,?|,\s*(?:like|you know|i mean)\s*,")
"""Sounds of somebody who thinks while speaking."""
_OPENINGS = (
    # Whom it is said to, and what carries no meaning.
    "hey|hello|hi|ok|okay|jarvis|robot|tidybot|please|now|so|well|and|then|also|finally|just|kindly|quickly|maybe",
    r"perhaps|actually|whoa|woah|oi|hold on|hang on|first(?=\s+\w+\s+\w)|wait(?=\s+(?:stop|cancel|no)\b)",
    # What makes a question or a wish of an order.
    r"(?:would|do) you mind|mind(?=\s+\w+ing\b)|would you be (?:so|kind|good|enough|as|to|\s)+",
    "(?:can|could|would|will) (?:you|someone|somebody)|you (?:should|must|have to|need to|could|can)|let's|let us",
    "(?:do you think|i was wondering if|i wonder if|i was hoping|(?:is there )?any chance) you (?:could|can|would)",
    r"(?:would it be|is it|if it is|if) possible(?: for you)?(?: to)?|be (?:a|an|so) \w+ (?:and|as to)",
    r"i(?: would|'d)? (?:like|want|need|love) you to|(?:it would|it'd) be \w+ if you (?:could|would)",
    "(?:i'd|i would) (?:appreciate it|be (?:grateful|happy|glad)) if you (?:could|would)",
    "i (?:think|guess|suppose)|do me a favou?r(?: and)?",
    # Conditions that are none.
    r"if you (?:don't|do not|would not|wouldn't) mind|if you (?:can|could|would)",
    r"when you (?:can|(?:have|get) (?:a )?\w+)",
)
"""Politeness before a command: words that may be left out without changing what is asked for."""
_ENDINGS = (
    "please|right now|now|quickly|at once|for me|for us|thanks|thank you|robot|jarvis|again|then|anyway|and",
    "(?:will|would|could|can) you|if you can|if possible|if you (?:don't|do not|wouldn't) mind",
    r"when you (?:can|(?:have|get) (?:a )?\w+)|(?:for )?(?:a|one) (?:second|sec|moment)",
)
"""Politeness after a command."""
_LEAD = re.compile(rf"^(?:(?:{'|'.join(_OPENINGS)})\s+)+")
_TAIL = re.compile(rf"(?:\s+(?:{'|'.join(_ENDINGS)}))+$")
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


def without_fillers(text: str) -> str:
    """Normalised text without `um`, `er` and the like; what is to be said stays as it is."""
    return text if _SAY.match(_LEAD.sub("", text)) else _FILLER.sub("", text).strip(" ,")


def clauses(text: str) -> list[str]:
    """The commands of a text that are said one after the other, each without its politeness.

    What follows "say" is kept whole.
    """
    found: list[str] = []
    rest = without_fillers(expand(normalise(text, ",;.!?")))
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
