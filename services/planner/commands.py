"""What each sentence form does to the draft of a plan. Pure."""

from collections.abc import Callable

from common.messages import PlanStep
from common.scene import Receptacle
from services.planner.draft import Draft, Refusal
from services.planner.forms import Slots
from services.planner.phrases import PLURAL_PRONOUNS, PRONOUNS, Phrase, read
from services.planner.resolve import Meant, one, spot, things
from services.planner.vocabulary import DETERMINERS, Spot
from services.planner.words import listed

Action = Callable[[Draft, Slots], None]


# --- moving things
def fetch_named(draft: Draft, slots: Slots) -> None:
    """A thing's name alone; other words are no command."""
    last = draft.vocabulary.noun(slots["thing"][-1])
    named = slots["thing"][0] in DETERMINERS or slots["thing"][0] in draft.vocabulary.colours
    if last is None and not named and not isinstance(read(slots["thing"], draft.vocabulary), Phrase):
        raise Refusal(f"I do not understand {' '.join(slots['thing'])!r}")
    fetch(draft, slots)


def fetch(draft: Draft, slots: Slots) -> None:
    everything = things(draft, slots["thing"], prefer_held=True)
    for meant in everything:
        take(draft, meant)
        draft.hand_over()
    draft.last = [m.thing for m in everything]


def deliver(draft: Draft, slots: Slots) -> None:
    """Take things to a place, a room, a surface or the person."""
    _deliver(draft, things(draft, slots["thing"], prefer_held=True), spot(draft, slots["spot"]))


def deliver_there(draft: Draft, slots: Slots) -> None:
    """`take the mug there` and `go to the kitchen with the mug`."""
    if draft.spot is None:
        raise Refusal("I do not know which place you mean by there")
    _deliver(draft, things(draft, slots["thing"], prefer_held=True), draft.spot)


def put(draft: Draft, slots: Slots) -> None:
    """Put things in or on something that holds things."""
    everything = things(draft, slots["thing"], prefer_held=True)
    where = _surface(draft, slots)
    for meant in everything:
        _put(draft, meant, where)
    draft.last = [m.thing for m in everything]


def put_near(draft: Draft, slots: Slots) -> None:
    """Next to a thing: on what that stands on."""
    if draft.vocabulary.spot(slots["spot"]) or draft.vocabulary.furniture(slots["spot"]):
        raise Refusal(f"I cannot put things on the floor next to the {' '.join(slots['spot'][1:] or slots['spot'])}")
    moved, anchor = things(draft, slots["thing"], prefer_held=True), one(draft, slots["spot"]).thing
    where = draft.world.receptacle_of(anchor)
    if where is None:
        draft.search_first([PlanStep(action="find", object=anchor.label)])
        raise Refusal(f"I have not seen where the {anchor.label} stands")
    for meant in moved:
        _put(draft, meant, where)


def pick_up(draft: Draft, slots: Slots) -> None:
    everything = things(draft, slots["thing"], prefer_held=True)
    meant = everything[0]
    if len(everything) > 1:
        draft.collect([m.thing for m in everything])
        return
    if meant.thing.held:
        draft.say(f"I am holding the {meant.thing.label} already.")
        draft.last = [meant.thing]
        return
    if draft.world.held and any(s.action == "grasp" for s in draft.steps):
        raise Refusal("I can hold only one thing at a time")
    take(draft, meant)


def put_down(draft: Draft, slots: Slots) -> None:
    if "thing" not in slots or " ".join(slots["thing"]) in PRONOUNS | PLURAL_PRONOUNS:
        draft.release()
        return
    meant = one(draft, slots["thing"], prefer_held=True)
    if not meant.thing.held:
        raise Refusal(f"I am not holding the {meant.thing.label}")
    draft.release()


def open_hand(draft: Draft, slots: Slots) -> None:
    if draft.world.held is None:
        draft.hand_alone("release")
    else:
        draft.release()


def close_hand(draft: Draft, slots: Slots) -> None:
    if (held := draft.world.held) is None:
        draft.hand_alone("grasp")
    else:
        draft.say(f"I am holding the {held.label}.")


# --- moving itself
def go(draft: Draft, slots: Slots) -> None:
    """To a place, or up to a thing."""
    try:
        place = spot(draft, slots["spot"])
    except Refusal:
        if not isinstance(read(slots["spot"], draft.vocabulary), Phrase):
            raise
        meant = one(draft, slots["spot"])
        draft.approach(meant.thing)
        return
    draft.go(place)


def come_back(draft: Draft, slots: Slots) -> None:
    draft.go(Spot(draft.world.scene.home.name, home=True))


def wait(draft: Draft, slots: Slots) -> None:
    draft.wait()


def find(draft: Draft, slots: Slots) -> None:
    everything = things(draft, slots["thing"])
    for meant in everything:
        if meant.at is not None:
            draft.go(meant.at)
        draft.find(meant.thing, meant.words)
    draft.last = [m.thing for m in everything]


def say(draft: Draft, slots: Slots) -> None:
    text = " ".join(slots["words"])
    draft.say(f"{text[0].upper()}{text[1:]}.")


def refuse(reason: str) -> Action:
    def action(draft: Draft, slots: Slots) -> None:
        raise Refusal(reason)

    return action


# --- parts of the above
def take(draft: Draft, meant: Meant) -> None:
    if meant.at is not None and not meant.thing.seen:
        draft.go(meant.at)
    draft.take(meant.thing, meant.words)


def _put(draft: Draft, meant: Meant, where: Receptacle) -> None:
    if meant.thing.on == where.name and not meant.thing.held:
        draft.say(f"The {meant.thing.label} is there already.")
        draft.last = [meant.thing]
        return
    take(draft, meant)
    draft.place(where)


def _deliver(draft: Draft, everything: list[Meant], where: Spot) -> None:
    for meant in everything:
        if where.receptacle is not None:
            _put(draft, meant, where.receptacle)
            continue
        if where.room and draft.world.room_of(meant.thing) == where.name and not meant.thing.held:
            draft.say(f"The {meant.thing.label} is in the {where.name} already.")
            continue
        take(draft, meant)
        if where.home:
            draft.hand_over()
        elif where.room:
            draft.place(draft.in_room(where.name))
        else:
            draft.go(where)
            draft.release()
    draft.last = [m.thing for m in everything]


def _surface(draft: Draft, slots: Slots) -> Receptacle:
    words = slots["spot"]
    if "floor" in words or "ground" in words:
        raise Refusal("I cannot put things on the floor")
    try:
        where = spot(draft, words)
    except Refusal as refusal:
        phrase = read(words, draft.vocabulary)
        if isinstance(phrase, Phrase):
            raise Refusal(f"I cannot put things on or in the {phrase.noun}") from None
        raise refusal from None
    if where.room:
        return draft.in_room(where.name)
    if where.receptacle is None:
        known = listed([r.name for r in draft.world.scene.receptacles], "or")
        raise Refusal(f"I cannot put things on the {where.name}, only on or in the {known}")
    return where.receptacle
