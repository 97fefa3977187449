"""Which of several objects that fit a phrase are meant. Pure."""

from common.language.normalise import enumeration, without_determiners
from services.planner.grammar.phrases import Phrase
from services.planner.grammar.senses import Spot
from services.planner.plan_builder import Lost, PlanBuilder, Refusal
from services.planner.reference.fits import MAX_NAMED
from services.planner.reference.pronouns import Referent, mentioned
from services.planner.reference.relations import superlative
from services.planner.world import BelievedObject


def choose(
    builder: PlanBuilder, phrase: Phrase, seen: list[BelievedObject], specs: list[BelievedObject]
) -> list[Referent]:
    """From the candidates those that are meant."""
    if phrase.which == "other":
        seen = [t for t in seen if t.label not in {x.label for x in mentioned(builder)}]
    if not seen:
        if phrase.count != 1:
            builder.look_first(builder.vocabulary.surfaces(), f"I have seen no {phrase.singular} yet")
        return [unseen(builder, phrase, specs, None)]
    if phrase.among > 1 and len(seen) != phrase.among:
        seen = [t for t in seen if builder.spot and builder.spot.name in (t.on, builder.world.room_of(t))]
        if len(seen) != phrase.among:
            raise Lost(f"I do not know which {phrase.noun} you mean")
    if phrase.which and phrase.which != "other":
        return [Referent(superlative(builder, phrase, seen))]
    near = sorted(seen, key=lambda t: (not t.held, builder.world.distance(t), t.label))
    if phrase.count != 1:
        if phrase.count > len(near):
            raise Refusal(f"I know of only {len(near)} of the {phrase.count} {phrase.noun}")
        return [Referent(t) for t in (near[: phrase.count] if phrase.count else near)]
    if builder.steps and builder.steps[-1].action == "navigate" and builder.spot is not None:
        where = builder.spot.name  # "go to the kitchen and get a can"
        near = [t for t in near if where in (t.on, builder.world.room_of(t))] or near
    if len(near) == 1 or phrase.any_one:
        return [Referent(builder.choices.pick(near))]
    preferred = [t for t in near if t.label == phrase.sense.prefer]
    if preferred and not phrase.colours and not phrase.relation:
        return [Referent(preferred[0])]
    names = [t.label for t in sorted(near, key=lambda t: t.label)[:MAX_NAMED]]
    if len(set(names)) == 1:
        return [Referent(near[0])]
    kinds = {t.kind for t in near}
    if len(kinds) == 1 and kinds == phrase.sense.kinds and not phrase.colours and phrase.which != "other":
        # Perception will find several and the brain asks which one.
        kind = next(iter(kinds))
        words = _words(phrase, kind)
        return [Referent(BelievedObject(label=kind, kind=kind, size=near[0].size), "" if words == kind else words)]
    raise Lost(f"I do not know which one you mean: {enumeration([f'the {n}' for n in names], 'or')}")


def _words(phrase: Phrase, kind: str) -> str:
    """What was said of a thing without its article, with its kind for "one"."""
    said = without_determiners(tuple(phrase.text.split()))
    return " ".join(kind if word == "one" == phrase.noun else word for word in said)


def unseen(builder: PlanBuilder, phrase: Phrase, specs: list[BelievedObject], at: Spot | None) -> Referent:
    """Something nobody has seen yet: by its name if the household has one of the kind, else any of the kind in view."""
    if not specs:
        raise Refusal(f"I have seen no {phrase.noun}")
    where = at if at is None or not at.home else None
    if len(specs) == 1:
        return Referent(specs[0], at=where)
    preferred = [t for t in specs if t.label == phrase.sense.prefer]
    if preferred and not (phrase.colours or phrase.relation or phrase.which):
        return Referent(preferred[0])
    kinds = sorted({t.kind for t in specs})
    if phrase.colours or (len(kinds) > 1 and not phrase.any_one):
        names = enumeration([f"the {t.label}" for t in specs[:MAX_NAMED]], "or")
        raise Lost(f"I do not know which one you mean: {names}")
    kind = builder.choices.pick(kinds)
    words = _words(phrase, kind) if phrase.which or phrase.relation else ""
    return Referent(BelievedObject(label=kind, kind=kind, seen=False), words, where)
