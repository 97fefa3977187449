"""What the robot says about what it has seen. Pure."""

from common.messages import PlanStep
from services.planner.draft import Draft, Refusal
from services.planner.forms import Slots
from services.planner.phrases import Phrase, read
from services.planner.resolve import Meant, spot, things, unknown
from services.planner.vocabulary import bare
from services.planner.words import listed
from services.planner.world import Thing

MANY = 8


def seen(draft: Draft, slots: Slots) -> None:
    """What is in view, and what was seen before."""
    _not_after_moving(draft)
    fresh = [t for t in draft.world.things if not t.held and draft.world.now - t.seen_at <= draft.config.fresh]
    if fresh:
        draft.say(f"I see {_inventory(draft, fresh)}.")
        return
    known = [t for t in draft.world.things if not t.held]
    if known:
        draft.say(f"From here I see nothing that I know. I remember {_inventory(draft, known)}.")
    else:
        draft.say("I have seen nothing that I know yet.")


def contents(draft: Draft, slots: Slots) -> None:
    """What is on a surface or in a room."""
    _not_after_moving(draft)
    place = spot(draft, slots["spot"])
    if place.receptacle is not None:
        there = [t for t in draft.world.things if t.on == place.name]
        look = [place.receptacle]
    else:
        there = [t for t in draft.world.things if not t.held and draft.world.room_of(t) == place.name]
        look = draft.vocabulary.surfaces(place.name)
    draft.look_at(look)
    if not there:
        draft.look_first(look, f"I have seen nothing there so far, so I would have to go to the {place.name} first")
    where = "in" if place.receptacle is None or place.receptacle.depth else "on"
    draft.say(f"{_capital(listed([_a(t) for t in there]))} {_be(there)} {where} the {place.name}.")


def holding(draft: Draft, slots: Slots) -> None:
    _not_after_moving(draft)
    held = draft.world.held
    draft.say(f"I am holding the {held.label}." if held else "My hand is empty.")


def whereabouts(draft: Draft, slots: Slots) -> None:
    _not_after_moving(draft)
    x, y, _ = draft.world.pose
    room = draft.world.scene.room_at(x, y)
    draft.say(f"I am in the {room.name}." if room else "I do not know which room I am in.")


def where(draft: Draft, slots: Slots) -> None:
    """Where something is; what nobody has seen is looked for."""
    phrase = read(slots["thing"], draft.vocabulary)
    for meant in _all_meant(draft, slots) if isinstance(phrase, Phrase) else ():
        thing = meant.thing
        if thing.held:
            draft.say(f"The {thing.label} is in my hand.")
        elif thing.seen and (thing.position or thing.on):
            draft.say(f"The {thing.label} is {place_of(draft, thing)}.")
        else:
            draft.search_first([PlanStep(action="find", object=thing.label, text=meant.words)])
            draft.find(thing, meant.words)
            draft.say(f"I have found the {thing.label}.")
        draft.last = [thing]
    if not isinstance(phrase, Phrase):
        if draft.vocabulary.spot(slots["thing"]):
            _place(draft, slots)
            return
        raise Refusal(unknown(draft, slots["thing"], phrase))


def found(draft: Draft) -> None:
    """Who only asked to find things is told where they are, once they were looked for."""
    if draft.done is None:
        return
    draft.search_first(draft.steps)
    told: list[Thing] = []
    for step in draft.steps:
        alike = [t for t in draft.world.things if t.seen and not t.held and step.object in (t.label, t.kind)]
        told += [max(alike, key=lambda t: t.seen_at)] if alike else []
    if told and len(told) == len(draft.steps):
        draft.steps.clear()
        for thing in told:
            draft.say(f"The {thing.label} is {place_of(draft, thing)}.")


def _all_meant(draft: Draft, slots: Slots) -> list[Meant]:
    """For "where is the mug" every mug that was seen."""
    meant = things(draft, slots["thing"], prefer_held=True)
    several = [t for t in draft.world.things if t.kind == meant[0].thing.label != t.label]
    return things(draft, ("all", *bare(slots["thing"]))) if len(meant) == 1 and several else meant


def number(draft: Draft, slots: Slots) -> None:
    _not_after_moving(draft)
    phrase = read(slots["thing"], draft.vocabulary)
    if not isinstance(phrase, Phrase):
        raise Refusal(unknown(draft, slots["thing"], phrase))
    try:
        known = [m.thing for m in things(draft, ("all", *slots["thing"])) if m.thing.seen]
    except Refusal:
        known = []
    names = f": {listed([f'the {t.label}' for t in known])}" if 0 < len(known) <= MANY else ""
    draft.say(f"I know of {len(known) or 'no'} {phrase.noun}{names}.")


def place_of(draft: Draft, thing: Thing) -> str:
    """`on the counter in the kitchen`."""
    receptacle, room = draft.world.receptacle_of(thing), draft.world.room_of(thing)
    if receptacle is None:
        return f"in the {room}" if room else "somewhere I cannot name"
    spoken = f"{'in' if receptacle.depth else 'on'} the {receptacle.name}"
    return spoken if not room or room.split()[0] in receptacle.name else f"{spoken} in the {room}"


def _place(draft: Draft, slots: Slots) -> None:
    place = spot(draft, slots["thing"])
    scene = draft.world.scene
    room = scene.room_at(*place.receptacle.center[:2]) if place.receptacle else None
    draft.say(f"The {place.name} is in the {room.name}." if room else f"I know how to get to the {place.name}.")


def _inventory(draft: Draft, known: list[Thing]) -> str:
    """Grouped by where they are."""
    groups: dict[str, list[str]] = {}
    for thing in sorted(known, key=lambda t: (draft.world.distance(t), t.label))[:MANY]:
        groups.setdefault(place_of(draft, thing), []).append(_a(thing))
    more = f" and {len(known) - MANY} more" if len(known) > MANY else ""
    return listed([f"{listed(names)} {place}" for place, names in groups.items()]) + more


def _not_after_moving(draft: Draft) -> None:
    if draft.moved:
        raise Refusal("I can only tell you that when I am there, so ask me again then")


def _a(thing: Thing) -> str:
    return f"{'an' if thing.label[:1] in 'aeiou' else 'a'} {thing.label}"


def _be(known: list[Thing]) -> str:
    return "is" if len(known) == 1 else "are"


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
