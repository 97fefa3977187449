"""Whether a plan accounts for every colour, kind and place that was said, and the plan as a plain command. Pure.

What was said and has left no trace in a plan was read over ("the bottle, not the white one and not the green one"), so
the plan is asked about before it is carried out.
"""

import re
from collections.abc import Sequence

from common.language.lexicon import COMMANDING
from common.language.meaning import is_question
from common.language.normalise import DETERMINERS, Words, enumeration
from common.messages import PlanStep
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.world import World

MOST_WORDS = 3
"""Words of the longest name of a place (chosen)."""
_ACTS = frozenset({"find", "grasp", "place", "navigate", "release", "return"})
CONDITIONS = frozenset({"if", "unless", "otherwise"})
"""First words of clauses that need leave no trace; nor need questions, nor one of two alternatives."""
_TOLD_APART = re.compile(
    r"\b(?:not|nothing|but|except|excluding|without|other than|apart from|leave|next to|beside|near|nearest|closest|"
    r"between|left of|right of|in front of|behind|by)\b|^(?:leave|vacate|exit|(?:get|go|come) out of)\b"
)
"""Behind these stand things that tell which one is meant, or is not; none of them is in the plan."""

_SPEECH = re.compile(
    r"(?<=\w) (?:say|tell|announce)\b(?: (?:that|to|them))? (?!.*\b(?:bring|fetch|put|take|go|come)\b).+$"
)
"""The words of a speech behind another command, in which things and places may be named."""
_TELLS_WHY = re.compile(
    r"^(?:the|this|that|these|those|my|our) (?:\w+ ){1,3}?"
    r"(?:is|are|was|were|has|have|will|does|do|needs?|looks?|keeps?)\b"
    r"(?!.*\b(?:on|in|at|to|into|onto|from|for|where|here|there|and|it|them)\b)"
)
"""A clause beside others that says how something is and no more: "the kitchen sink is blocked"."""


def unaccounted(clauses: Sequence[str], steps: Sequence[PlanStep], world: World, vocabulary: Vocabulary) -> list[str]:
    """Colours, kinds and places of the clauses that no step has anything to do with; [] for a plan that only speaks."""
    if not any(s.action in _ACTS for s in steps):
        return []
    trace = _Trace(steps, world, vocabulary)
    alone = len(clauses) == 1
    meant = [
        clause
        for clause in clauses
        if not is_question(clause) and not clause.startswith("say ") and (alone or not _TELLS_WHY.match(clause))
    ]
    if any(s.action == "say" for s in steps):
        meant = [_SPEECH.sub("", clause) for clause in meant]
    asked = [_asked(clause, trace.certain).split() for clause in meant]
    definite = [tuple(words) for words in asked if words and words[0] not in CONDITIONS and "or" not in words]
    return [word for words in definite for word in trace.missing(words)]


def _asked(clause: str, certain: bool) -> str:
    """The words that have to leave a trace; all of them where the plan names a thing by its description only."""
    apart = _TOLD_APART.search(clause) if certain else None
    return clause[: apart.start()] if apart else clause


_INTO = frozenset({"to", "into"})
_RELATED = frozenset({"next", "close", "near", "closer", "nearest", "closest", "belongs", "belong"})
_DEFINITE = (("the",), ("my",), ("our",))
"""Words around the name of a place where somebody is sent."""


class _Trace:
    """All that the steps touch: things, what these are called, where they are and go. `certain`: all have been seen."""

    def __init__(self, steps: Sequence[PlanStep], world: World, vocabulary: Vocabulary) -> None:
        self._vocabulary = vocabulary
        self._labels = {name for s in steps for name in (s.object, s.near) if name}
        self._labels |= {t.label for t in world.objects if t.held}
        self._things = [t for t in (*world.objects, *world.specs) if t.label in self._labels]
        self.certain = self._labels <= {t.label for t in world.objects}
        spots = {s.target for s in steps} | {t.on for t in self._things}
        receptacles = [r for name in spots if (r := world.household.receptacle(name))]
        rooms = [world.household.room_at(*r.center[:2]) for r in receptacles]
        self._spots = spots | {room.name for room in rooms if room} | {world.room_of(t) for t in self._things}
        texts = [*self._labels, *spots, *(s.text for s in steps)]
        texts += [text for t in self._things for text in (t.text, *t.names)]
        self._words = frozenset(" ".join(texts).lower().split())
        self._colours = {c for t in self._things for c in (t.colour, *t.colours)}
        self._kinds = {t.kind for t in self._things}

    def missing(self, words: Words) -> list[str]:
        found: list[str] = []
        at = 1 if words[0] in COMMANDING else 0
        while at < len(words):
            end = next((e for e in range(min(len(words), at + MOST_WORDS), at, -1) if self._is_place(words[at:e])), 0)
            if not end and (whole := self._long_noun(words, at)):
                name, end = " ".join(words[at:whole]), whole
                found += [] if self._has(name) else [name]
            elif not end:
                modal = words[at] == "can" and not self._may_be_noun(words, at)
                found += [] if modal or self._has(words[at]) else [words[at]]
            elif not self._has_place(words[at:end]):
                found.append(" ".join(words[at:end]))
            if (elsewhere := self._unknown_place(words, at)) is not None:
                found.append(elsewhere)
            at = max(end, at + 1)
        return found

    def _unknown_place(self, words: Words, at: int) -> str | None:
        """`market` of `to the market`, where nobody knows such a place and no step has to do with such a thing."""
        if words[at] not in _INTO or words[at - 1] in _RELATED or words[at + 1 : at + 2] not in _DEFINITE:
            return None
        name, ends = words[at + 2 : at + 3], range(at + 3, at + 3 + MOST_WORDS)
        is_known = not name or self._vocabulary.noun(name[0]) or any(self._is_place(words[at + 2 : e]) for e in ends)
        return None if is_known or not self._vocabulary.unlisted(name) else name[0]

    def _long_noun(self, words: Words, at: int) -> int:
        """Where a known name of several words that begins there ends, as `something to drink from`; 0 for none."""
        if words[at] in self._vocabulary.colours:
            return 0
        ends = range(min(len(words), at + MOST_WORDS + 1), at + 1, -1)
        return next((end for end in ends if self._vocabulary.noun(" ".join(words[at:end]))), 0)

    def _may_be_noun(self, words: Words, at: int) -> bool:
        before = words[at - 1] if at else ""
        return before in DETERMINERS or before in self._vocabulary.colours

    def _is_place(self, words: Words) -> bool:
        if words[0] in DETERMINERS or words[-1] in DETERMINERS or self._vocabulary.noun(" ".join(words)):
            return False
        spots = self._vocabulary.spot(words)
        return bool(spots) and not any(s.home for s in spots)

    def _has_place(self, words: Words) -> bool:
        named = any(s.name in self._spots for s in self._vocabulary.spot(words))
        return (
            named
            or all(self._vocabulary.noun(w) or w in self._vocabulary.colours for w in words)
            or bool(set(words) <= self._words)
        )

    def _has(self, word: str) -> bool:
        if word in self._words:
            return True
        if (colour := self._vocabulary.colours.get(word)) is not None:
            return colour in self._colours or colour in self._words
        noun = self._vocabulary.noun(word)
        if noun is None or noun[0].every or noun[0].new or self._vocabulary.spot((word,)):
            return True
        sense = noun[0]
        return bool(sense.names & self._labels or sense.kinds & (self._kinds | self._words))


def as_command(steps: Sequence[PlanStep], world: World) -> str:
    """The plan in the plain words of a command, "" for one that has none."""
    said: list[str] = []
    for step in steps:
        last = said[-1] if said else ""
        held = last.removeprefix("pick up the ") if last.startswith("pick up the ") else ""
        match step.action:
            case "find":
                said.append(f"find the {step.object}")
            case "grasp" if last == f"find the {step.object}":
                said[-1] = f"pick up the {step.object}"
            case "place" if held == step.object:
                receptacle = world.household.receptacle(step.target)
                into = "in" if receptacle and receptacle.kind == "bin" else "on"
                where = f"next to the {step.near}" if step.near else f"{into} the {step.target}"
                said[-1] = f"put the {held} {where}"
            case "return":
                said.append("come back")
            case "release" if last == "come back" and said[-2:-1] and said[-2].startswith("pick up the "):
                said[-2:] = [f"bring me the {said[-2].removeprefix('pick up the ')}"]
            case "navigate" if step.target and step.target != "around":
                said.append(f"go to the {step.target}")
            case "wait" if not step.seconds:
                continue
            case _:
                return ""
    return enumeration(said) if len(said) < 3 else ", then ".join(said)
