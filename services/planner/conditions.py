"""What is done only if something is there: the condition is looked into first. Pure."""

from common.language.pattern import Slots
from common.messages import PlanStep
from services.planner.answers import things_at
from services.planner.phrases import Phrase, read
from services.planner.plan_builder import PlanBuilder, Refusal
from services.planner.resolve import fitting, referents, unknown


def condition(builder: PlanBuilder, slots: Slots) -> None:
    """Is the thing there? If so it is what "it" means in what follows; if not, that is left."""
    words = (*slots["thing"], "on", *slots["spot"]) if "spot" in slots else slots["thing"]
    phrase = read(words, builder.vocabulary)
    if not isinstance(phrase, Phrase):
        raise Refusal(unknown(builder, words, phrase))
    name = phrase.singular or phrase.noun
    if phrase.relation in ("on", "near") and builder.vocabulary.spot(phrase.anchor):
        place, known, surfaces = things_at(builder, phrase.anchor)
        fits = fitting(builder, phrase)
        there = [t for t in known if fits(t)]
        if not there:
            builder.look_at(surfaces)
        where = f"{'in' if place.receptacle is None or place.receptacle.depth else 'on'} the {place.name}"
        builder.unmet = "" if there else f"I see no {' '.join((*phrase.colours, name))} {where}, so I leave it."
        builder.last = there
        return
    meant = [m.object for m in referents(builder, words)]
    if not any(t.seen for t in meant):
        builder.search_first([PlanStep(action="find", object=meant[0].label)])
    there = [t for t in meant if t.seen]
    builder.unmet = "" if there else f"I see no {name}, so I leave it."
    builder.last = there
