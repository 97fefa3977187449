"""What the robot says about where things are, and how many and of what colour. Pure."""

from common.language.exchange import PREPOSITIONS
from common.language.normalise import Words, enumeration, without_determiners
from common.language.noun_phrase import PLURAL_PRONOUNS, PRONOUNS, WHICH, related
from common.language.pattern import Slots
from common.messages import SENSELESS, PlanStep
from services.planner.commands.telling import a, be, capital, not_after_moving, place_of
from services.planner.grammar.phrases import Phrase, read
from services.planner.grammar.senses import ANY, Sense
from services.planner.plan_builder import Lost, PlanBuilder, Refusal
from services.planner.reference.fits import unknown
from services.planner.reference.places import spot
from services.planner.reference.pronouns import Referent
from services.planner.reference.relations import between, holds, spoken, superlative
from services.planner.reference.resolve import referent, referents
from services.planner.world import BelievedObject

_FROM_HERE = {("to", w) for w in ("me", "you", "us", "here")}
MAX_BESIDE = 3
"""Neighbours told at once (chosen)."""


def where(builder: PlanBuilder, slots: Slots) -> None:
    """Where something is; what nobody has seen is looked for."""
    phrase = read(slots["thing"], builder.vocabulary)
    for meant in _meant(builder, slots, phrase):
        if not _told(builder, meant.object):
            builder.search_first([PlanStep(action="find", object=meant.object.label, text=meant.words)])
            builder.find(meant.object, meant.words)
            builder.say(f"I have found the {meant.object.label}.")
        builder.last = [meant.object]


def remembered(builder: PlanBuilder, slots: Slots) -> bool:
    """Say where something is known to be now, without a look for it; False where that is not known."""
    memory = builder.fork()
    memory.done = None
    phrase = read(slots["thing"], builder.vocabulary)
    meant = [m.object for m in _meant(memory, slots, phrase)]
    told = [item for item in meant if _told(memory, item)]
    builder.adopt(memory)
    builder.last = told or builder.last
    return bool(told)


def _meant(builder: PlanBuilder, slots: Slots, phrase: Phrase | str) -> list[Referent]:
    """The things that are asked about; none, and the answer is given, where it is a place.

    Raises:
        Refusal: the words name nothing.
    """
    if isinstance(phrase, Phrase) or " ".join(slots["thing"]) in PRONOUNS | PLURAL_PRONOUNS:
        return _all_meant(builder, slots)
    if not builder.vocabulary.spot(slots["thing"]):
        raise unknown(builder, slots["thing"], phrase)
    _place(builder, slots)
    return []


def _told(builder: PlanBuilder, item: BelievedObject) -> bool:
    """Say where it is; False where nobody has seen it."""
    if item.held:
        builder.say(f"The {item.label} is in my hand.")
    elif item.seen and (item.position or item.on):
        builder.say(f"The {item.label} is {place_of(builder, item)}.")
    else:
        return False
    return True


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


def colour(builder: PlanBuilder, slots: Slots) -> None:
    """What colours something has."""
    not_after_moving(builder)
    for meant in referents(builder, slots["thing"], prefer_held=True):
        item = meant.object
        colours = [item.colour, *sorted(item.colours - {item.colour})] if item.colour else []
        if not colours:
            raise Refusal(f"I have not seen what colour the {item.label} has")
        builder.say(f"The {item.label} is {enumeration(colours)}.")
        builder.last = [item]


def written(builder: PlanBuilder, slots: Slots) -> None:
    """What has been read on something."""
    not_after_moving(builder)
    for meant in referents(builder, slots.get("thing", ("it",)), prefer_held=True):
        item = meant.object
        said = f"It says {item.text}" if item.text else "I have read nothing"
        builder.say(f"{said} on the {item.label}.")
        builder.last = [item]


def extreme(builder: PlanBuilder, slots: Slots) -> None:
    """Which of several is the biggest, the nearest or the leftmost."""
    not_after_moving(builder)
    said = slots["words"][:-2] if slots["words"][-2:] in _FROM_HERE else slots["words"]
    words, noun = without_determiners(said), without_determiners(slots.get("thing", ()))
    if "or" in words and words[0] in WHICH:  # which is bigger, the mug or the can
        at = words.index("or")
        sides = (words[1:at], words[at + 1 :])
        two = [m.object for part in sides for m in referents(builder, part)]
        which = WHICH[words[0]]
        found = superlative(builder, Phrase(Sense(every=True), "thing", which=which), [t for t in two if t.seen])
        builder.say(f"The {found.label}. It is {place_of(builder, found)}.")
        return
    if noun and words[:1] and words[0] in PREPOSITIONS:  # which mug is on the desk
        asked: Words = ("the", *noun, *words)
    elif words and words[0] in WHICH and (not noun or len(words) == 1):  # which mug is the biggest
        asked = ("the", *words, *noun)
    elif not noun and len(words) > 1 and ANY & set(words):  # what is the red thing on the desk
        asked = ("the", *words)
    elif noun and all(w in builder.vocabulary.colours or w == "and" for w in words):  # which of the things are red
        _told_one_by_one(builder, [m.object for m in referents(builder, ("all", *words, *noun))])
        return
    else:
        raise Lost(f"{SENSELESS} {' '.join(slots['words'])!r}")
    meant = referent(builder, asked).object
    if not meant.seen:
        raise Refusal(f"I have not seen that {' '.join(noun) or 'thing'}")
    builder.say(f"The {meant.label}. It is {place_of(builder, meant)}.")
    builder.last = [meant]


def compare(builder: PlanBuilder, slots: Slots) -> None:
    """Is one thing bigger than another?"""
    words = slots["words"]
    which = WHICH.get(words[-1])
    if which is None or len(words) > 1:
        raise Lost(f"{SENSELESS} {' '.join(words)!r}")
    one, other = (referent(builder, slots[name]).object for name in ("thing", "spot"))
    for item in (one, other):
        if not item.seen:
            raise Refusal(f"I have not seen the {item.label}")
    most = superlative(builder, Phrase(Sense(every=True), "thing", which=which), [one, other])
    builder.say(f"{'Yes' if most is one else 'No'}, the {most.label} is {words[-1]}.")


def _told_one_by_one(builder: PlanBuilder, things: list[BelievedObject]) -> None:
    for item in things:
        if not item.seen:
            raise Refusal(f"I have not seen the {item.label}")
        builder.say(f"The {item.label} is {place_of(builder, item)}.")
    builder.last = things


def beside(builder: PlanBuilder, slots: Slots) -> None:
    """What stands next to, left of or behind something."""
    not_after_moving(builder)
    for _, relation, words in related(("thing", *slots["words"])):
        if relation == "between":
            between_them = [m.object for m in referents(builder, ("everything", "between", *words))]
            builder.say(f"{capital(enumeration([a(t) for t in between_them]))}.")
            return
        anchor = referent(builder, words).object
        others = [t for t in builder.world.objects if t.label != anchor.label and t.position and not t.held]
        if anchor.position is None:
            raise Refusal(f"I have not seen where the {anchor.label} is")
        same = [t for t in others if t.on == anchor.on and holds(builder, relation, t, anchor)]
        near = sorted(same, key=lambda t: between(t, anchor))[:MAX_BESIDE]
        where = f"{spoken(relation)} the {anchor.label}"
        builder.say(
            f"{capital(enumeration([a(t) for t in near]))} {be(near)} {where}." if near else f"I see nothing {where}."
        )
        return
    raise Lost(f"I do not understand {' '.join(slots['words'])!r}")


def holding(builder: PlanBuilder, slots: Slots) -> None:
    not_after_moving(builder)
    held = builder.world.held
    builder.say(f"I am holding the {held.label}." if held else "My hand is empty.")


def whereabouts(builder: PlanBuilder, slots: Slots) -> None:
    not_after_moving(builder)
    x, y, _ = builder.world.pose
    room = builder.world.household.room_at(x, y)
    builder.say(f"I am in the {room.name}." if room else "I do not know which room I am in.")


def _place(builder: PlanBuilder, slots: Slots) -> None:
    place = spot(builder, slots["thing"])
    household = builder.world.household
    room = household.room_at(*place.receptacle.center[:2]) if place.receptacle else None
    builder.say(f"The {place.name} is in the {room.name}." if room else f"I know how to get to the {place.name}.")
