"""What the robot says about what it has seen. Pure."""

from common.floor_plan import Receptacle
from common.language.exchange import PREPOSITIONS
from common.language.normalise import Words, enumeration, without_determiners
from common.language.noun_phrase import PLURAL_PRONOUNS, PRONOUNS, WHICH, related
from common.language.pattern import Slots
from common.messages import AROUND, PlanStep
from services.planner.phrases import Phrase, read
from services.planner.plan_builder import NOT_UNDERSTOOD, PlanBuilder, Refusal
from services.planner.relations import between, holds, spoken
from services.planner.resolve import Referent, fitting, referent, referents, spot, unknown
from services.planner.vocabulary import ANY, Spot
from services.planner.world import BelievedObject

MANY = 8
"""Objects told at once (chosen: more nobody listens to)."""
MAX_BESIDE = 3
"""Neighbours told at once (chosen)."""


def seen(builder: PlanBuilder, slots: Slots) -> None:
    """What is in view, and what was seen before."""
    _not_after_moving(builder)
    fresh = [t for t in builder.world.objects if not t.held and builder.world.now - t.seen_at <= builder.config.fresh]
    if fresh:
        builder.say(f"I see {_inventory(builder, fresh)}.")
        return
    known = [t for t in builder.world.objects if not t.held]
    if known:
        builder.say(f"From here I see nothing that I know. I remember {_inventory(builder, known)}.")
    else:
        builder.say("I have seen nothing that I know yet.")


def recall(builder: PlanBuilder, slots: Slots) -> None:
    """What was seen on a surface or in a room; a look is taken only when nothing was."""
    _not_after_moving(builder)
    place, there, look = things_at(builder, slots["spot"])
    if not there:
        builder.look_at(look)
        builder.look_first(look, f"I have seen nothing there so far, so I would have to go to the {place.name} first")
    builder.say(_told(there, place))


def contents(builder: PlanBuilder, slots: Slots) -> None:
    """All that is on a surface or in a room, which is looked at first."""
    _not_after_moving(builder)
    place, there, look = things_at(builder, slots["spot"])
    builder.look_at(look)
    if not there:
        builder.look_first(look, f"I have seen nothing there so far, so I would have to go to the {place.name} first")
    builder.say(_told(there, place))


def things_at(builder: PlanBuilder, words: Words) -> tuple[Spot, list[BelievedObject], list[Receptacle]]:
    """The place that is meant, what was seen there, and the surfaces to look at for more."""
    place = spot(builder, words)
    if place.receptacle is not None:
        there = [t for t in builder.world.objects if t.on == place.name]
        look = [place.receptacle]
    else:
        there = [t for t in builder.world.objects if not t.held and builder.world.room_of(t) == place.name]
        look = builder.vocabulary.surfaces(place.name)
    return place, there, look


def _told(there: list[BelievedObject], place: Spot) -> str:
    where = "in" if place.receptacle is None or place.receptacle.depth else "on"
    return f"{_capital(enumeration([_a(t) for t in there]))} {_be(there)} {where} the {place.name}."


def holding(builder: PlanBuilder, slots: Slots) -> None:
    _not_after_moving(builder)
    held = builder.world.held
    builder.say(f"I am holding the {held.label}." if held else "My hand is empty.")


def whereabouts(builder: PlanBuilder, slots: Slots) -> None:
    _not_after_moving(builder)
    x, y, _ = builder.world.pose
    room = builder.world.household.room_at(x, y)
    builder.say(f"I am in the {room.name}." if room else "I do not know which room I am in.")


def where(builder: PlanBuilder, slots: Slots) -> None:
    """Where something is; what nobody has seen is looked for."""
    phrase = read(slots["thing"], builder.vocabulary)
    named = isinstance(phrase, Phrase) or " ".join(slots["thing"]) in PRONOUNS | PLURAL_PRONOUNS
    for meant in _all_meant(builder, slots) if named else ():
        item = meant.object
        if item.held:
            builder.say(f"The {item.label} is in my hand.")
        elif item.seen and (item.position or item.on):
            builder.say(f"The {item.label} is {place_of(builder, item)}.")
        else:
            builder.search_first([PlanStep(action="find", object=item.label, text=meant.words)])
            builder.find(item, meant.words)
            builder.say(f"I have found the {item.label}.")
        builder.last = [item]
    if not named and isinstance(phrase, str):
        if builder.vocabulary.spot(slots["thing"]):
            _place(builder, slots)
            return
        raise Refusal(unknown(builder, slots["thing"], phrase))


def found(builder: PlanBuilder) -> None:
    """Who only asked to find things is told where they are, once they were looked for."""
    if builder.done is None:
        return
    builder.search_first(builder.steps)
    told: list[BelievedObject] = []
    for step in builder.steps:
        alike = [t for t in builder.world.objects if t.seen and not t.held and step.object in (t.label, t.kind)]
        told += [max(alike, key=lambda t: t.seen_at)] if alike else []
    if told and len(told) == len(builder.steps):
        builder.steps.clear()
        for item in told:
            builder.say(f"The {item.label} is {place_of(builder, item)}.")


def _all_meant(builder: PlanBuilder, slots: Slots) -> list[Referent]:
    """For "where is the mug" every mug that was seen."""
    meant = referents(builder, slots["thing"], prefer_held=True)
    several = [t for t in builder.world.objects if t.kind == meant[0].object.label != t.label]
    return referents(builder, ("all", *without_determiners(slots["thing"]))) if len(meant) == 1 and several else meant


def number(builder: PlanBuilder, slots: Slots) -> None:
    _not_after_moving(builder)
    words = (*slots["thing"], "on", *slots["spot"]) if "spot" in slots else slots["thing"]
    phrase = read(words, builder.vocabulary)
    if not isinstance(phrase, Phrase):
        raise Refusal(unknown(builder, words, phrase))
    try:
        known = [m.object for m in referents(builder, ("all", *words)) if m.object.seen]
    except Refusal:
        known = []
    names = f": {enumeration([f'the {t.label}' for t in known])}" if 0 < len(known) <= MANY else ""
    builder.say(f"I know of {len(known) or 'no'} {phrase.noun}{names}.")


def colour(builder: PlanBuilder, slots: Slots) -> None:
    """What colours something has."""
    _not_after_moving(builder)
    for meant in referents(builder, slots["thing"], prefer_held=True):
        item = meant.object
        colours = [item.colour, *sorted(item.colours - {item.colour})] if item.colour else []
        if not colours:
            raise Refusal(f"I have not seen what colour the {item.label} has")
        builder.say(f"The {item.label} is {enumeration(colours)}.")
        builder.last = [item]


def extreme(builder: PlanBuilder, slots: Slots) -> None:
    """Which of several is the biggest, the nearest or the leftmost."""
    _not_after_moving(builder)
    words, noun = without_determiners(slots["words"]), without_determiners(slots.get("thing", ()))
    if noun and words[:1] and words[0] in PREPOSITIONS:  # which mug is on the desk
        asked: Words = ("the", *noun, *words)
    elif words and words[0] in WHICH and (not noun or len(words) == 1):  # which mug is the biggest
        asked = ("the", *words, *noun)
    elif not noun and len(words) > 1 and ANY & set(words):  # what is the red thing on the desk
        asked = ("the", *words)
    else:
        raise Refusal(f"{NOT_UNDERSTOOD} {' '.join(slots['words'])!r}")
    meant = referent(builder, asked).object
    if not meant.seen:
        raise Refusal(f"I have not seen that {' '.join(noun) or 'thing'}")
    builder.say(f"The {meant.label}. It is {place_of(builder, meant)}.")
    builder.last = [meant]


def beside(builder: PlanBuilder, slots: Slots) -> None:
    """What stands next to, left of or behind something."""
    _not_after_moving(builder)
    for _, relation, words in related(("thing", *slots["words"])):
        anchor = referent(builder, words).object
        others = [t for t in builder.world.objects if t.label != anchor.label and t.position and not t.held]
        if anchor.position is None:
            raise Refusal(f"I have not seen where the {anchor.label} is")
        same = [t for t in others if t.on == anchor.on and holds(builder, relation, t, anchor)]
        near = sorted(same, key=lambda t: between(t, anchor))[:MAX_BESIDE]
        where = f"{spoken(relation)} the {anchor.label}"
        builder.say(
            f"{_capital(enumeration([_a(t) for t in near]))} {_be(near)} {where}."
            if near
            else f"I see nothing {where}."
        )
        return
    raise Refusal(f"I do not understand {' '.join(slots['words'])!r}")


def check(builder: PlanBuilder, slots: Slots) -> None:
    """Go and look whether something is there, and tell."""
    thing = slots["thing"]
    phrase = read((*thing, "on", *slots["spot"]) if "spot" in slots else thing, builder.vocabulary)
    if not isinstance(phrase, Phrase):
        raise Refusal(unknown(builder, thing, phrase))
    spots = builder.vocabulary.spot(phrase.anchor) if phrase.relation in ("on", "near") else []
    if not spots:
        where(builder, slots)
        return
    place, known, surfaces = things_at(builder, phrase.anchor)
    builder.look_at(surfaces)
    fits = fitting(builder, phrase)
    there = [t for t in known if fits(t)]
    at = f"{'in' if place.receptacle is None or place.receptacle.depth else 'on'} the {place.name}"
    if there:
        builder.say(f"Yes, there {_be(there)} {enumeration([_a(t) for t in there])} {at}.")
    else:
        builder.say(f"No, I see no {phrase.singular or phrase.noun} {at}.")
    builder.last = there


def look_around(builder: PlanBuilder, slots: Slots) -> None:
    """Turn on the spot, then tell what is there; after driving somewhere there is no telling yet."""
    if builder.moved:
        builder.steps.append(PlanStep(action="navigate", target=AROUND))
        return
    builder.turn_around([])
    seen(builder, slots)


def go_and_see(builder: PlanBuilder, slots: Slots) -> None:
    """Go to a place, look, and tell what is there."""
    place = spot(builder, slots["spot"])
    if place.receptacle is None:
        builder.turn_around(
            [PlanStep(action="return") if place.home else PlanStep(action="navigate", target=place.name)]
        )
        if not place.room:
            seen(builder, slots)
            return
        _, there, _ = things_at(builder, slots["spot"])
        builder.say(_told(there, place) if there else f"I see nothing that I know in the {place.name}.")
        return
    contents(builder, slots)


def place_of(builder: PlanBuilder, item: BelievedObject) -> str:
    """`on the counter in the kitchen`."""
    receptacle, room = builder.world.receptacle_of(item), builder.world.room_of(item)
    if receptacle is None:
        return f"in the {room}" if room else "somewhere I cannot name"
    spoken = f"{'in' if receptacle.depth else 'on'} the {receptacle.name}"
    return spoken if not room or room.split()[0] in receptacle.name else f"{spoken} in the {room}"


def _place(builder: PlanBuilder, slots: Slots) -> None:
    place = spot(builder, slots["thing"])
    household = builder.world.household
    room = household.room_at(*place.receptacle.center[:2]) if place.receptacle else None
    builder.say(f"The {place.name} is in the {room.name}." if room else f"I know how to get to the {place.name}.")


def _inventory(builder: PlanBuilder, known: list[BelievedObject]) -> str:
    """Grouped by where they are."""
    groups: dict[str, list[str]] = {}
    for item in sorted(known, key=lambda t: (builder.world.distance(t), t.label))[:MANY]:
        groups.setdefault(place_of(builder, item), []).append(_a(item))
    more = f" and {len(known) - MANY} more" if len(known) > MANY else ""
    return enumeration([f"{enumeration(names)} {place}" for place, names in groups.items()]) + more


def _not_after_moving(builder: PlanBuilder) -> None:
    if builder.moved:
        raise Refusal("I can only tell you that when I am there, so ask me again then")


def _a(item: BelievedObject) -> str:
    return f"{'an' if item.label[:1] in 'aeiou' else 'a'} {item.label}"


def _be(known: list[BelievedObject]) -> str:
    return "is" if len(known) == 1 else "are"


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
