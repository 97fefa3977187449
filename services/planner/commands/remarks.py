"""What is said beside a command: a reason, a thing or a place that is spoken of next. Pure."""

from common.language.pattern import Slots
from services.planner.plan_builder import NOT_UNDERSTOOD, Lost, PlanBuilder, Refusal
from services.planner.reference.places import spot
from services.planner.reference.pronouns import speak_of
from services.planner.reference.resolve import referents


def remark(builder: PlanBuilder, slots: Slots) -> None:
    """A reason for what is asked next, such as "I'm thirsty"; a need that is known is met if nothing else is asked."""
    words = slots.get("words", ())
    if "and" in words:
        raise Lost("I do not understand that")
    needs = builder.world.household.words.needs
    builder.need = next((n for w, n in needs.items() if w in words), builder.need)


def mention(builder: PlanBuilder, slots: Slots) -> None:
    """A thing that is spoken of next as "it"; where it is said to be is where it is looked for."""
    if "and" in slots.get("words", ()):
        raise Lost(f"{NOT_UNDERSTOOD} that")
    words = (*slots["thing"], "on", *slots["spot"]) if "spot" in slots else slots["thing"]
    try:
        speak_of(builder, referents(builder, words))
    except Refusal:
        speak_of(builder, referents(builder, slots["thing"]))


def untidy(builder: PlanBuilder, slots: Slots) -> None:
    """The place that is spoken of next as "it"."""
    builder.spot = spot(builder, slots["spot"])


def again(builder: PlanBuilder, slots: Slots) -> None:
    """What was done before is worked out from its words, before any clause is read."""
    raise Refusal("I have done nothing yet that I could do again")
