"""Reference resolution: the objects and places of the believed world that a phrase means. Pure."""

from collections.abc import Callable

import msgspec

from common.language.normalise import DETERMINERS, Words, enumeration, without_determiners
from common.language.noun_phrase import PLURAL_PRONOUNS, PRONOUNS
from services.planner.phrases import Phrase, read
from services.planner.plan_builder import NOT_UNDERSTOOD, PlanBuilder, Refusal
from services.planner.relations import away, between, holds, is_near, spoken, superlative
from services.planner.vocabulary import LONGEST_NAME, Spot
from services.planner.world import BelievedObject

MAX_QUESTION = 4
"""Objects named in a question between several (chosen: what one remembers)."""


class Referent(msgspec.Struct, frozen=True):
    """An object that is meant; `words` where its name alone does not tell; `at` where to look for it first."""

    object: BelievedObject
    words: str = ""
    at: Spot | None = None


def referents(builder: PlanBuilder, words: Words, prefer_held: bool = False) -> list[Referent]:
    """Everything that is meant, at least one.

    Raises:
        Refusal: nothing of that name, or several and no way to tell which.
    """
    pronoun = " ".join(words)
    if pronoun in PRONOUNS or pronoun in PLURAL_PRONOUNS:
        return _pronoun(builder, pronoun in PLURAL_PRONOUNS)
    phrase = read(words, builder.vocabulary)
    if isinstance(phrase, Phrase):
        return _resolve(builder, phrase, prefer_held)
    for at in range(1, len(words) - 1):
        if words[at] == "and":
            if _is_named(builder, words[:at]) and not _is_named(builder, words[at + 1 :]):
                continue
            try:
                return [*referents(builder, words[:at], prefer_held), *referents(builder, words[at + 1 :], prefer_held)]
            except Refusal:
                continue
    raise Refusal(unknown(builder, words, phrase))


def _is_named(builder: PlanBuilder, words: Words) -> bool:
    """Do the words begin like a name, or name something known? `dance` of `the red mug and dance` does not."""
    phrase = read(words, builder.vocabulary)
    return not isinstance(phrase, Phrase) or not phrase.sense.new or words[0] in DETERMINERS


def referent(builder: PlanBuilder, words: Words, prefer_held: bool = False) -> Referent:
    """The single object that is meant."""
    meant = referents(builder, words, prefer_held)
    if len(meant) > 1:
        raise Refusal("I can only do that with one thing at a time")
    return meant[0]


def spot(builder: PlanBuilder, words: Words) -> Spot:
    """The place that is meant.

    Raises:
        Refusal: no such place, or several.
    """
    if " ".join(words) in ("there", "it", "that") and builder.spot is not None:
        return builder.spot
    nearest = words[-2:-1] if words[:1] == ("the",) and len(words) == 3 else ()
    wanted = words[2:] if nearest and nearest[0] in ("nearest", "closest") else words
    found = builder.vocabulary.spot(wanted)
    if not found:
        furniture = builder.vocabulary.furniture(words)
        phrase = read(words, builder.vocabulary)
        if furniture or isinstance(phrase, Phrase):
            raise Refusal(f"the {furniture or ' '.join(without_determiners(words))} is no place that I can use")
        raise Refusal(f"I know no {' '.join(without_determiners(words))}")
    if len(found) > 1 and wanted is not words:
        return min(found, key=lambda s: away(builder, s))
    if len(found) > 1:
        raise Refusal(f"I do not know which one you mean: {enumeration([f'the {s.name}' for s in found], 'or')}")
    return found[0]


def unknown(builder: PlanBuilder, words: Words, noun: str) -> str:
    """Why a phrase means nothing, with what there is instead."""
    if len(noun.split()) > LONGEST_NAME or DETERMINERS & set(noun.split()):
        return f"{NOT_UNDERSTOOD} {' '.join(words)!r}"
    *front, last = noun.split() or [""]
    known = builder.vocabulary.noun(last)
    if front and known is not None and not known[0].every:
        names = [t.label for t in builder.world.specs if t.kind in known[0].kinds or t.label in known[0].names]
        if names:
            return f"I know no {noun}, only {enumeration([f'the {n}' for n in names[:MAX_QUESTION]])}"
    if furniture := builder.vocabulary.furniture(words):
        return f"I cannot pick up the {noun or furniture}"
    if builder.vocabulary.spot(words):
        return f"I cannot pick up the {noun}"
    return f"I know no {noun}" if noun else "I did not hear which thing you mean"


def _pronoun(builder: PlanBuilder, plural: bool) -> list[Referent]:
    if builder.last:
        return [Referent(builder.world.current(t)) for t in (builder.last if plural else builder.last[-1:])]
    if held := builder.world.held:
        return [Referent(held)]
    if before := handled_before(builder):
        return [Referent(t) for t in (before if plural else before[-1:])]
    raise Refusal("I do not know what you mean by that" if plural else "I do not know what you mean by it")


def handled_before(builder: PlanBuilder) -> list[BelievedObject]:
    """What the last mission handled."""
    named = [BelievedObject(label, "", seen=False) for label in builder.world.history.objects]
    return [builder.world.current(t) for t in named]


def _mentioned(builder: PlanBuilder) -> list[BelievedObject]:
    """What `one` and `other` refer to: the things of this command, else those of the last."""
    return builder.last or handled_before(builder)


def _resolve(builder: PlanBuilder, phrase: Phrase, prefer_held: bool) -> list[Referent]:
    sense = phrase.sense
    if sense.every and phrase.noun in ("one", "ones") and (mentioned := _mentioned(builder)):
        sense = msgspec.structs.replace(sense, every=False, kinds=frozenset(t.kind for t in mentioned))
        phrase = msgspec.structs.replace(phrase, sense=sense)
    if sense.new:
        return [_new(builder, phrase)]
    fits = fitting(builder, phrase)
    held = builder.world.held
    if prefer_held and held and fits(held) and not phrase.relation and not phrase.which and phrase.count == 1:
        return [Referent(held)]
    seen = [t for t in builder.world.objects if fits(t) and not t.held]
    if held and fits(held) and not phrase.relation and phrase.which != "other":
        seen = [held, *seen]
    specs = [t for t in builder.world.specs if fits(t)]
    if not seen and not specs and builder.vocabulary.new_nouns and not sense.every:
        return _never_seen(builder, phrase)
    if not seen and not specs:
        raise Refusal(unknown(builder, tuple(phrase.text.split()), " ".join((*phrase.colours, phrase.noun))))
    if phrase.relation:
        return _related(builder, phrase, seen, specs)
    return _choose(builder, phrase, seen, specs)


def _new(builder: PlanBuilder, phrase: Phrase) -> Referent:
    """A thing that nobody has listed or seen, by its own words."""
    label = " ".join((*phrase.colours, phrase.singular or phrase.noun))
    thing = next((t for t in builder.world.objects if t.label == label), BelievedObject(label, "", seen=False))
    spots = builder.vocabulary.spot(phrase.anchor) if phrase.relation else []
    words = " ".join(without_determiners(tuple(phrase.text.split()))) if phrase.relation or phrase.which else ""
    return Referent(thing, words, spots[0] if spots and not spots[0].home else None)


def _never_seen(builder: PlanBuilder, phrase: Phrase) -> list[Referent]:
    """Of a kind whose word is known, but of which none is listed or seen: one is looked for, all are not."""
    if phrase.count != 1:
        builder.look_first(builder.vocabulary.surfaces(), f"I have seen no {phrase.singular} yet")
    if phrase.sense.kinds and phrase.singular in builder.vocabulary.groups:
        phrase = msgspec.structs.replace(phrase, singular=builder.choices.pick(sorted(phrase.sense.kinds)))
    return [_new(builder, phrase)]


def fitting(builder: PlanBuilder, phrase: Phrase) -> Callable[[BelievedObject], bool]:
    """Whether an object is of the kind, the names and the colours of a phrase, and none that it leaves out."""
    sense, colours, left_out = phrase.sense, phrase.colours, _left_out(builder, phrase)

    def fits(item: BelievedObject) -> bool:
        named = sense.every or item.label in sense.names or item.kind in sense.kinds
        return named and (not colours or any(map(item.is_of, colours))) and not left_out(item)

    return fits


def _left_out(builder: PlanBuilder, phrase: Phrase) -> Callable[[BelievedObject], bool]:
    """What the phrases after "except" mean.

    Raises:
        Refusal: one of them means nothing.
    """
    names, colours = set[str](), set[str]()
    for words in phrase.but:
        bare = [w for w in words if w not in DETERMINERS]
        if " ".join(words) in PRONOUNS | PLURAL_PRONOUNS:
            names |= {m.object.label for m in _pronoun(builder, " ".join(words) in PLURAL_PRONOUNS)}
            continue
        if all(w in builder.vocabulary.colours for w in bare):
            colours |= {builder.vocabulary.colours[w] for w in bare}
            continue
        meant = read(("all", *without_determiners(words)), builder.vocabulary)
        if not isinstance(meant, Phrase):
            raise Refusal(unknown(builder, words, meant))
        if meant.noun in ("one", "ones"):
            meant = msgspec.structs.replace(meant, sense=phrase.sense)
        names |= _labels(builder, meant)
    return lambda item: item.label in names or any(map(item.is_of, colours))


def _labels(builder: PlanBuilder, phrase: Phrase) -> set[str]:
    """Labels of everything that a phrase means."""
    fits = fitting(builder, phrase)
    known = [t for t in (*builder.world.objects, *builder.world.specs) if fits(t)]
    if phrase.relation and (spots := builder.vocabulary.spot(phrase.anchor)):
        names = {s.name for s in spots}
        known = [t for t in known if t.on in names or builder.world.room_of(t) in names]
    return {t.label for t in known}


def anchor_spots(builder: PlanBuilder, phrase: Phrase) -> list[Spot]:
    """The places that a phrase names behind its relation: `on the desk and the table` names two."""
    if spots := builder.vocabulary.spot(phrase.anchor):
        return spots
    for at, word in enumerate(phrase.anchor):
        if word in ("and", "or"):
            parts = [builder.vocabulary.spot(part) for part in (phrase.anchor[:at], phrase.anchor[at + 1 :])]
            return [s for part in parts for s in part] if all(parts) else []
    return []


def _related(
    builder: PlanBuilder, phrase: Phrase, seen: list[BelievedObject], specs: list[BelievedObject]
) -> list[Referent]:
    """Objects on, in, near or left of something."""
    spots = anchor_spots(builder, phrase)
    if phrase.relation == "on" and spots:
        names = {s.name for s in spots}
        there = [t for t in seen if t.on in names or (any(s.room for s in spots) and builder.world.room_of(t) in names)]
        place = spots[0]
        named = [s.receptacle for s in spots if s.receptacle]
        surfaces = named if place.receptacle else builder.vocabulary.surfaces(place.name)
        if phrase.count == 0:
            builder.look_at(surfaces)
        if there:
            return _choose(builder, phrase, there, specs)
        if phrase.count != 1 or phrase.sense.every:
            builder.look_first(surfaces, f"I have seen no {phrase.singular} there yet")
        return [_unseen(builder, phrase, specs, place)]
    if phrase.relation == "near" and spots:
        near = [t for t in seen if any(is_near(builder, t, s) for s in spots)]
        return _choose(builder, phrase, near, specs) if near else [_unseen(builder, phrase, specs, spots[0])]
    anchor = referent(builder, phrase.anchor).object
    placed = [t for t in seen if t.position and t.label != anchor.label]
    if anchor.position is None or not placed:
        raise Refusal(f"I have not seen which {phrase.noun} is {spoken(phrase.relation)} the {anchor.label}")
    beside = [t for t in placed if holds(builder, phrase.relation, t, anchor)]
    if phrase.relation == "near" and not beside:
        beside = [t for t in placed if t.on and t.on == anchor.on]
    if not beside:
        raise Refusal(f"I see no {phrase.noun} {spoken(phrase.relation)} the {anchor.label}")
    return (
        [Referent(min(beside, key=lambda t: between(t, anchor)))]
        if phrase.count == 1
        else [Referent(t) for t in beside]
    )


def _choose(
    builder: PlanBuilder, phrase: Phrase, seen: list[BelievedObject], specs: list[BelievedObject]
) -> list[Referent]:
    """From the candidates those that are meant."""
    if phrase.which == "other":
        seen = [t for t in seen if t.label not in {x.label for x in _mentioned(builder)}]
    if not seen:
        if phrase.count != 1:
            builder.look_first(builder.vocabulary.surfaces(), f"I have seen no {phrase.singular} yet")
        return [_unseen(builder, phrase, specs, None)]
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
    names = [t.label for t in sorted(near, key=lambda t: t.label)[:MAX_QUESTION]]
    if len(set(names)) == 1:
        return [Referent(near[0])]
    kinds = {t.kind for t in near}
    if len(kinds) == 1 and kinds == phrase.sense.kinds and not phrase.colours:
        # Perception will find several and the brain asks which one.
        kind, words = next(iter(kinds)), " ".join(without_determiners(tuple(phrase.text.split())))
        return [Referent(BelievedObject(label=kind, kind=kind, size=near[0].size), "" if words == kind else words)]
    raise Refusal(f"I do not know which one you mean: {enumeration([f'the {n}' for n in names], 'or')}")


def _unseen(builder: PlanBuilder, phrase: Phrase, specs: list[BelievedObject], at: Spot | None) -> Referent:
    """Something nobody has seen yet: by its name if the household has one of the kind, else any of the kind in view."""
    if not specs:
        raise Refusal(f"I have seen no {phrase.noun}")
    where = at if at is None or not at.home else None
    words = " ".join(without_determiners(tuple(phrase.text.split()))) if phrase.which or phrase.relation else ""
    if len(specs) == 1:
        return Referent(specs[0], at=where)
    preferred = [t for t in specs if t.label == phrase.sense.prefer]
    if preferred and not (phrase.colours or phrase.relation or phrase.which):
        return Referent(preferred[0])
    kinds = sorted({t.kind for t in specs})
    if phrase.colours or (len(kinds) > 1 and not phrase.any_one):
        names = enumeration([f"the {t.label}" for t in specs[:MAX_QUESTION]], "or")
        raise Refusal(f"I do not know which one you mean: {names}")
    kind = builder.choices.pick(kinds)
    return Referent(BelievedObject(label=kind, kind=kind, seen=False), words, where)
