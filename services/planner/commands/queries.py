"""Answers from the known world, each an operation on sets of things and of places that words name. Pure."""

import re

from common.language.normalise import enumeration
from common.language.pattern import Slots
from services.planner.commands.telling import MANY, a, be, capital, not_after_moving, place_of
from services.planner.grammar.phrases import Phrase, read
from services.planner.plan_builder import PlanBuilder, Refusal
from services.planner.reference.fits import fitting
from services.planner.reference.places import spot
from services.planner.reference.relations import holds, is_between
from services.planner.reference.resolve import referent
from services.planner.world import BelievedObject

_FEW = {"no", "nothing", "the least", "least", "the fewest", "fewest", "the fewest things", "the least things"}


def _things(builder: PlanBuilder, text: str) -> list[BelievedObject]:
    """Everything seen that words mean, with a place behind them or without: `mugs not in the kitchen`.

    Raises:
        Refusal: the words mean nothing of the kind.
    """
    bare = re.sub(r"^(?:(?:any|all|every|more|of|the|your|my|our) )*", "", re.sub(r"\bnothing\b", "anything", text))
    words = tuple(re.sub(r" (?:are|is)(?: there)?(?= )", "", bare).split())
    phrase = read(("all", *words), builder.vocabulary) if words else ""
    phrase = phrase if isinstance(phrase, Phrase) else read(words, builder.vocabulary)
    spots = builder.vocabulary.spot(phrase.anchor) if isinstance(phrase, Phrase) and phrase.relation == "on" else []
    if not isinstance(phrase, Phrase) or (phrase.relation and not spots):
        raise Refusal(f"I know no {text}")
    if phrase.sense.new and not builder.vocabulary.new_nouns:
        raise Refusal(f"I know no {text}")
    fits, names = fitting(builder, phrase), {s.name for s in spots}
    known = [t for t in builder.world.objects if t.seen and not t.held and fits(t)]
    return [t for t in known if not names or {t.on, builder.world.room_of(t)} & names]


def _places(builder: PlanBuilder, kind: str) -> list[str]:
    """Names of the rooms, of the surfaces of a kind, or of all of them."""
    kind = {"shelves": "shelf"}.get(kind, kind.removesuffix("s"))
    household = builder.world.household
    if kind == "room":
        return [room.name for room in household.rooms]
    return [r.name for r in household.receptacles if kind in ("surface", "place", r.kind, *r.name.split())]


def _named(things: list[BelievedObject]) -> str:
    return enumeration([f"the {t.label}" for t in things])


def where(builder: PlanBuilder, found: re.Match[str]) -> str:
    """Which places have some, none, the most or the fewest of something."""
    wanted = found["few"] or found["many"] or ""
    what = found["what"] or "anything"
    wanted = "nothing" if found["empty"] else wanted
    those = _things(builder, f"anything {what}" if wanted == "nothing" and found["what"] else what)
    names = _places(builder, found["kind"])
    if found["options"]:
        parts = re.split(r" or ", found["options"])
        names = [s.name for part in parts for s in builder.vocabulary.spot(tuple(part.split()))]
    counts = {name: sum(name in (t.on, builder.world.room_of(t)) for t in those) for name in names}
    if not counts:
        raise Refusal("there is no such place")
    if wanted in ("no", "nothing"):
        best = [name for name, count in counts.items() if not count]
    elif not wanted:
        best = [name for name, count in counts.items() if count]
    else:
        most = (min if wanted in _FEW else max)(counts.values())
        best = [name for name, count in counts.items() if count == most]
    known = ", as far as I know" if wanted in _FEW else ""
    return f"{capital(enumeration([f'the {name}' for name in best]))}{known}." if best else "None that I know of."


def compared(builder: PlanBuilder, found: re.Match[str]) -> str:
    """Of which of two kinds there are more."""
    one, other = (len(_things(builder, found[name])) for name in ("one", "other"))
    if one == other:
        return f"There are as many {found['one']} as {found['other']}: {one}."
    more, fewer = ("one", "other") if one > other else ("other", "one")
    return f"There are more {found[more]} than {found[fewer]}: {max(one, other)} against {min(one, other)}."


def side(builder: PlanBuilder, found: re.Match[str]) -> str:
    """On which side of a thing another one stands."""
    anchor, item = (_one(builder, found[name]) for name in ("anchor", "item"))
    if not (anchor.position and item.position and anchor.on == item.on):
        return f"The {item.label} does not stand beside the {anchor.label}."
    side = "left" if holds(builder, "left of", item, anchor) else "right"
    return f"The {item.label} is to the {side} of the {anchor.label}."


def company(builder: PlanBuilder, found: re.Match[str]) -> str:
    """What else stands where a thing does."""
    item = _one(builder, found["item"])
    others = [t for t in builder.world.objects if item.on and t.on == item.on and t.label != item.label]
    if not others:
        return f"I know of nothing else where the {item.label} is."
    return f"{capital(enumeration([a(t) for t in others]))} {be(others)} there with the {item.label}."


def listed(builder: PlanBuilder, found: re.Match[str]) -> str:
    """Everything that fits a description, where it is."""
    known = _things(builder, found["what"])[:MANY]
    told = enumeration([f"the {t.label} {place_of(builder, t)}" for t in known])
    return f"{capital(told)}." if known else f"I know of no {found['what']}."


def beside_what(builder: PlanBuilder, found: re.Match[str]) -> str:
    """What is somewhere, apart from what is left out."""
    left_out = {t.label for t in _things(builder, found["but"])}
    there = [t for t in _things(builder, f"things {found['where']}") if t.label not in left_out]
    return f"{capital(enumeration([a(t) for t in there]))}." if there else "Nothing else that I know of."


def counted(builder: PlanBuilder, found: re.Match[str]) -> str:
    """How many there are."""
    if found["what"] in ("tables", "shelves", "bins", "rooms"):
        places = _places(builder, found["what"])
        return f"I know of {len(places)} {found['what']}: {enumeration([f'the {name}' for name in places])}."
    return f"I know of {_number(builder, found['what'], _things(builder, found['what']))}."


def number(builder: PlanBuilder, slots: Slots) -> None:
    """How many there are; a count of all of them is the same after some have been moved."""
    if "spot" in slots:
        not_after_moving(builder)
    what = " ".join((*slots["thing"], *(("on", *slots["spot"]) if "spot" in slots else ())))
    builder.say(f"I know of {_number(builder, what, _things(builder, what))}.")


def _number(builder: PlanBuilder, what: str, known: list[BelievedObject]) -> str:
    """`2 mugs: the red mug and the blue mug`."""
    names = f": {_named(known)}" if 0 < len(known) <= MANY else ""
    noun = re.sub(r"^(?:the|my|our|your) | (?:are|is|in|on|at|not) .*$", "", what)
    phrase = read(tuple(noun.split()), builder.vocabulary)
    if len(known) == 1 and isinstance(phrase, Phrase) and phrase.singular:
        noun = " ".join((*phrase.colours, phrase.singular))
    return f"{len(known) or 'no'} {noun}{names}"


def between(builder: PlanBuilder, found: re.Match[str]) -> str:
    """Does a thing stand between two others?"""
    item, one, other = (_one(builder, found[name]) for name in ("item", "one", "other"))
    said = "Yes" if is_between(item, one, other) else "No"
    return f"{said}, the {item.label} is {place_of(builder, item)}."


def measured(builder: PlanBuilder, found: re.Match[str]) -> str:
    """How tall and wide a thing is."""
    item = _one(builder, found["item"])
    if not any(item.size):
        raise Refusal(f"I have not seen how big the {item.label} is")
    wide, tall = (round(100 * length) for length in (max(item.size[:2]), item.size[2]))
    return f"The {item.label} is {tall} centimetres tall and {wide} wide."


def called(builder: PlanBuilder, found: re.Match[str]) -> str:
    """What else a thing is called."""
    item = _one(builder, found["item"])
    if not item.names:
        return f"I call it the {item.label}."
    return f"You call the {item.label} {enumeration([f'the {name}' for name in sorted(item.names)])}."


def near(builder: PlanBuilder, found: re.Match[str]) -> str:
    """Does a thing stand next to another one?"""
    item, other = _one(builder, found["item"]), _one(builder, found["other"])
    said = "Yes" if holds(builder, "near", item, other) else "No"
    return f"{said}, the {item.label} is {place_of(builder, item)}."


def counted_there(builder: PlanBuilder, found: re.Match[str]) -> str:
    """How many there are in all, or where something was put just now."""
    known = _things(builder, found["what"])
    if found["there"]:
        name = spot(builder, ("there",)).name
        known = [t for t in known if name in (t.on, builder.world.room_of(t))]
    return f"{capital(_number(builder, found['what'], known))}."


def _one(builder: PlanBuilder, text: str) -> BelievedObject:
    """The thing that is asked about, which has been seen.

    Raises:
        Refusal: there is none, or it has not been seen.
    """
    item = referent(builder, tuple(text.split()), prefer_held=True).object
    if not item.seen:
        raise Refusal(f"I have not seen the {item.label}")
    return item
