"""One part of a sentence in the place of another: things, places, what "one" and "it" stand for. Pure."""

import re
from collections.abc import Callable, Iterable

from common.language.lexicon import COLOURS, COMMANDING
from common.language.normalise import DETERMINERS, Words, infinitive
from common.language.politeness import without_politeness

PREPOSITIONS = frozenset({
    "on", "in", "to", "into", "onto", "at", "from", "next", "near", "beside", "under", "behind", "with", "inside",
    "off",
})  # fmt: skip
"""Words that end a noun phrase."""
IsPlace = Callable[[Words], bool]
"""Do the words name a place?"""


def first_match(patterns: Iterable[re.Pattern[str]], text: str) -> re.Match[str] | None:
    """What the first of the patterns finds that fits a text from its beginning on."""
    return next(filter(None, (pattern.match(text) for pattern in patterns)), None)


def verb_first(text: str) -> bool:
    """Does a text begin with a verb of a command?"""
    words = text.split()
    return bool(words) and infinitive(words[0], COMMANDING) in COMMANDING


def replaced(said: str, meant: str, is_place: IsPlace = lambda _: False, explains: bool = False) -> str | None:
    """What was said with the part exchanged that `meant` stands for: a command, a place or a thing; None if none.

    `explains`: it may say what "one" is: `the blue one, the block I mean`.
    """
    meant = without_politeness(meant)
    words, new = said.strip(" ,").split(), meant.split()
    if not new:
        return None
    if verb_first(meant) and not (len(new) == 1 or new[1] in ("one", "ones")):
        return with_thing(meant, words)
    if new[0] in PREPOSITIONS:
        at = next((i for i in range(len(words) - 1, 0, -1) if words[i] in PREPOSITIONS), len(words))
        return " ".join((*words[:at], *new))
    spans = noun_phrases(words)
    if not spans:
        return None
    bare = tuple(w for w in new if w not in DETERMINERS)
    # "the hairbrush", after "go to the bed and bring me the hair brush", is no other place.
    things = [span for span in spans if not is_place(tuple(w for w in words[slice(*span)] if w not in DETERMINERS))]
    start, end = spans[-1] if is_place(bare) else (things or spans)[0]
    at = next((i for i, w in enumerate(new) if w in PREPOSITIONS), len(new))
    if len(spans) > 1 and is_place(tuple(w for w in new[at + 1 :] if w not in DETERMINERS)):
        end = len(words)  # both the thing and where it goes are said anew
    old = " ".join(words[start:end])
    names = explains and len(new) == 2 and end - start > 2 and words[end - 1].strip(",") == "one"
    whole = filled(old, meant) if names else filled(meant, old)
    return " ".join((*words[:start], *whole.split(), *words[end:]))


def with_thing(meant: str, said: list[str]) -> str:
    """`put it there` with the first thing of the words that were said before in place of its "it"."""
    spans = noun_phrases(said)
    thing = " ".join(said[slice(*spans[0])]).strip(",") if spans else ""
    return named(meant, thing) if thing else meant


def named(text: str, thing: str) -> str:
    """A request with the name of a thing in place of its first "it"."""
    return re.sub(r"(?<=\w )(?:it|them)\b", thing, text, count=1)


_AFTER_NOUN = PREPOSITIONS | {"and", "that", "which", "here", "there"}


def noun_phrases(words: list[str]) -> list[tuple[int, int]]:
    """(begin, end) of each phrase that begins with a determiner and ends before the next preposition or "and"."""
    found = []
    at = 0
    while at < len(words):
        if words[at].strip(",") in DETERMINERS:
            end = at + 1
            while end < len(words) and words[end].strip(",") not in _AFTER_NOUN:
                end += 1
            found.append((at, end))
            at = end
        at += 1
    return found


def filled(phrase: str, other: str) -> str:
    """`the blue one` with the noun of the other phrase, `the red mug`; `the blue` likewise."""
    if " " in phrase and phrase.split()[-1] in COLOURS:
        phrase = f"{phrase} one"
    head = other.split()
    if spans := noun_phrases(head):
        head = head[spans[0][0] : spans[0][1]]
    elif head:
        head = head[: next((i for i, w in enumerate(head) if w in PREPOSITIONS), len(head))]
    noun = head[-1] if head else ""
    if not noun or noun in ("one", "ones") or noun in DETERMINERS:
        return phrase
    return re.sub(r"\bone\b", noun, phrase, count=1)
