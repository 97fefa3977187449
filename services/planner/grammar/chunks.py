"""The things and places that any words name, whether or not the words are understood. Pure."""

from typing import Literal, NamedTuple

from common.language.normalise import DETERMINERS, Words
from common.language.quantities import duration
from services.planner.grammar.phrases import Phrase, read
from services.planner.grammar.senses import LIVING, LONGEST_NAME, NO_NOUN, is_alive
from services.planner.grammar.vocabulary import Vocabulary

MOST_WORDS = 6
"""Words of the longest phrase for a thing or a place (chosen)."""
POINTING = ("it", "them", "those")
"""Pronouns that stand for things."""
_BEFORE_NAMES = frozenset({"the", "my", "our", "a", "an", "some", "your"})
"""Determiners before names of things that nobody has listed; `that` and `his` mostly go with verbs and people."""
MARK = ","
"""The word that stands for every mark."""
_BEHIND_BARE = frozenset(
    {MARK, "please", "instead", "now", "next", "too", "also", "then", "after", "afterwards", "here"}
)
"""What may follow a name that is all there is of a request."""
_NEVER_FIRST = NO_NOUN - DETERMINERS - {"all", "both", "every", "each"}
"""Words that no phrase for a thing or a place begins with."""


class Chunk(NamedTuple):
    """Words from `begin` to before `end`, which name a thing, a place or a length of time; `text` has its article.

    The text of a time is in seconds.
    """

    kind: Literal["thing", "spot", "time"]
    text: str
    begin: int
    end: int


def chunks(
    words: Words, vocabulary: Vocabulary, pronouns: bool = False, unlisted: bool = False, alone: bool = False
) -> list[Chunk]:
    """Phrases for known things and for places among the words, the longest at each spot.

    On request also pronouns, and names of `unlisted` things behind a determiner; and what only stands `alone` for a
    request: lengths of time, and names without a determiner that a whole part of the sentence consists of.
    """
    found: list[Chunk] = []
    at = 0
    while at < len(words):
        chunk = (_time(words, at) if alone else None) or _longest(words, at, vocabulary)
        if chunk is None and unlisted:
            chunk = _unlisted(words, at, vocabulary)
        if chunk is None and alone:
            chunk = _bare(words, at, vocabulary)
        if chunk is None and pronouns and words[at] in POINTING:
            chunk = Chunk("thing", words[at], at, at + 1)
        found += [chunk] if chunk else []
        at = chunk.end if chunk else at + 1
    return found


def _longest(words: Words, at: int, vocabulary: Vocabulary) -> Chunk | None:
    if words[at] in _NEVER_FIRST:
        return None
    for end in range(min(len(words), at + MOST_WORDS), at, -1):
        span = words[at:end]
        bare = tuple(w for w in span if w not in DETERMINERS)
        if not bare or span[-1] in DETERMINERS:
            continue
        if (places := vocabulary.spot(bare)) and not places[0].home:
            return Chunk("spot", f"the {' '.join(bare)}", at, end)
        if isinstance(phrase := read(span, vocabulary), Phrase) and _plain(phrase):
            text = " ".join(span)
            return Chunk("thing", text if span[0] in DETERMINERS or phrase.count != 1 else f"the {text}", at, end)
    return None


def _unlisted(words: Words, at: int, vocabulary: Vocabulary) -> Chunk | None:
    """The longest name behind a determiner that may be of a thing: `my stapler` in `my stapler is on the desk`.

    Behind another word one in -s or -ed is rather a verb: `my stapler jams`.
    """
    if words[at] not in _BEFORE_NAMES:
        return None
    for end in range(min(len(words), at + 1 + LONGEST_NAME), at + 1, -1):
        name = words[at + 1 : end]
        is_told = len(name) > 1 and any(word.endswith(("s", "ed")) for word in name[1:])
        if not is_told and _lifeless(name) and vocabulary.unlisted(name) is not None:
            return Chunk("thing", " ".join(words[at:end]), at, end)
    return None


def _time(words: Words, at: int) -> Chunk | None:
    """The longest length of time that begins there: `a minute and a half`."""
    for end in range(min(len(words), at + MOST_WORDS), at + 1, -1):
        if (seconds := duration(words[at:end])) is not None:
            return Chunk("time", f"{seconds:g} seconds", at, end)
    return None


def _bare(words: Words, at: int, vocabulary: Vocabulary) -> Chunk | None:
    """A name that nobody has listed and no determiner leads, where nothing else is said: `tissues, please`."""
    if at and words[at - 1] != MARK:
        return None
    stop = words.index(MARK, at) if MARK in words[at:] else len(words)
    end = next((i for i in range(at, stop) if words[i] in _BEHIND_BARE), stop)
    name = words[at:end]
    if not _BEHIND_BARE.issuperset(words[end:stop]) or not _lifeless(name):
        return None
    lasts = any(_time(words, i) for i in range(at, end))
    known = not lasts and 0 < len(name) <= LONGEST_NAME and vocabulary.unlisted(name, determined=False) is not None
    return Chunk("thing", f"the {' '.join(name)}", at, end) if known else None


def _lifeless(name: Words) -> bool:
    """Does it speak of nobody? A toy rabbit is nobody."""
    return LIVING.isdisjoint(name) or (name[-1] in LIVING and not is_alive(name))


def _plain(phrase: Phrase) -> bool:
    """Does it name a kind or a thing, without what that stands next to? Any word could be a thing nobody has listed."""
    if phrase.sense.new and phrase.text.split()[0] not in DETERMINERS:
        return False  # "he is asleep on me"
    of_ones = phrase.sense.every and phrase.noun in ("one", "ones") and bool(phrase.colours or phrase.which)
    return (not phrase.sense.every or of_ones) and not phrase.relation


def named(words: Words, vocabulary: Vocabulary, unlisted: bool = False) -> tuple[list[str], list[str]]:
    """The phrases for known things, or also `unlisted` ones, and those for places."""
    found = chunks(words, vocabulary, unlisted=unlisted)
    return [c.text for c in found if c.kind == "thing"], [c.text for c in found if c.kind == "spot"]
