"""Which things and which spots a phrase means, in the believed world. Pure."""

from collections.abc import Callable

import msgspec

from services.planner.draft import Draft, Refusal
from services.planner.forms import Words
from services.planner.phrases import PLURAL_PRONOUNS, PRONOUNS, Phrase, read
from services.planner.relations import away, between, holds, is_near, spoken, superlative
from services.planner.vocabulary import DETERMINERS, Spot, bare
from services.planner.words import listed
from services.planner.world import Thing

MAX_QUESTION = 4
LONGEST_NAME = 4


class Meant(msgspec.Struct, frozen=True):
    """A thing that is meant; `words` where its name alone does not tell; `at` where to look for it first."""

    thing: Thing
    words: str = ""
    at: Spot | None = None


def things(draft: Draft, words: Words, prefer_held: bool = False) -> list[Meant]:
    """Everything that is meant, at least one.

    Raises:
        Refusal: nothing of that name, or several and no way to tell which.
    """
    pronoun = " ".join(words)
    if pronoun in PRONOUNS or pronoun in PLURAL_PRONOUNS:
        return _pronoun(draft, pronoun in PLURAL_PRONOUNS)
    phrase = read(words, draft.vocabulary)
    if isinstance(phrase, Phrase):
        return _resolve(draft, phrase, prefer_held)
    for at in range(1, len(words) - 1):
        if words[at] == "and":
            try:
                return [*things(draft, words[:at], prefer_held), *things(draft, words[at + 1 :], prefer_held)]
            except Refusal:
                continue
    raise Refusal(unknown(draft, words, phrase))


def one(draft: Draft, words: Words, prefer_held: bool = False) -> Meant:
    """The single thing that is meant."""
    meant = things(draft, words, prefer_held)
    if len(meant) > 1:
        raise Refusal("I can only do that with one thing at a time")
    return meant[0]


def spot(draft: Draft, words: Words) -> Spot:
    """The place that is meant.

    Raises:
        Refusal: no such place, or several.
    """
    if " ".join(words) in ("there", "it", "that") and draft.spot is not None:
        return draft.spot
    nearest = words[-2:-1] if words[:1] == ("the",) and len(words) == 3 else ()
    wanted = words[2:] if nearest and nearest[0] in ("nearest", "closest") else words
    found = draft.vocabulary.spot(wanted)
    if not found:
        furniture = draft.vocabulary.furniture(words)
        phrase = read(words, draft.vocabulary)
        if furniture or isinstance(phrase, Phrase):
            raise Refusal(f"the {furniture or ' '.join(bare(words))} is no place that I can use")
        raise Refusal(f"I know no {' '.join(bare(words))}")
    if len(found) > 1 and wanted is not words:
        return min(found, key=lambda s: away(draft, s))
    if len(found) > 1:
        raise Refusal(f"I do not know which one you mean: {listed([f'the {s.name}' for s in found], 'or')}")
    return found[0]


def unknown(draft: Draft, words: Words, noun: str) -> str:
    """Why a phrase means nothing, with what there is instead."""
    if len(noun.split()) > LONGEST_NAME or DETERMINERS & set(noun.split()):
        return f"I do not understand {' '.join(words)!r}"
    *front, last = noun.split() or [""]
    known = draft.vocabulary.noun(last)
    if front and known is not None and not known[0].every:
        names = [t.label for t in draft.world.specs if t.kind in known[0].kinds or t.label in known[0].names]
        if names:
            return f"I know no {noun}, only {listed([f'the {n}' for n in names[:MAX_QUESTION]])}"
    if furniture := draft.vocabulary.furniture(words):
        return f"I cannot pick up the {noun or furniture}"
    if draft.vocabulary.spot(words):
        return f"I cannot pick up the {noun}"
    return f"I know no {noun}" if noun else "I did not hear which thing you mean"


def _pronoun(draft: Draft, plural: bool) -> list[Meant]:
    if draft.last:
        return [Meant(draft.world.current(t)) for t in (draft.last if plural else draft.last[-1:])]
    if held := draft.world.held:
        return [Meant(held)]
    raise Refusal("I do not know what you mean by that" if plural else "I do not know what you mean by it")


def _resolve(draft: Draft, phrase: Phrase, prefer_held: bool) -> list[Meant]:
    sense = phrase.sense
    if sense.every and phrase.noun in ("one", "ones") and draft.last:
        sense = msgspec.structs.replace(sense, every=False, kinds=frozenset(t.kind for t in draft.last))
        phrase = msgspec.structs.replace(phrase, sense=sense)
    fits = _fitting(phrase)
    held = draft.world.held
    if prefer_held and held and fits(held) and not phrase.relation and not phrase.which and phrase.count == 1:
        return [Meant(held)]
    seen = [t for t in draft.world.things if fits(t) and not t.held]
    if held and fits(held) and not phrase.relation and phrase.which != "other":
        seen = [held, *seen]
    specs = [t for t in draft.world.specs if fits(t)]
    if not seen and not specs:
        raise Refusal(unknown(draft, tuple(phrase.text.split()), " ".join((*phrase.colours, phrase.noun))))
    if phrase.relation:
        return _related(draft, phrase, seen, specs)
    return _choose(draft, phrase, seen, specs)


def _fitting(phrase: Phrase) -> Callable[[Thing], bool]:
    sense, colours = phrase.sense, phrase.colours

    def fits(thing: Thing) -> bool:
        named = sense.every or thing.label in sense.names or thing.kind in sense.kinds
        return named and (not colours or thing.colour in colours)

    return fits


def _related(draft: Draft, phrase: Phrase, seen: list[Thing], specs: list[Thing]) -> list[Meant]:
    """Things on, in, near or left of something."""
    spots = draft.vocabulary.spot(phrase.anchor)
    if phrase.relation == "on" and spots:
        names = {s.name for s in spots}
        there = [t for t in seen if t.on in names or (any(s.room for s in spots) and draft.world.room_of(t) in names)]
        place = spots[0]
        surfaces = [place.receptacle] if place.receptacle else draft.vocabulary.surfaces(place.name)
        if phrase.count == 0:
            draft.look_at(surfaces)
        if there:
            return _choose(draft, phrase, there, specs)
        if phrase.count != 1 or phrase.sense.every:
            draft.look_first(surfaces, f"I have seen no {phrase.singular} there yet")
        return [_unseen(draft, phrase, specs, place)]
    if phrase.relation == "near" and spots:
        near = [t for t in seen if any(is_near(draft, t, s) for s in spots)]
        return _choose(draft, phrase, near, specs) if near else [_unseen(draft, phrase, specs, spots[0])]
    anchor = one(draft, phrase.anchor).thing
    placed = [t for t in seen if t.position and t.label != anchor.label]
    if anchor.position is None or not placed:
        raise Refusal(f"I have not seen which {phrase.noun} is {spoken(phrase.relation)} the {anchor.label}")
    beside = [t for t in placed if holds(draft, phrase.relation, t, anchor)]
    if not beside:
        raise Refusal(f"I see no {phrase.noun} {spoken(phrase.relation)} the {anchor.label}")
    return [Meant(min(beside, key=lambda t: between(t, anchor)))] if phrase.count == 1 else [Meant(t) for t in beside]


def _choose(draft: Draft, phrase: Phrase, seen: list[Thing], specs: list[Thing]) -> list[Meant]:
    """From the candidates those that are meant."""
    if phrase.which == "other":
        seen = [t for t in seen if t.label not in {x.label for x in draft.last}]
    if not seen:
        if phrase.count != 1:
            draft.look_first(draft.vocabulary.surfaces(), f"I have seen no {phrase.singular} yet")
        return [_unseen(draft, phrase, specs, None)]
    if phrase.which and phrase.which != "other":
        return [Meant(superlative(draft, phrase, seen))]
    near = sorted(seen, key=lambda t: (not t.held, draft.world.distance(t), t.label))
    if phrase.count != 1:
        if phrase.count > len(near):
            raise Refusal(f"I know of only {len(near)} of the {phrase.count} {phrase.noun}")
        return [Meant(t) for t in (near[: phrase.count] if phrase.count else near)]
    if len(near) == 1 or phrase.any_one:
        return [Meant(draft.choices.pick(near))]
    preferred = [t for t in near if t.label == phrase.sense.prefer]
    if preferred and not phrase.colours and not phrase.relation:
        return [Meant(preferred[0])]
    names = [t.label for t in sorted(near, key=lambda t: t.label)[:MAX_QUESTION]]
    if len(set(names)) == 1:
        return [Meant(near[0])]
    kinds = {t.kind for t in near}
    if len(kinds) == 1 and kinds == phrase.sense.kinds and not phrase.colours:
        # Perception will find several and the brain asks which one.
        kind, words = next(iter(kinds)), " ".join(bare(tuple(phrase.text.split())))
        return [Meant(Thing(label=kind, kind=kind, size=near[0].size), "" if words == kind else words)]
    raise Refusal(f"I do not know which one you mean: {listed([f'the {n}' for n in names], 'or')}")


def _unseen(draft: Draft, phrase: Phrase, specs: list[Thing], at: Spot | None) -> Meant:
    """Something nobody has seen yet: by its name if the scene has one of the kind, else any of the kind in view."""
    if not specs:
        raise Refusal(f"I have seen no {phrase.noun}")
    where = at if at is None or not at.home else None
    words = " ".join(bare(tuple(phrase.text.split()))) if phrase.which or phrase.relation else ""
    if len(specs) == 1:
        return Meant(specs[0], at=where)
    preferred = [t for t in specs if t.label == phrase.sense.prefer]
    if preferred and not (phrase.colours or phrase.relation or phrase.which):
        return Meant(preferred[0])
    kinds = sorted({t.kind for t in specs})
    if phrase.colours or (len(kinds) > 1 and not phrase.any_one):
        names = listed([f"the {t.label}" for t in specs[:MAX_QUESTION]], "or")
        raise Refusal(f"I do not know which one you mean: {names}")
    kind = draft.choices.pick(kinds)
    return Meant(Thing(label=kind, kind=kind, seen=False), words, where)
