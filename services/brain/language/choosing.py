"""Which of several things an answer to "Do you mean the ... or the ...?" chooses. Pure."""

import math
import re
from collections.abc import Sequence

from common.household import Household
from common.language.contractions import expand
from common.language.mood import forbids
from common.language.normalise import normalise, without_determiners
from common.language.noun_phrase import WHICH, Which, related
from common.language.simplify import simplified
from common.messages import WorldObject
from services.brain.language.dialogue import reply

_NO_NAME = frozenset({
    "one", "whichever", "of", "them", "those", "these", "will", "with", "go", "the", "please", "that", "this", "mean",
    "i", "want", "is", "take", "bring", "me", "let", "have", "get", "give", "it", "choose", "would", "like", "you",
    "said", "mentioned", "think",
})  # fmt: skip
_CARDINALS = ("one", "two", "three", "four")
_ANY_WILL_DO = re.compile(
    r"^(?:(?:oh|well|um|er|just|really),? )*(?:(?:any|either)(?: (?:one|of (?:them|those|these|the two)))?"
    r"(?: (?:will do|is fine|would do|please|really|works|is good))?$|any,|(?:whichever|whatever)\b(?! (?:one "
    r")?(?:is|was|stands|lies|has|comes)\b)"
    r"|you (?:choose|pick|decide)|surprise me|(?:it is )?up to you"
    r"|(?:it is |they are )?all the same|your choice|no preference)"
    r"|\b(?:do not (?:mind|care)(?: which| either way)?$|(?:does not|no) matter|makes no (?:odds|difference)"
    r"|will do either)"
)
"""Who does not mind which."""
_SAID_BEFORE = re.compile(r"^.*\bi (?:meant|mean|said|wanted|want)\b(?! that\b)(?=.*\w)")
"""What was said before the words that are meant: `did i say mug? i meant ...`."""
_UNFIT = re.compile(r"\b(?:but|dirty|broken|empty|apart|rather than|instead|other|difference|nor)\b")
"""Words that name an option in order to pass it over."""
BESIDE = 0.6
"""Farthest an object is "next to" another [m] (chosen: both within one reach)."""


def chosen(
    answer: str, options: Sequence[str], known: Sequence[WorldObject] = (), household: Household | None = None
) -> str | None:
    """The one option that the answer singles out, as a phrase of its own or by what only that one has in it.

    Who does not mind gets the first; another colour of the same kind names one that was not among the options.
    """
    whole = expand(normalise(answer))
    if found := _singled_out(answer, options, known, household):
        return found
    said = _SAID_BEFORE.sub("", whole)
    fit = not (forbids(said) or _UNFIT.search(said))
    if fit and (found := _told_apart(said, options, known, household)):
        return found
    if _ANY_WILL_DO.search(whole) and options:
        return options[0]
    return _another(said.split(), options, known) if fit else None


def _told_apart(
    said: str, options: Sequence[str], known: Sequence[WorldObject], household: Household | None
) -> str | None:
    """The only option with a word in the sentence that the others have not: of its name, its print, use or place."""
    own = {option: _marks(option, known, household) for option in options}
    words = {form for word in said.split() for form in (word, word.removesuffix("s"))}
    for kind in range(len(next(iter(own.values()), ()))):
        marks = {option: found[kind] for option, found in own.items()}
        hit = [
            o
            for o in options
            if any(
                words.issuperset(mark.split())
                for mark in marks[o]
                if all(mark not in marks[p] for p in options if p != o)
            )
        ]
        if hit:
            return hit[0] if len(hit) == 1 else None
    return None


def _marks(option: str, known: Sequence[WorldObject], household: Household | None) -> tuple[set[str], ...]:
    """What an option may be told by: the words of its name and print, what it is for, and the names of where it is."""
    items = [o for o in known if o.label == option]
    texts = [option, *(text for o in items for text in (o.text, *o.names))]
    names = {form for text in texts for word in normalise(text).split() for form in (word, word.removesuffix("s"))}
    if household is None:
        return (names - _NO_NAME,)
    groups = household.words.groups
    uses = {group.split()[-1] for group, kinds in groups.items() if any(o.kind in kinds for o in items)}
    own = household.receptacle(option)
    parts = [own] if own else [r for o in items if (r := household.receptacle(o.on or ""))]
    names |= {word for alias in (own.aliases if own else ()) for word in alias.split()}
    rooms = [room for p in parts if (room := household.room_at(*p.center[:2]))]
    at = {name for room in rooms for name in (room.name, *room.aliases)}
    at |= {name for part in parts if part is not own for name in (part.name, *part.aliases)}
    return names - _NO_NAME, uses, at


def _another(words: Sequence[str], options: Sequence[str], known: Sequence[WorldObject]) -> str | None:
    """`the white one` between the red mug and the blue one, where a white mug is known."""
    kinds = {option.split()[-1] for option in options}
    labels = {o.label for o in known} if len(kinds) == 1 else set()
    found = labels & {f"{word} {kind}" for word in words for kind in kinds}
    return found.pop() if len(found) == 1 else None


def _singled_out(
    answer: str, options: Sequence[str], known: Sequence[WorldObject], household: Household | None
) -> str | None:
    """The one option that the answer's words single out, by name, number, side of "not", or where it stands."""
    bare = " ".join(simplified(tuple(reply(answer)[1].split())))
    words = set(without_determiners(tuple(bare.split()))) - _NO_NAME
    for n, ordinal in enumerate(("first", "second", "third", "fourth")):
        if words in (
            {ordinal},
            {"number", _CARDINALS[n]},
            {"option", _CARDINALS[n]},
            {"number", str(n + 1)},
        ) and n < len(options):
            return options[n]
    if words in ({"former"}, {"latter"}) and len(options) == 2:
        return options[words == {"latter"}]
    if "last" in words and words <= {"last"}:
        return options[-1]
    if words and (words <= WHICH.keys()) and (extreme := _extreme(WHICH[next(iter(words))], options, known)):
        return extreme
    bare = re.sub(r"\bneither (.+) nor ", r"not \1 not ", bare)
    if "not" in bare.split():
        parts = (set(part.split()) - _NO_NAME - {"and", "or", "nor"} for part in bare.split("not")[1:])
        excluded = [part for part in parts if part]
        left = [o for o in options if not any(part <= set(o.split()) for part in excluded)]
        return left[0] if len(left) == 1 and excluded else None
    printed = {o.label: {w for text in (o.text, *o.names) for w in normalise(text).split()} for o in known}
    matching = [o for o in options if words and words <= set(o.split()) | printed.get(o, set())]
    if not matching and household is not None:
        matching = [o for o in options if _stands_where(o, bare, known, household)]
    return matching[0] if len(matching) == 1 else None


def _extreme(which: Which, options: Sequence[str], known: Sequence[WorldObject]) -> str | None:
    """The tallest, shortest, biggest or smallest of the options; None where that is another question or not known."""
    sizes = {o.label: o.size for o in known if o.label in options}
    if which not in ("tallest", "shortest", "biggest", "smallest") or len(sizes) < len(options):
        return None
    tall = which in ("tallest", "shortest")
    order = sorted(sizes, key=lambda label: sizes[label][2] if tall else math.prod(sizes[label]))
    return order[-1 if which in ("tallest", "biggest") else 0]


def _stands_where(option: str, answer: str, known: Sequence[WorldObject], household: Household) -> bool:
    """Does the option stand where the answer says, `the one on the counter` or `the one next to the can`?"""
    for head, relation, anchor in related(tuple(answer.split())):
        names = set(without_determiners(head)) - _NO_NAME
        where = " ".join(without_determiners(anchor))
        if relation == "near" and names <= set(option.split()) and _is_beside(option, where, known):
            return True
        if relation != "on" or not names <= set(option.split()):
            continue
        receptacle = household.receptacle(where)
        rooms = {r.name for r in household.rooms if where == r.name or where in r.aliases}
        for item in (o for o in known if o.label == option):
            room = household.room_at(item.position[0], item.position[1])
            if (receptacle and item.on == receptacle.name) or (room is not None and room.name in rooms):
                return True
    return False


def _is_beside(option: str, other: str, known: Sequence[WorldObject]) -> bool:
    """Does the option stand within a reach of a thing of the other name, on the same surface?"""
    places = [o for o in known if o.label == option]
    others = [o for o in known if o.label == other or o.kind == other]
    return any(
        a.on == b.on and math.dist(a.position[:2], b.position[:2]) < BESIDE
        for a in places
        for b in others
        if a is not b
    )
