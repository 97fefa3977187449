"""What is done only if something is there: the condition is looked into first. Pure."""

from contextlib import suppress

from common.language.condition_wordings import EMPTY, LITTERED
from common.language.normalise import enumeration, without_determiners
from common.language.pattern import Slots
from common.messages import PlanStep
from services.planner.commands.looking import things_at
from services.planner.commands.telling import none_of
from services.planner.grammar.phrases import Phrase, read
from services.planner.plan_builder import Lost, PlanBuilder, Refusal
from services.planner.reference.fits import fitting, unknown
from services.planner.reference.resolve import referents
from services.planner.world import BelievedObject


def condition(builder: PlanBuilder, slots: Slots) -> None:
    """Is the thing there? If so it is what "it" means in what follows; if not, that is left."""
    there, missing = _look_into(builder, slots)
    builder.unmet = "" if there else f"I see {missing}, so I leave it."
    builder.last = there or _named(builder, slots)


def condition_not(builder: PlanBuilder, slots: Slots) -> None:
    """Is the thing missing? If it is there, what follows is left."""
    there, _ = _look_into(builder, slots)
    builder.last = _named(builder, slots) or builder.last
    builder.unmet = f"I see {enumeration([f'the {t.label}' for t in there])}, so I leave it." if there else ""


def _named(builder: PlanBuilder, slots: Slots) -> list[BelievedObject]:
    """What "it" means where the thing is not at the place that was asked about."""
    with suppress(Refusal):
        return [m.object for m in referents(builder, slots["thing"])]
    return []


def state_not(builder: PlanBuilder, slots: Slots) -> None:
    """Is a place other than it is said to be?"""
    state(builder, slots, negated=True)


def state(builder: PlanBuilder, slots: Slots, negated: bool = False) -> None:
    """Is a place empty, or is something on it?"""
    words = slots["words"][1:] if slots["words"][0] == "not" else slots["words"]
    quality = " ".join(words)
    if quality not in EMPTY | LITTERED:
        raise Lost(f"I cannot see whether the {' '.join(without_determiners(slots['spot']))} is {quality}")
    negated = negated != (len(words) < len(slots["words"]))
    place, there, surfaces = things_at(builder, slots["spot"])
    if not there:
        builder.look_at(surfaces)
    builder.spot = place
    if (bool(there) == (quality in LITTERED)) != negated:
        builder.unmet = ""
    else:
        builder.unmet = f"The {place.name} is {'not empty' if there else 'empty'}, so I leave it."


def _look_into(builder: PlanBuilder, slots: Slots) -> tuple[list[BelievedObject], str]:
    """What there is of the thing, after a look where nothing is known; and how to say that there is none."""
    words = (*slots["thing"], "on", *slots["spot"]) if "spot" in slots else slots["thing"]
    phrase = read(words, builder.vocabulary)
    if not isinstance(phrase, Phrase):
        raise unknown(builder, words, phrase)
    if phrase.relation in ("on", "near") and builder.vocabulary.spot(phrase.anchor):
        place, known, surfaces = things_at(builder, phrase.anchor)
        builder.spot = place
        fits = fitting(builder, phrase)
        there = [t for t in known if fits(t)]
        if not there:
            builder.look_at(surfaces)
        return there, f"{none_of(phrase)} {place.spoken}"
    meant = [m.object for m in referents(builder, words)]
    if not any(t.seen for t in meant):
        builder.search_first([PlanStep(action="find", object=meant[0].label)])
    return [t for t in meant if t.seen], none_of(phrase)
