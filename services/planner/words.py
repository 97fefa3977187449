"""A spoken or typed command as words: lower case, without politeness, cut into parts. Pure."""

import re
from collections.abc import Container

Words = tuple[str, ...]

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


def normal(text: str) -> str:
    """Lower case, single spaces, only words and the marks that separate parts of a sentence."""
    clean = re.sub(r"[^a-z0-9',;.!?]+", " ", text.lower().replace("’", "'").replace("_", " "))
    return " ".join(_IS.sub(r"\1 is", clean).split())


def parts(text: str) -> list[str]:
    """The commands of a sentence that are said one after the other, each without its politeness.

    What follows "say" is kept whole.
    """
    found: list[str] = []
    whole = normal(text)
    while whole:
        saying = _SAY.match(_LEAD.sub("", whole))
        cut = None if saying else _PART.search(whole)
        head, whole = (whole, "") if cut is None else (whole[: cut.start()], whole[cut.end() :])
        if bare := polite(head if saying else _listed(head)):
            found.append(bare)
    return found


def _listed(text: str) -> str:
    """A comma is an "and": `the mug, the can and the ball`; but `no, the red mug` is one answer."""
    return re.sub(r"^no and ", "no ", _COMMA.sub(" and ", text.strip(" ,")))


def polite(text: str) -> str:
    """A part without "could you please ..." and "... right now"."""
    bare = _LEAD.sub("", text.strip(" ,;.!?") + " ").strip()
    while (shorter := _TAIL.sub("", bare)) != bare:
        bare = shorter
    return bare


def plain(word: str, verbs: Container[str]) -> str:
    """`bringing` -> `bring`, as in "would you mind bringing me ..."; other words stay."""
    stem = word.removesuffix("ing")
    if stem == word or word in verbs:
        return word
    return next((v for v in (stem, f"{stem}e", stem[:-1]) if v in verbs), word)


def listed(names: list[str], last: str = "and") -> str:
    """`a, b and c`."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} {last} {names[-1]}" if names else ""
