"""What `it`, `them` and `one` stand for: what was spoken of, what is held, what the last mission handled. Pure."""

import msgspec

from services.planner.grammar.senses import Spot
from services.planner.plan_builder import Lost, PlanBuilder
from services.planner.world import BelievedObject


class Referent(msgspec.Struct, frozen=True):
    """An object that is meant; `words` where its name alone does not tell; `at` where to look for it first."""

    object: BelievedObject
    words: str = ""
    at: Spot | None = None


def speak_of(builder: PlanBuilder, meant: list[Referent]) -> None:
    """What is told of things: `it` is one of them from now on, and is looked for by the same words and place."""
    builder.last = [m.object for m in meant]
    builder.told |= {m.object.label: (m.words, m.at) for m in meant}


def pronoun(builder: PlanBuilder, plural: bool) -> list[Referent]:
    if builder.last:
        spoken = _handled(builder) if plural and len(builder.last) == 1 else builder.last
        meant = [builder.world.current(t) for t in (spoken if plural else builder.last[-1:])]
        return [Referent(t, *builder.told.get(t.label, ("", None))) for t in meant]
    if held := builder.world.held:
        return [Referent(held)]
    if before := handled_before(builder):
        return [Referent(t) for t in (before if plural else before[-1:])]
    raise Lost("I do not know what you mean by that" if plural else "I do not know what you mean by it")


def _handled(builder: PlanBuilder) -> list[BelievedObject]:
    """The thing spoken of last, behind the others that the plan has handled: `get the mug, get the can, put both ...`.

    Alone where its name is a plural: `my keys, put them there`.
    """
    last = builder.last[0].label
    taken = dict.fromkeys(s.object for s in builder.steps if s.action == "grasp" and s.object)
    if last.endswith("s") or last not in taken:
        return builder.last
    return [BelievedObject(label, "", seen=False) for label in taken]


def handled_before(builder: PlanBuilder) -> list[BelievedObject]:
    """What the last mission handled."""
    named = [BelievedObject(label, "", seen=False) for label in builder.world.history.objects]
    return [builder.world.current(t) for t in named]


def mentioned(builder: PlanBuilder) -> list[BelievedObject]:
    """What `one` and `other` refer to: the things of this command, else those of the last, else the one in the hand."""
    held = builder.world.held
    return builder.last or handled_before(builder) or ([held] if held else [])
