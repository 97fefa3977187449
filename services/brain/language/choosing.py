"""Which of several things an answer to "Do you mean the ... or the ...?" chooses. Pure."""

import math
import re
from collections.abc import Sequence

from common.household import Household
from common.language.contractions import expand
from common.language.exchange import PREPOSITIONS
from common.language.mood import is_asked
from common.language.normalise import normalise, without_determiners
from common.language.noun_phrase import WHICH, Which
from common.language.politeness import without_politeness
from common.language.simplify import simplified
from common.messages import WorldObject
from services.brain.language.dialogue import without_lead
from services.brain.language.offered import UNFIT, likeliest, marks_of, words_of

_NO_NAME = frozenset({
    "one", "whichever", "of", "them", "those", "these", "will", "with", "go", "the", "please", "that", "this", "mean",
    "i", "want", "is", "take", "bring", "me", "let", "have", "get", "give", "it", "choose", "would", "like", "you",
    "said", "mentioned", "think", "need", "prefer",
})  # fmt: skip
_ORDINALS = {
    "first": 0, "former": 0, "earlier": 0, "1st": 0, "second": 1, "2nd": 1, "third": 2, "3rd": 2, "fourth": 3,
    "fifth": 4,
}  # fmt: skip
_CARDINALS = {w: n for n, w in enumerate(("one", "two", "three", "four", "five"))} | {str(n + 1): n for n in range(5)}
_SIZES: dict[str, Which] = {
    "tall": "tallest", "high": "tallest", "short": "shortest", "low": "shortest", "big": "biggest", "large": "biggest",
    "small": "smallest", "little": "smallest", "tiny": "smallest",
}  # fmt: skip
_OF_SIZE = "|".join(word for word, which in WHICH.items() if which in _SIZES.values())
_SIZED = re.compile(rf"\b({_OF_SIZE})(?: one)?(?: please)?(?:$|,)")
"""A size that tells of no other noun: `the one that is so tiny`, `the big one, i think`."""
_PEOPLE = frozenset({"fellow", "fella", "guy", "chap", "lad", "beauty", "boy", "thing", "bloke"})
"""Words for anything at all."""
_LAST = frozenset({"last", "latter", "later"})
"""Words for the place in the order of naming."""
_NAMED_BEFORE = re.compile(
    r"\b(?:(?:that |which )?you (?:just |have )?(?:named|said|mentioned|offered|listed|read out)"
    r"|(?:in|on|of|from) (?:your|the) (?:list|row)|(?:out )?of (?:the|those|these|them|your) (?:two|three|pair)"
    r"|if you (?:do not mind|like|would))\b"
)
"""What only says that the options were named before."""
_SAID_BEFORE = re.compile(r"^.*\bi (?:meant|mean|said|wanted|want)\b(?! that\b)(?=.*\w)")
"""What was said before the words that are meant: `did i say mug? i meant ...`."""
_SEVERAL = re.compile(
    r"^(?:(?:i want|bring(?: me)?|get(?: me)?|give me|take|well|oh|yes) )*(?:both|all|each)\b(?! the same| right)"
)
_BUT = re.compile(r"\b(?:any(?:thing|one)?|everything|all|each) (?:of them )?(?:but|except|bar) ")
"""What leaves something out: `anything but the green one`."""
_WHERE_IT_IS = re.compile(r"^(?:where|what|which)\b.* (?:is|are|stands|lies|lives|sits|belongs|goes)$")
"""A relative clause, which says which one: `where the apple is`."""
SURE, FIRM = 0.68, 0.95
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
    meant = expand(_SAID_BEFORE.sub("", normalise(answer, ",")))
    words = words_of(meant)
    # What somebody does not want says less than what they do: "i will not eat it, i will throw it".
    wanted = ",".join(part for part in meant.split(",") if "not" not in part.split())
    likely, p = likeliest(wanted or meant, options, known, household)
    named = any(not set(option.split()).isdisjoint(words) for option in options)
    if not named and UNFIT.isdisjoint(words) and len(sizes := set(_SIZED.findall(wanted))) == 1:
        return _extreme(WHICH[sizes.pop()], options, known)
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
    plain = _NAMED_BEFORE.sub("", without_politeness(normalise(without_lead(answer))))
    bare = " ".join(simplified(tuple(plain.split())))
    words = set(without_determiners(tuple(bare.split()))) - _NO_NAME
    if (number := _number(words, len(options))) is not None:
        return options[number]
    common = set(options[0].split()).intersection(*(option.split() for option in options))
    words = words - common or words
    if words and (words <= WHICH.keys()) and (extreme := _extreme(WHICH[next(iter(words))], options, known)):
        return extreme
    bare = _BUT.sub("not ", re.sub(r"\bneither (.+) nor ", r"not \1 not ", bare))
    if "not" in bare.split():
        named = (
            re.split(r"(?<=\w) the ", part.strip())[0] for part in bare.split("not")[1:]
        )  # not the red the other one
        parts = (set(part.split()) - _NO_NAME - {"and", "or", "nor"} for part in named)
        excluded = [part for part in parts if part]
        left = [o for o in options if not any(part <= set(o.split()) for part in excluded)]
        return left[0] if len(left) == 1 and excluded else None
    marks = [list(marks_of(o, known, household)) if household else [] for o in options]
    names = words - PREPOSITIONS - {"where", "what", "that's", "it's", "on", "got", "has", "is"}
    sizes = {_SIZES[word] for word in names if word in _SIZES}
    matching: list[str] = []
    for kinds in ({"print"}, {"print", "beside", "use", "place", "contents"}):  # its own name before its neighbours'
        own = [
            set(o.split()) | {m for kind, m in found if kind in kinds} for o, found in zip(options, marks, strict=True)
        ]
        fits = [o for o, has in zip(options, own, strict=True) if names and names - _SIZES.keys() - _PEOPLE <= has]
        matching = matching or fits
    if len(sizes) == 1 and len(matching) > 1:
        return _extreme(sizes.pop(), matching, known)
    return matching[0] if len(matching) == 1 and not sizes else None


def _number(words: set[str], count: int) -> int | None:
    """Place in the order of naming that words alone tell: `the second`, `option two`, `the last`."""
    order = next(iter(words - {"number", "option"}), "") if len(words - {"number", "option"}) == 1 else ""
    if order in _ORDINALS or (len(words) == 2 and order in _CARDINALS):
        at = (_ORDINALS if order in _ORDINALS else _CARDINALS)[order]
        return at if at < count else None
    if order in _LAST and (order == "last" or count == 2):
        return count - 1
    return count // 2 if order == "middle" and count % 2 else None


def _extreme(which: Which, options: Sequence[str], known: Sequence[WorldObject]) -> str | None:
    """The tallest, shortest, biggest or smallest of the options; None where that is another question or not known."""
    sizes = {o.label: o.size for o in known if o.label in options}
    if which not in ("tallest", "shortest", "biggest", "smallest") or len(sizes) < len(options):
        return None
    tall = which in ("tallest", "shortest")
    order = sorted(sizes, key=lambda label: sizes[label][2] if tall else math.prod(sizes[label]))
    return order[-1 if which in ("tallest", "biggest") else 0]
