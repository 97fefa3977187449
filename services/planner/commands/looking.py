"""What is on a surface or in a room, looked at where nothing is known; looking around. Pure."""

from common.floor_plan import Receptacle
from common.language.normalise import Words, enumeration
from common.language.pattern import Slots
from common.messages import AROUND, PlanStep
from services.planner.commands import answers
from services.planner.commands.telling import a, be, inventory, none_of, not_after_moving, told
from services.planner.grammar.phrases import Phrase, read
from services.planner.grammar.senses import Spot
from services.planner.plan_builder import PlanBuilder, Refusal
from services.planner.reference.fits import fitting, unknown
from services.planner.reference.places import spot
from services.planner.world import BelievedObject


def seen(builder: PlanBuilder, slots: Slots) -> None:
    """What is in view, and what was seen before."""
    not_after_moving(builder)
    fresh = [t for t in builder.world.objects if not t.held and builder.world.now - t.seen_at <= builder.config.fresh]
    if fresh:
        builder.say(f"I see {inventory(builder, fresh)}.")
        return
    known = [t for t in builder.world.objects if not t.held]
    if known:
        builder.say(f"From here I see nothing that I know. I remember {inventory(builder, known)}.")
    else:
        builder.say("I have seen nothing that I know yet.")


def recall(builder: PlanBuilder, slots: Slots) -> None:
    """What was seen on a surface or in a room; a look is taken only when nothing was."""
    _tell_contents(builder, slots, afresh=False)


def contents(builder: PlanBuilder, slots: Slots) -> None:
    """All that is on a surface or in a room, which is looked at first."""
    _tell_contents(builder, slots, afresh=True)


def _tell_contents(builder: PlanBuilder, slots: Slots, afresh: bool) -> None:
    not_after_moving(builder)
    place, there, look = things_at(builder, slots.get("spot", ("there",)))
    if afresh or not there:
        builder.look_at(look)
    if not there:
        if builder.done is None:
            raise Refusal(f"I have seen nothing there so far, so I would have to go to the {place.name} first")
        builder.look_at(look)
    builder.spot = place
    if not any(step.text == told(there, place) for step in builder.steps):
        builder.say(told(there, place))


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
        builder.spot, there, _ = things_at(builder, slots["spot"])
        builder.say(told(there, place))
        return
    contents(builder, slots)


def check(builder: PlanBuilder, slots: Slots) -> None:
    """Go and look whether something is there, and tell."""
    thing = slots["thing"]
    phrase = read((*thing, "on", *slots["spot"]) if "spot" in slots else thing, builder.vocabulary)
    if not isinstance(phrase, Phrase):
        raise unknown(builder, thing, phrase)
    spots = builder.vocabulary.spot(phrase.anchor) if phrase.relation in ("on", "near") else []
    if not spots:
        answers.where(builder, slots)
        return
    place, known, surfaces = things_at(builder, phrase.anchor)
    builder.look_at(surfaces)
    fits = fitting(builder, phrase)
    there = [t for t in known if fits(t)]
    at = place.spoken
    if there:
        builder.say(f"Yes, there {be(there)} {enumeration([a(t) for t in there])} {at}.")
    else:
        builder.say(f"No, I see {none_of(phrase)} {at}.")
    builder.last = there


def exists(builder: PlanBuilder, slots: Slots) -> None:
    """Where there is something of the kind; a place where none is known is looked at."""
    phrase = read(slots["thing"], builder.vocabulary)
    placed = isinstance(phrase, Phrase) and phrase.relation == "on" and bool(builder.vocabulary.spot(phrase.anchor))
    if placed and isinstance(phrase, Phrase):
        fits, (_, known, _) = fitting(builder, phrase), things_at(builder, phrase.anchor)
        if not any(map(fits, known)):
            check(builder, slots)
            return
    if isinstance(phrase, Phrase) and phrase.sense.new and phrase.any_one and not phrase.relation:
        builder.say(f"I have seen {none_of(phrase)} so far.")
        return
    answers.where(builder, slots)


def is_at(builder: PlanBuilder, slots: Slots) -> None:
    """Where something is that was asked for at a place; what nobody has seen is looked for there."""
    phrase = read(slots["thing"], builder.vocabulary)
    (check if isinstance(phrase, Phrase) and phrase.sense.new else answers.where)(builder, slots)
