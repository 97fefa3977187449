"""Reference resolution: the objects of the believed world that a phrase means. Pure."""

import msgspec

from common.kinds import KINDS
from common.language.normalise import DETERMINERS, Words, enumeration, without_determiners
from common.language.noun_phrase import NUMBERS, PLURAL_PRONOUNS, PRONOUNS, Which
from services.planner.grammar.phrases import Phrase, read
from services.planner.grammar.senses import Sense, is_alive
from services.planner.plan_builder import Lost, PlanBuilder, Refusal
from services.planner.reference.choosing import choose, unseen
from services.planner.reference.fits import fitting, unknown
from services.planner.reference.places import anchor_spots
from services.planner.reference.pronouns import Referent, mentioned, pronoun
from services.planner.reference.relations import between, holds, is_between, is_near, spoken
from services.planner.world import BelievedObject


def referents(builder: PlanBuilder, words: Words, prefer_held: bool = False) -> list[Referent]:
    """Everything that is meant, at least one.

    Raises:
        Refusal: nothing of that name, or several and no way to tell which.
    """
    said = " ".join(words)
    if said in PRONOUNS or said in PLURAL_PRONOUNS:
        return pronoun(builder, said in PLURAL_PRONOUNS)
    phrase = read(words, builder.vocabulary)
    if isinstance(phrase, Phrase):
        return _resolve(builder, phrase, prefer_held)
    words = words[1:] if words[0] in ("both", "either") else words  # "both the mug and the can"
    if "or" in words[1:-1]:
        at = words.index("or", 1)
        options = [referents(builder, part, prefer_held) for part in (words[:at], words[at + 1 :])]
        return builder.choices.pick(options)
    if (name := _name_of_both(builder, words)) is not None:
        return [_new(builder, name)]
    for at in range(1, len(words) - 1):
        if words[at] == "and":
            if _is_named(builder, words[:at]) and not _is_named(builder, words[at + 1 :]):
                continue
            try:
                if shared := _shared_place(builder, words[:at], words[at + 1 :]):
                    return [*referents(builder, shared, prefer_held), *referents(builder, words[at + 1 :], prefer_held)]
                return [*referents(builder, words[:at], prefer_held), *referents(builder, words[at + 1 :], prefer_held)]
            except Refusal:
                continue
    for at in range(2, len(words) - 1):  # "the mug the can and the ball", as a recogniser writes it
        if words[at] in _NEW_PHRASE and all(_is_plain(builder, part) for part in (words[:at], words[at:])):
            return [*referents(builder, words[:at], prefer_held), *referents(builder, words[at:], prefer_held)]
    raise unknown(builder, words, phrase)


def _shared_place(builder: PlanBuilder, one: Words, other: Words) -> Words:
    """`the can from the dresser` of `the can and bottle from the dresser`; () where the place is of one alone."""
    if not other or other[0] in DETERMINERS or other[0] in NUMBERS:
        return ()
    first, second = read(one, builder.vocabulary), read(other, builder.vocabulary)
    if not isinstance(first, Phrase) or not isinstance(second, Phrase) or first.relation or not second.relation:
        return ()
    return (*one, "on", *second.anchor) if second.relation == "on" else ()


_NEW_PHRASE = (DETERMINERS | NUMBERS.keys()) - {"couple", "this", "that"}
"""Words with which the next thing of an enumeration begins."""


def _is_plain(builder: PlanBuilder, words: Words) -> bool:
    """Do the words name something known, and not which of its kind it is?"""
    phrase = read(words, builder.vocabulary)
    return isinstance(phrase, Phrase) and not phrase.sense.new and phrase.noun not in ("one", "ones")


def _is_named(builder: PlanBuilder, words: Words) -> bool:
    """Do the words begin like a name, or name something known? `dance` of `the red mug and dance` does not."""
    phrase = read(words, builder.vocabulary)
    known = words[0] in DETERMINERS or words[-1] in builder.world.household.words.looks
    return not isinstance(phrase, Phrase) or not phrase.sense.new or known


def _name_of_both(builder: PlanBuilder, words: Words) -> Phrase | None:
    """`the macaroni and cheese`, one thing that nobody has listed: only the last word is one that has looks, and no
    determiner stands before it. `The salt and pepper` are two things."""
    at = words.index("and") if words.count("and") == 1 else 0
    if not builder.vocabulary.new_nouns or not 0 < at < len(words) - 1 or words[at + 1] in DETERMINERS:
        return None
    one, other = read(words[:at], builder.vocabulary), read(words[at + 1 :], builder.vocabulary)
    if not isinstance(one, Phrase) or not isinstance(other, Phrase) or not (one.sense.new and other.sense.new):
        return None
    looks = builder.world.household.words.looks
    if one.noun.split()[-1] in looks or words[-1] not in looks:
        return None
    noun = f"{one.noun} and {other.noun}"
    sense = Sense(names=frozenset({noun}), new=True)
    return msgspec.structs.replace(one, sense=sense, noun=noun, text=" ".join(words))


def referent(builder: PlanBuilder, words: Words, prefer_held: bool = False) -> Referent:
    """The single object that is meant."""
    meant = referents(builder, words, prefer_held)
    if len(meant) > 1:
        raise Refusal("I can only do that with one thing at a time")
    return meant[0]


def _resolve(builder: PlanBuilder, phrase: Phrase, prefer_held: bool) -> list[Referent]:
    sense = phrase.sense
    if sense.every and phrase.noun in ("one", "ones") and (before := mentioned(builder)):
        which = phrase.colours or phrase.which or phrase.relation or len(before) == 1
        kinds, names = (frozenset(t.kind for t in before), ()) if which else ((), frozenset(t.label for t in before))
        sense = msgspec.structs.replace(sense, every=False, kinds=frozenset(kinds), names=frozenset(names))
        phrase = msgspec.structs.replace(phrase, sense=sense, any_one=phrase.any_one or phrase.text == "one")
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
    nameable = phrase.noun not in ("one", "ones") and (phrase.colours or not sense.every)
    if not seen and not specs and builder.vocabulary.new_nouns and nameable:
        return _never_seen(builder, phrase)
    if not seen and not specs:
        raise unknown(builder, tuple(phrase.text.split()), " ".join((*phrase.colours, phrase.noun)))
    if phrase.relation:
        return _related(builder, phrase, seen, specs)
    return choose(builder, phrase, seen, specs)


def _new(builder: PlanBuilder, phrase: Phrase) -> Referent:
    """A thing that nobody has listed or seen, by its own words."""
    label = " ".join((*phrase.colours, phrase.singular or phrase.noun))
    if is_alive(tuple(phrase.noun.split())):
        raise Refusal("I pick up neither people nor animals, and I do not look for them")
    spots = builder.vocabulary.spot(phrase.anchor) if phrase.relation else []
    if "the" in phrase.anchor[1:] and not spots:
        raise Lost(f"I know no {phrase.text}")  # "my books from the desk the one with the vitamins"
    thing = next((t for t in builder.world.objects if t.label == label), BelievedObject(label, "", seen=False))
    words = " ".join(without_determiners(tuple(phrase.text.split()))) if phrase.relation or phrase.which else ""
    if spots and spots[0].receptacle:  # "on the counter in the kitchen" by the one name that all know
        words = f"{words.removesuffix(' '.join(phrase.anchor))}the {spots[0].name}"
    return Referent(thing, words, spots[0] if spots and not spots[0].home else None)


def _never_seen(builder: PlanBuilder, phrase: Phrase) -> list[Referent]:
    """Of a kind whose word is known, or of a colour, but of which none is listed or seen: one is looked for, all are
    not.
    """
    if phrase.count != 1:
        builder.look_first(builder.vocabulary.surfaces(), f"I have seen no {phrase.singular} yet")
    if phrase.sense.kinds and phrase.singular in builder.vocabulary.groups and phrase.singular not in KINDS:
        phrase = msgspec.structs.replace(phrase, singular=builder.choices.pick(sorted(phrase.sense.kinds)))
    return [_new(builder, phrase)]


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
            return choose(builder, phrase, there, specs)
        if phrase.count != 1 or phrase.sense.every:
            builder.look_first(surfaces, f"I have seen no {phrase.singular} there yet")
        return [unseen(builder, phrase, specs, place)]
    if phrase.relation == "on" and (furniture := builder.vocabulary.furniture(phrase.anchor)):
        there = [t for t in seen if t.on == furniture]  # on a bed, which nobody lists as a surface
        return choose(builder, phrase, there, specs) if there else [unseen(builder, phrase, specs, None)]
    if phrase.relation == "near" and spots:
        near = [t for t in seen if any(is_near(builder, t, s) for s in spots)]
        return choose(builder, phrase, near, specs) if near else [unseen(builder, phrase, specs, spots[0])]
    if phrase.relation == "between":
        return _between(builder, phrase, seen)
    if spots and spots[0].receptacle and phrase.relation in ("left of", "right of"):  # of a surface: at that end of it
        there = [t for t in seen if t.on == spots[0].name]
        side: Which = "left" if phrase.relation == "left of" else "right"
        at_end = msgspec.structs.replace(phrase, which=side, side=side, relation="on")
        return choose(builder, at_end, there, specs) if there else [unseen(builder, at_end, specs, spots[0])]
    anchor = referent(builder, phrase.anchor).object
    placed = [t for t in seen if t.position and t.label != anchor.label]
    if anchor.position is None or not placed:
        raise Refusal(f"I have not seen which {phrase.noun} is {spoken(phrase.relation)} the {anchor.label}")
    if phrase.relation != "near" and anchor.on:  # to the left of a thing is what stands there on the same surface
        placed = [t for t in placed if t.on in (anchor.on, anchor.label)]
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


def _between(builder: PlanBuilder, phrase: Phrase, seen: list[BelievedObject]) -> list[Referent]:
    """What stands between two things, or two of a kind."""
    ends = [m.object for m in referents(builder, phrase.anchor)]
    if len(ends) != 2:
        raise Refusal(f"I do not know between which two things the {phrase.noun} is")
    missing = next((t for t in ends if t.position is None), None)
    if missing is not None:
        raise Refusal(f"I have not seen where the {missing.label} is")
    labels = {t.label for t in ends}
    there = [t for t in seen if t.label not in labels and is_between(t, ends[0], ends[1])]
    if not there:
        raise Refusal(f"I see no {phrase.noun} between the {ends[0].label} and the {ends[1].label}")
    if len(there) > 1 and phrase.count == 1:
        names = enumeration([f"the {t.label}" for t in there], "or")
        raise Lost(f"I do not know which one you mean: {names}")
    return [Referent(t) for t in there]
