"""What a sentence shows of a candidate command, as numbers of hashed features. Pure.

Things and places are replaced by what they are in the candidate, so that nothing depends on their names; then single
words, their stems, pairs, pairs with a word between and triples count, the verb's class and the preposition before each
thing and place, and how many of the named things and places the candidate leaves aside.
"""

from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

from common.language.log_linear import UNKNOWN, hashed
from common.language.mood import forbids, is_asked, is_told
from common.language.normalise import Words
from common.language.politeness import without_politeness
from common.language.verb_classes import classes
from services.planner.grammar.chunks import MARK, POINTING, Chunk
from services.planner.semantic.forms import Candidate

BEGIN, END = "<begin>", "<end>"
_PREPOSITIONS = frozenset({
    "to", "into", "onto", "towards", "in", "on", "at", "inside", "from", "off", "of", "by", "near", "beside", "next",
    "with", "under", "over",
})  # fmt: skip
_STEM = 4
"""First letters that the forms of a word share (chosen on lists left out: 312 of 392 ranked first, 305 without)."""
_COUNTED = 3
"""Things and places left aside, and words not known, are counted up to this many (chosen)."""
_QUARTERS, _LONG = 4, 6
"""Steps in which lengths are told apart: a length by four words up to 24, a share by quarters (chosen)."""


class Said(NamedTuple):
    """`parts`: the words, with the number of a thing or place in `found` for its words, each with where it begins.

    `signs`: of the whole.
    """

    parts: list[tuple[int, str | int]]
    found: Sequence[Chunk]
    signs: list[str]


def abstracted(words: Words, found: Sequence[Chunk], known: frozenset[str], holds: bool = False) -> Said:
    """A sentence in words and marks without the names in it; a word that is not `known` stands for all of them.

    `holds`: it is said to a robot that has something in its hand.
    """
    begins = {chunk.begin: number for number, chunk in enumerate(found)}
    parts: list[tuple[int, str | int]] = []
    at = 0
    while at < len(words):
        number = begins.get(at)
        parts.append((at, (words[at] if words[at] in known else UNKNOWN) if number is None else number))
        at = at + 1 if number is None else found[number].end
    inside = {f"in {w}" for chunk in found if chunk.new for w in words[chunk.begin : chunk.end] if w in known}
    return Said(parts, found, [*_signs(words, found), *sorted(inside), *(["holds"] if holds else [])])


def _signs(words: Words, found: Sequence[Chunk]) -> list[str]:
    """What the hand-written rules of mood and politeness see in the whole sentence."""
    bare = tuple(word for word in words if word != MARK)
    inside = {at for chunk in found for at in range(chunk.begin, chunk.end)}
    verbs_only = tuple("_" if at in inside else word for at, word in enumerate(words) if word != MARK)
    moods = (forbids(" ".join(bare)), is_told(verbs_only), bool(bare) and is_asked(bare))
    rest = without_politeness(" ".join(words).replace(f" {MARK}", MARK)).replace(MARK, "").split()
    seen = [name for name, is_so in zip(("forbids", "told", "asked"), moods, strict=True) if is_so]
    share = _QUARTERS * len(rest) // max(len(words), 1)
    return [*(seen or ["plain"]), f"first {rest[:1]}", f"first two {rest[:2]}", f"asks {share}"]


def features(said: Said, candidate: Candidate) -> list[int]:
    """Numbers of the features of one candidate."""
    return hashed(_names(said, candidate))


def _names(said: Said, candidate: Candidate) -> Iterator[str]:
    form, kind = candidate.form, candidate.kind
    marks = [BEGIN, *_marks(said, candidate), END]
    counts = {name: min(marks.count(name), _COUNTED) for name in ("#thing", "#thing new", "#spot", "#time", UNKNOWN)}
    for of in (form, kind):
        for name, count in counts.items():
            yield f"{of} {name} {count}"
        for name in (*said.signs, *sorted(set(marks))):
            yield f"{of} 1 {name}"
        for first, second in pairwise(marks):
            yield f"{of} 2 {first} {second}"
    for triple in zip(marks, marks[1:], marks[2:], strict=False):
        yield f"{form} 3 {' '.join(triple)}"
        yield f"{form} skip {triple[0]} {triple[2]}"
    for stem in sorted({mark[:_STEM] for mark in marks if len(mark) >= _STEM and mark[0].isalpha()}):
        yield f"{form} stem {stem}"
    yield form
    yield f"{form} length {min(len(marks) // _QUARTERS, _LONG)}"
    yield f"{kind} begins {' '.join(marks[:4])}"
    yield f"{form} order {' '.join(m for m in marks if m[0] == '#')}"
    yield from _governed(form, marks)


def _marks(said: Said, candidate: Candidate) -> Iterator[str]:
    """The words, those that the candidate quotes and each thing and place as one."""
    begin, end = candidate.span or (0, 0)
    for at, part in said.parts:
        if at == begin < end:
            yield "#quoted"
        if begin <= at < end:
            continue
        yield part if isinstance(part, str) else _mark(said.found[part], candidate.roles.get(part, ""))


def _governed(form: str, marks: Sequence[str]) -> Iterator[str]:
    """By which verb and preposition each thing and place is reached."""
    verb = preposition = ""
    verbs: set[str] = set()
    for mark in marks:
        if mark[0] == "#":
            yield f"{form} verb {verb} {mark}"
            yield f"{form} preposition {preposition} {mark}"
            yield f"{form} both {verb} {preposition} {mark}"
            preposition = ""
        elif mark in _PREPOSITIONS:
            preposition = mark
        elif of := _classes(mark):
            verb = of
            verbs.add(of)
    for of in verbs:
        yield f"{form} class {of}"
    yield f"{form} classes {' '.join(sorted(verbs))}"


def _mark(chunk: Chunk, role: str) -> str:
    return f"#{role or chunk.kind}{' it' if chunk.text in POINTING else ' new' if chunk.new else ''}"


@lru_cache(maxsize=10_000)
def _classes(word: str) -> str:
    return "/".join(sorted(classes(word)))
