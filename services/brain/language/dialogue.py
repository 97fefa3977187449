"""Yes, no, or a correction: what an answer to "Did you say ...?" means. Pure."""

import math
import re
from collections.abc import Sequence
from typing import Literal

from common.household import Household
from common.language.clauses import without_fillers
from common.language.contractions import expand
from common.language.contrasts import with_qualities
from common.language.discourse import commands
from common.language.exchange import PREPOSITIONS, noun_phrases, replaced
from common.language.lexicon import COMMANDING
from common.language.meaning import asks_for, is_question
from common.language.normalise import DETERMINERS, Words, infinitive, normalise, without_determiners
from common.language.noun_phrase import WHICH, Which, related
from common.language.politeness import without_politeness
from common.language.simplify import simplified
from common.messages import WorldObject
from common.plan_rules import is_destination

Reply = Literal["yes", "no", "cancel", "correction"]
_CORRECTION = re.compile(
    r"^(?:neither(?!.* nor\b)|none of (?:them|those)|"
    r"not at all|not really|no way|no|nope|yes|yeah|yep|wrong|not that|i said|i meant|i mean|i want(?:ed)?|i "
    r"need|i would like|actually|"
    r"rather|almost|nearly|close|not quite|oops|whoops|ugh|sorry|wait|but)\s+"
)


_NO_NAME = frozenset({
    "one", "whichever", "of", "them", "those", "these", "will", "with", "go", "the", "please", "that", "this", "mean",
    "i", "want", "is", "take", "bring", "me", "let", "have", "get", "give", "it", "choose", "would", "like", "you",
    "said", "mentioned", "think",
})  # fmt: skip
_CARDINALS = ("one", "two", "three", "four")
_MISHEARD = re.compile(r"^no,? (?:not )?(?:the )?\w+(?: \w+)? (?=i (?:said|meant)\s)")
_CONTRAST = re.compile(r"^(?P<right>(?!not\b).+?),? (?:and |but )?not (?P<wrong>.+)$")
_SAID = re.compile(r"\s+i (?:said|meant)$")


LONGEST_NAME = 3
"""Most words of an answer that is a name alone and no sentence of its own (chosen)."""
BESIDE = 0.6
"""Farthest an object is "next to" another [m] (chosen: both within one reach)."""


def reply(text: str) -> tuple[Reply, str]:
    """The kind of answer, and for a correction the words without its "no, I said"."""
    rest = without_fillers(expand(normalise(text)))
    if (kind := _kind(rest)) is not None:
        return kind, ""
    rest = _MISHEARD.sub("", rest)
    while (shorter := _CORRECTION.sub("", rest)) != rest:
        rest = shorter
    return "correction", without_politeness(_SAID.sub("", rest)) or rest


def _kind(text: str) -> Literal["yes", "no", "cancel"] | None:
    """What a text without correction says, once or several times: `that is the one, go ahead`."""
    words = text.split()
    for kind in ("yes", "no", "cancel"):
        halves = ((" ".join(words[:at]), " ".join(words[at:])) for at in range(1, len(words)))
        if asks_for(text, kind) or any(asks_for(a, kind) and asks_for(b, kind) for a, b in halves):
            return kind
    return None


def corrected(command: str, correction: str, household: Household) -> str:
    """The command with the thing or place exchanged that the correction names; a whole new command replaces it."""

    def is_place(words: Words) -> bool:
        return is_destination(" ".join(words), household)

    if contrast := _CONTRAST.match(correction):
        correction = with_qualities(command, contrast["wrong"], contrast["right"])
    if correction.split()[:1] in (["not"], ["but"]):
        correction = next(iter(commands(correction)), correction)
    thing = correction if correction.split()[:1] and correction.split()[0] in DETERMINERS else f"the {correction}"
    if set(correction.split()) <= household.words.colours.keys():
        thing = f"the {correction} one"
    if _is_command(correction):
        return _with_object(correction, command)
    exchanged = replaced(normalise(command), correction if correction.split()[0] in PREPOSITIONS else thing, is_place)
    return exchanged or correction


def answered(suggestion: str, answer: str, household: Household) -> str:
    """The command that an answer to a suggested one comes to: with another thing or place, or a command of its own.

    A name alone, `spatula`, is of what the suggestion is to be done with.
    """
    words = answer.split()
    names = len(words) <= LONGEST_NAME and not _is_command(answer) and not is_question(answer)
    begins = words[:1] and words[0] in DETERMINERS | PREPOSITIONS
    return corrected(suggestion, answer, household) if words and (begins or names) else answer


def _with_object(correction: str, command: str) -> str:
    """`put it on the counter` after a question about `put the apple on the desk` speaks of the apple."""
    words = normalise(command).split()
    spans = noun_phrases(words)
    if not spans:
        return correction
    thing = " ".join(words[spans[0][0] : spans[0][1]])
    return re.sub(r"(?<=\w )(?:it|them)\b", thing, correction, count=1)


def _is_command(text: str) -> bool:
    words = without_politeness(text).split()
    return bool(words) and len(words) > 1 and infinitive(words[0], COMMANDING) in COMMANDING


def chosen(
    answer: str, options: Sequence[str], known: Sequence[WorldObject] = (), household: Household | None = None
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
