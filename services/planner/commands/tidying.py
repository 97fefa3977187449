"""Actions that put objects where they belong: tidying up, putting away, throwing away. Pure."""

from collections.abc import Callable, Iterable

from common.floor_plan import Receptacle
from common.language.normalise import Words, without_determiners
from common.language.noun_phrase import related, without_exceptions
from common.language.pattern import Slots
from common.naming.words import Destination
from services.planner.commands.hand import take
from services.planner.grammar.phrases import Phrase, read
from services.planner.grammar.senses import WHOLE, Spot
from services.planner.plan_builder import Lost, PlanBuilder, Refusal
from services.planner.reference.fits import fitting
from services.planner.reference.places import spot
from services.planner.reference.pronouns import Referent
from services.planner.reference.resolve import referents
from services.planner.world import BelievedObject


def put_away(builder: PlanBuilder, slots: Slots) -> None:
    meant = referents(builder, _all(builder, slots["thing"]), prefer_held=True)
    _sort(builder, meant, builder.world.household.words.tidy)


def throw_away(builder: PlanBuilder, slots: Slots) -> None:
    meant = referents(builder, _all(builder, slots["thing"]), prefer_held=True)
    _sort(builder, meant, builder.world.household.words.throw)


def _all(builder: PlanBuilder, words: Words) -> Words:
    """`anything on the desk`, to be put away, is all of it, and `it all` is what is at the place that was spoken of."""
    if " ".join(words) in WHOLE and builder.spot is not None:
        return ("everything", "on", *builder.spot.name.split())
    return ("everything", *words[1:]) if words[0] == "anything" else words


def tidy(builder: PlanBuilder, slots: Slots) -> None:
    """Everything on a surface, in a room or in the whole flat goes where the rules say."""
    words, left_out = without_exceptions(("all", *slots.get("spot", ())))
    where = _area(builder, words[1:])
    spared = [_spared(builder, phrase) for phrase in left_out]
    surfaces = builder.vocabulary.surfaces() if where is None else _surfaces_of(builder, where)
    name = "place" if where is None else where.name
    names = {r.name for r in surfaces}
    there = [t for t in builder.world.objects if t.on in names and not t.held and not any(fits(t) for fits in spared)]
    surfaces = [r for r in surfaces if not any(fits(BelievedObject("", "", on=r.name)) for fits in spared)]
    builder.look_at(surfaces)
    if not there:
        builder.look_first(surfaces, f"I have not seen what lies on the {name} yet, so send me there first")
    near = sorted(there, key=lambda t: (builder.world.distance(t), t.label))
    _sort(builder, [Referent(t) for t in near], builder.world.household.words.tidy, quiet=True)
    if not any(t.on != _now(builder, t.label) for t in there):
        builder.say(f"The {name} is tidy already.")


def _spared(builder: PlanBuilder, words: Words) -> Callable[[BelievedObject], bool]:
    """Whether an object is left out by a phrase: a thing, or the place where things stay as they are.

    Raises:
        Lost: the words name neither.
    """
    phrase = read(("all", *without_determiners(words)), builder.vocabulary)
    if isinstance(phrase, Phrase) and not phrase.sense.new:
        fits = fitting(builder, phrase)
        return lambda item: bool(item.label) and fits(item)
    names = {place.name for place in builder.vocabulary.spot(words)}
    if not names:
        raise Lost(f"I know no {' '.join(without_determiners(words))}")
    return lambda item: bool(names & {item.on, builder.world.room_of(item)})


def _now(builder: PlanBuilder, label: str) -> str:
    return next((t.on for t in builder.world.objects if t.label == label), "")


def _sort(
    builder: PlanBuilder, everything: Iterable[Referent], rules: tuple[Destination, ...], quiet: bool = False
) -> None:
    """Each where its rule says; what is there already stays."""
    moved = list(everything)
    for meant in moved:
        where = builder.destination(meant.object, rules)
        if meant.object.on != where.name or meant.object.held:
            take(builder, meant)
            builder.place(where)
        elif not quiet:
            builder.say(f"The {meant.object.label} is in its place already.")
    builder.last = [m.object for m in moved]


def _area(builder: PlanBuilder, words: Words) -> Spot | None:
    for head, relation, anchor in related(words):
        sense = builder.vocabulary.noun(" ".join(without_determiners(head)))
        if relation == "on" and sense is not None and sense[0].every:  # the mess on the table
            words = anchor
            break
    phrase = " ".join(w for w in words if w not in ("the", "my", "this", "whole", "entire", "all"))
    if phrase in ("", "up", "flat", "apartment", "house", "home", "place", "everything", "mess"):
        return None
    if phrase in ("room", "here"):
        x, y, _ = builder.world.pose
        room = builder.world.household.room_at(x, y)
        return Spot(room.name, room=True) if room else None
    where = spot(builder, words)
    if where.receptacle is None and not where.room:
        raise Refusal(f"I do not know how to tidy up the {where.name}")
    return where


def _surfaces_of(builder: PlanBuilder, where: Spot) -> list[Receptacle]:
    if where.receptacle is None:
        return builder.vocabulary.surfaces(where.name)
    if where.receptacle.depth:
        raise Refusal(f"I cannot empty the {where.name}")
    return [where.receptacle]
