"""Which of several things an answer to "Do you mean the ... or the ...?" chooses. Pure."""

import math
import re
from collections.abc import Sequence

from common.household import Household
from common.language.mood import is_asked
from common.language.normalise import normalise, without_determiners
from common.language.noun_phrase import WHICH, Which, related
from common.language.simplify import simplified
from common.messages import WorldObject
from services.brain.language.dialogue import by_wording
from services.brain.language.offered import UNFIT, beside, likeliest, words_of

_NO_NAME = frozenset({
    "one", "whichever", "of", "them", "those", "these", "will", "with", "go", "the", "please", "that", "this", "mean",
    "i", "want", "is", "take", "bring", "me", "let", "have", "get", "give", "it", "choose", "would", "like", "you",
    "said", "mentioned", "think",
})  # fmt: skip
_CARDINALS = ("one", "two", "three", "four", "five")
_SAID_BEFORE = re.compile(r"^.*\bi (?:meant|mean|said|wanted|want)\b(?! that\b)(?=.*\w)")
"""What was said before the words that are meant: `did i say mug? i meant ...`."""
_SEVERAL = re.compile(
    r"^(?:(?:i want|bring(?: me)?|get(?: me)?|give me|take|well|oh|yes) )*(?:both|all|each)\b(?! the same| right)"
)
_WHERE_IT_IS = re.compile(r"^(?:where|what|which)\b.* (?:is|are|stands|lies|belongs)$")
"""A relative clause, which says which one: `where the apple is`."""
SURE, FIRM = 0.71, 0.95
"""Least probability of a choice that no wording makes, and of one where something is passed over (chosen on lists left
out)."""


def chosen(
    answer: str, options: Sequence[str], known: Sequence[WorldObject] = (), household: Household | None = None
) -> str | None:
    """The one option that the answer singles out by its wording, or that it most likely means.

    Another colour of the same kind names one that was not among the options.
    """
    said = _SAID_BEFORE.sub("", normalise(answer)).strip()
    asks = is_asked(tuple(said.split())) and not _WHERE_IT_IS.match(said)
    if not said or _SEVERAL.match(said) or asks:
        return None  # more than one, or a question of one's own
    if (found := _singled_out(answer, options, known, household)) or household is None:
        return found
    meant = _SAID_BEFORE.sub("", normalise(answer, ","))
    words = words_of(meant)
    likely, p = likeliest(meant, options, known, household)
    named = any(not set(option.split()).isdisjoint(words) for option in options)
    least = FIRM if named and not UNFIT.isdisjoint(words) else SURE
    return likely if likely and p >= least else _another(words, options, known)


def _another(words: Sequence[str], options: Sequence[str], known: Sequence[WorldObject]) -> str | None:
    """`the white one` between the red mug and the blue one, where a white mug is known."""
    kinds = {option.split()[-1] for option in options}
    labels = {o.label for o in known} if len(kinds) == 1 else set()
    found = labels.difference(options) & {f"{word} {kind}" for word in words for kind in kinds}
    return found.pop() if len(found) == 1 else None


def _singled_out(
    answer: str, options: Sequence[str], known: Sequence[WorldObject], household: Household | None
) -> str | None:
    """The one option that the answer's words single out, by name, number, side of "not", or where it stands."""
    bare = " ".join(simplified(tuple(by_wording(answer)[1].split())))
    words = set(without_determiners(tuple(bare.split()))) - _NO_NAME
    for n, ordinal in enumerate(("first", "second", "third", "fourth", "fifth")):
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
        if not names <= set(option.split()):
            continue
        items = [o for o in known if o.label == option]
        if relation == "near" and any(where in (o.label, o.kind) for item in items for o in beside(item, known)):
            return True
        if relation != "on":
            continue
        receptacle = household.receptacle(where)
        rooms = {r.name for r in household.rooms if where == r.name or where in r.aliases}
        for item in items:
            room = household.room_at(item.position[0], item.position[1])
            if (receptacle and item.on == receptacle.name) or (room is not None and room.name in rooms):
                return True
    return False
