"""Which objects a phrase fits by kind, name and colour, and what it leaves out. Pure."""

from collections.abc import Callable

import msgspec

from common.language.normalise import DETERMINERS, Words, enumeration, without_determiners
from common.language.noun_phrase import PLURAL_PRONOUNS, PRONOUNS
from common.messages import SENSELESS
from services.planner.grammar.phrases import Phrase, read
from services.planner.grammar.senses import LONGEST_NAME
from services.planner.plan_builder import Lost, PlanBuilder, Refusal
from services.planner.reference.pronouns import pronoun
from services.planner.world import BelievedObject

MAX_NAMED = 4
"""Objects named in a question between several (chosen: what one remembers)."""


def fitting(builder: PlanBuilder, phrase: Phrase) -> Callable[[BelievedObject], bool]:
    """Whether an object is of the kind, the names and the colours of a phrase, and none that it leaves out."""
    sense, colours, left_out = phrase.sense, phrase.colours, _left_out(builder, phrase)

    def fits(item: BelievedObject) -> bool:
        named = sense.every or item.label in sense.names or item.kind in sense.kinds
        return named and (not colours or any(map(item.is_of, colours))) and not left_out(item)

    return fits


def _left_out(builder: PlanBuilder, phrase: Phrase) -> Callable[[BelievedObject], bool]:
    """What the phrases after "except" mean: things, colours, places where they stand.

    Raises:
        Refusal: one of them means nothing.
    """
    names, colours, places = set[str](), set[str](), set[str]()
    for words in phrase.but:
        bare = [w for w in words if w not in DETERMINERS]
        if " ".join(words) in PRONOUNS | PLURAL_PRONOUNS:
            names |= {m.object.label for m in pronoun(builder, " ".join(words) in PLURAL_PRONOUNS)}
            continue
        if builder.vocabulary.noun(" ".join(bare)) is None and (spots := builder.vocabulary.spot(words)):
            places |= {s.name for s in spots}
            continue
        if all(w in builder.vocabulary.colours for w in bare):
            colours |= {builder.vocabulary.colours[w] for w in bare}
            continue
        meant = read(("all", *without_determiners(words)), builder.vocabulary)
        if not isinstance(meant, Phrase):
            raise unknown(builder, words, meant)
        if meant.noun in ("one", "ones"):
            meant = msgspec.structs.replace(meant, sense=phrase.sense)
        names |= _labels(builder, meant)
    if not places:
        return lambda item: item.label in names or any(map(item.is_of, colours))
    return lambda item: (
        item.label in names or any(map(item.is_of, colours)) or bool({item.on, builder.world.room_of(item)} & places)
    )


def _labels(builder: PlanBuilder, phrase: Phrase) -> set[str]:
    """Labels of everything that a phrase means."""
    fits = fitting(builder, phrase)
    known = [t for t in (*builder.world.objects, *builder.world.specs) if fits(t)]
    if phrase.relation and (spots := builder.vocabulary.spot(phrase.anchor)):
        names = {s.name for s in spots}
        known = [t for t in known if t.on in names or builder.world.room_of(t) in names]
    return {t.label for t in known}


def unknown(builder: PlanBuilder, words: Words, noun: str) -> Refusal:
    """Why a phrase means nothing, with what there is instead."""
    if len(noun.split()) > LONGEST_NAME or DETERMINERS & set(noun.split()):
        return Lost(f"{SENSELESS} {' '.join(words)!r}")
    *front, last = noun.split() or [""]
    known = builder.vocabulary.noun(last)
    if front and known is not None and not known[0].every:
        names = [t.label for t in builder.world.specs if t.kind in known[0].kinds or t.label in known[0].names]
        if names:
            return Lost(f"I know no {noun}, only {enumeration([f'the {n}' for n in names[:MAX_NAMED]])}")
    if furniture := builder.vocabulary.furniture(words):
        return Refusal(f"I cannot pick up the {noun or furniture}")
    by_looks = known is not None and front[:1] and front[0] in builder.vocabulary.colours
    if (spots := builder.vocabulary.spot(words)) and not by_looks:
        if spots[0].home:  # `bring me`
            return Lost("I did not hear which thing you mean")
        return Refusal(f"I cannot pick up the {noun}")
    return Lost(f"I know no {noun}" if noun else "I did not hear which thing you mean")
