"""Bringing and putting things. Pure."""

from common.floor_plan import Receptacle
from common.language.normalise import DETERMINERS, enumeration
from common.language.noun_phrase import PLURAL_PRONOUNS, PRONOUNS
from common.language.pattern import Slots
from common.messages import SENSELESS, PlanStep
from services.planner.commands.hand import take
from services.planner.grammar.phrases import Phrase, read
from services.planner.grammar.senses import Spot
from services.planner.plan_builder import Lost, PlanBuilder, Refusal
from services.planner.reference.fits import fitting
from services.planner.reference.places import spot
from services.planner.reference.pronouns import Referent, handled_before
from services.planner.reference.relations import between
from services.planner.reference.resolve import referent, referents
from services.planner.world import BelievedObject

RELEASED = PlanStep(action="release")
SIDE_BY_SIDE = 0.3
"""Farthest apart two things are put beside each other by doing nothing [m] (chosen: two hands' width)."""
_OVER = ["return", "release"]
"""What is done with a thing in the hand to hand it over."""


def fetch_named(builder: PlanBuilder, slots: Slots) -> None:
    """A thing's name alone; other words are no command."""
    if isinstance(phrase := read(slots["thing"], builder.vocabulary), Phrase) and phrase.sense.new:
        raise Lost(f"I know no {phrase.noun}")
    if isinstance(phrase, Phrase) and phrase.but and phrase.sense.every and not (phrase.colours or phrase.which):
        raise Refusal("you said what you do not want, but not what you want")
    if slots["thing"][0] in builder.world.household.words.mass:
        raise Lost(f"{SENSELESS} what to do with the {slots['thing'][0]}")
    last = builder.vocabulary.noun(slots["thing"][-1])
    named = slots["thing"][0] in DETERMINERS or slots["thing"][0] in builder.vocabulary.colours
    if last is None and not named and not isinstance(read(slots["thing"], builder.vocabulary), Phrase):
        raise Lost(f"I do not understand {' '.join(slots['thing'])!r}")
    fetch(builder, slots)


def fetch(builder: PlanBuilder, slots: Slots) -> None:
    everything = referents(builder, slots["thing"], prefer_held=True)
    for meant in everything:
        if [meant.object.label] == [t.label for t in builder.last] and builder.steps[-1:] == [RELEASED]:
            continue  # "as soon as you have got the apple bring it here": that is done already
        if " ".join(slots["thing"]) in PRONOUNS | PLURAL_PRONOUNS and _brought(builder, meant.object):
            continue  # "she needs her block, bring it"
        take(builder, meant)
        builder.hand_over()
    builder.last = [m.object for m in everything]


def get(builder: PlanBuilder, slots: Slots) -> None:
    """`get the mug`: to the person, unless it is said where to before it comes to anything else with it."""
    fetch(builder, slots)
    builder.got |= {t.label for t in builder.last}


def _brought(builder: PlanBuilder, item: BelievedObject) -> bool:
    """Is the last that the plan does with a thing to hand it over?"""
    over = {
        step.object: [after.action for after in builder.steps[at + 1 : at + 3]] == _OVER
        for at, step in enumerate(builder.steps)
        if step.action == "grasp"
    }
    return over.get(item.label, False)


def deliver(builder: PlanBuilder, slots: Slots) -> None:
    """Take things to a place, a room, a surface or the person, or to where another thing stands."""
    by = read(slots["spot"], builder.vocabulary) if slots["thing"][0] in DETERMINERS else ""
    if isinstance(by, Phrase) and not by.sense.new and not builder.vocabulary.spot(slots["spot"]):
        put_near(builder, slots)
        return
    _deliver(builder, referents(builder, slots["thing"], prefer_held=True), spot(builder, slots["spot"]))


def deliver_there(builder: PlanBuilder, slots: Slots) -> None:
    """`take the mug there` and `go to the kitchen with the mug`."""
    there = builder.spot
    if there is None and (before := handled_before(builder)):
        surface = builder.world.receptacle_of(before[-1])
        there = Spot(surface.name, receptacle=surface) if surface else None
    if there is None:
        raise Lost("I do not know which place you mean by there")
    everything = referents(builder, slots["thing"], prefer_held=True)
    here = {there.name} if builder.spot else set[str]()
    if all(not m.object.held and {m.object.on, builder.world.room_of(m.object)} & here for m in everything):
        for meant in everything:  # "go to the study, take the mug there"
            take(builder, meant)
        builder.last = [m.object for m in everything]
        return
    _deliver(builder, everything, there)


def put(builder: PlanBuilder, slots: Slots) -> None:
    """Put things in or on something that holds things."""
    everything = referents(builder, slots["thing"], prefer_held=True)
    where = _surface(builder, slots)
    for meant in everything:
        _put(builder, meant, where)
    builder.last = [m.object for m in everything]


def put_held(builder: PlanBuilder, slots: Slots) -> None:
    """`on the counter` to a robot that holds something."""
    if builder.world.held is None:
        raise Lost("there is nothing in my hand")
    deliver(builder, {"thing": ("it",), **slots})


def put_held_near(builder: PlanBuilder, slots: Slots) -> None:
    """`next to the can` to a robot that holds something."""
    if builder.world.held is None:
        raise Lost("there is nothing in my hand")
    put_near(builder, {"thing": ("it",), **slots})


def swap(builder: PlanBuilder, slots: Slots) -> None:
    """Two things take each other's place."""
    things = [m.object for name in ("thing", "spot") if name in slots for m in referents(builder, slots[name])]
    if len(things) != 2:
        raise Refusal("I can swap two things, and you did not name two")
    if missing := [t.label for t in things if builder.world.receptacle_of(t) is None]:
        builder.search_first([PlanStep(action="find", object=label) for label in missing])
    one, other = map(builder.world.receptacle_of, things)
    if one is None or other is None or one == other:
        names = enumeration([f"the {t.label}" for t in things])
        raise Refusal(f"{names} are in the same place" if one == other else f"I have not seen where {names} stand")
    for item, where in zip(things, (other, one), strict=True):
        _put(builder, Referent(item), where)
    builder.last = things


def put_where(builder: PlanBuilder, slots: Slots) -> None:
    """Next to a thing that is named; `leave it where it is` moves nothing."""
    if " ".join(slots["spot"]) in PRONOUNS | {"they"}:
        raise Refusal("so I leave it where it is")
    put_near(builder, slots)


def put_near(builder: PlanBuilder, slots: Slots) -> None:
    """Next to a thing: on what that stands on; by a bed: on the surface that stands there."""
    if builder.vocabulary.furniture(slots["spot"]) and len(by := builder.vocabulary.surfaces_by(slots["spot"])) == 1:
        put(builder, {**slots, "spot": tuple(by[0].name.split())})
        return
    if builder.vocabulary.spot(slots["spot"]) or builder.vocabulary.furniture(slots["spot"]):
        raise Refusal(f"I cannot put things on the floor next to the {' '.join(slots['spot'][1:] or slots['spot'])}")
    moved = referents(builder, slots["thing"], prefer_held=True)
    if " ".join(slots["spot"]) not in PRONOUNS:
        builder.last = [m.object for m in moved]
    anchor = referent(builder, slots["spot"]).object
    where = builder.world.receptacle_of(anchor)
    if where is None:
        builder.search_first([PlanStep(action="find", object=anchor.label)])
        raise Refusal(f"I have not seen where the {anchor.label} stands")
    for meant in moved:
        _put(builder, meant, where, anchor)
    builder.last = [m.object for m in moved]


def put_back(builder: PlanBuilder, slots: Slots) -> None:
    """Put things where they stood before the robot took them."""
    moved = referents(builder, slots["thing"], prefer_held=True)
    for meant in moved:
        origin = builder.world.history.taken_from.get(meant.object.label, "")
        where = builder.world.household.receptacle(origin)
        if where is None:
            raise Lost(f"I do not know where the {meant.object.label} was before")
        _put(builder, meant, where)
    builder.last = [m.object for m in moved]


def wish_at(builder: PlanBuilder, slots: Slots) -> None:
    """`I want the box on the shelf`: the one that stands there is brought, one that stands elsewhere is put there."""
    words = (*slots["thing"], "on", *slots["spot"])
    phrase = read(words, builder.vocabulary)
    names = {s.name for s in builder.vocabulary.spot(slots["spot"])}
    if isinstance(phrase, Phrase) and not phrase.sense.new:
        fits = fitting(builder, phrase)
        if any(fits(t) and (t.on in names or builder.world.room_of(t) in names) for t in builder.world.objects):
            fetch(builder, {"thing": words})
            return
    put(builder, slots)


def named_at(builder: PlanBuilder, slots: Slots) -> None:
    """`ball in toy box`: without an article it says what is to be where; `the ball in the toy box` is which ball."""
    if slots["thing"][0] in DETERMINERS:
        fetch_named(builder, {"thing": (*slots["thing"], "on", *slots["spot"])})
        return
    wish_at(builder, slots)


def _put(builder: PlanBuilder, meant: Referent, where: Receptacle, near: BelievedObject | None = None) -> None:
    """On a receptacle, next to what stands `near` there, but into a bin anywhere; what is there already stays."""
    item, near = meant.object, None if where.depth else near
    if item.on == where.name and not item.held and (near is None or between(item, near) < SIDE_BY_SIDE):
        builder.say(f"The {item.label} is there already.")
        builder.last = [item]
        return
    take(builder, meant)
    builder.place(where, near.label if near is not None else "")


def _deliver(builder: PlanBuilder, everything: list[Referent], where: Spot) -> None:
    for meant in everything:
        if where.receptacle is not None:
            _put(builder, meant, where.receptacle)
            continue
        if where.room and builder.world.room_of(meant.object) == where.name and not meant.object.held:
            builder.say(f"The {meant.object.label} is in the {where.name} already.")
            continue
        take(builder, meant)
        if where.home:
            builder.hand_over()
        elif where.room:
            builder.place(builder.in_room(where.name))
        else:
            builder.go(where)
            builder.release()
    builder.last = [m.object for m in everything]


def _surface(builder: PlanBuilder, slots: Slots) -> Receptacle:
    words = slots["spot"]
    if "floor" in words or "ground" in words:
        raise Refusal("I cannot put things on the floor")
    try:
        where = spot(builder, words)
    except Refusal:
        phrase = read(words, builder.vocabulary)
        if isinstance(phrase, Phrase) and not phrase.sense.new:
            raise Refusal(f"I cannot put things on or in the {phrase.noun}") from None
        raise
    if where.room:
        return builder.in_room(where.name)
    if where.receptacle is None:
        known = enumeration([r.name for r in builder.world.household.receptacles], "or")
        raise Refusal(f"I cannot put things on the {where.name}, only on or in the {known}")
    return where.receptacle
