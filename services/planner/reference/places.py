"""The place that words mean. Pure."""

from common.language.normalise import Words, enumeration, normalise, without_determiners
from services.planner.grammar.chunks import named
from services.planner.grammar.phrases import Phrase, read
from services.planner.grammar.senses import Spot
from services.planner.plan_builder import Lost, PlanBuilder, Refusal
from services.planner.reference.relations import away


class NoSuchPlace(Refusal):
    """Nothing can be put or looked for there, whatever else is not known."""


def spot(builder: PlanBuilder, words: Words) -> Spot:
    """The place that is meant.

    Raises:
        Refusal: no such place, or several.
    """
    if " ".join(words) in ("there", "it", "that") and (meant := builder.spot or _of_last(builder)) is not None:
        return meant
    nearest = words[-2:-1] if words[:1] == ("the",) and len(words) == 3 else ()
    wanted = words[2:] if nearest and nearest[0] in ("nearest", "closest") else words
    found = builder.vocabulary.spot(wanted)
    if not found:
        furniture = builder.vocabulary.furniture(words)
        phrase = read(words, builder.vocabulary)
        if isinstance(phrase, Phrase) and phrase.sense.new and not furniture:
            raise NoSuchPlace(f"I know no {' '.join(without_determiners(words))}")
        if furniture or isinstance(phrase, Phrase):
            raise NoSuchPlace(f"the {furniture or ' '.join(without_determiners(words))} is no place that I can use")
        raise Lost(f"I know no {' '.join(without_determiners(words))}")
    if len(found) > 1 and wanted is not words:
        return min(found, key=lambda s: away(builder, s))
    if len(found) > 1:
        raise Lost(f"I do not know which one you mean: {enumeration([f'the {s.name}' for s in found], 'or')}")
    return found[0]


def _of_last(builder: PlanBuilder) -> Spot | None:
    """Where something was put just now; None where the last command named no place, or was not carried out."""
    last = builder.world.history.last
    if last is None or last.outcome != "delivered":
        return None
    spots = named(tuple(normalise(last.command).split()), builder.vocabulary)[1]
    return builder.vocabulary.spot(tuple(spots[-1].split()))[0] if spots else None


def anchor_spots(builder: PlanBuilder, phrase: Phrase) -> list[Spot]:
    """The places that a phrase names behind its relation: `on the desk and the table` names two."""
    if spots := builder.vocabulary.spot(phrase.anchor):
        return spots
    if phrase.relation == "near" and (beside := builder.vocabulary.surfaces_by(phrase.anchor)):
        return beside
    for at, word in enumerate(phrase.anchor):
        if word in ("and", "or"):
            parts = [builder.vocabulary.spot(part) for part in (phrase.anchor[:at], phrase.anchor[at + 1 :])]
            return [s for part in parts for s in part] if all(parts) else []
    return []
