"""What people tell of their home and ask about it: names of its parts, rules, where things usually are. Pure."""

from common.floor_plan import Receptacle
from common.language.normalise import Words, enumeration, without_determiners
from common.language.pattern import Slots
from common.messages import PlanStep, Sighting
from common.naming.names import normalise
from common.naming.part_names import kind_named
from common.naming.words import Destination
from common.tidy_rule import ONES, rule_about
from common.whereabouts import ago, decayed, kind_of_phrase, of_thing
from services.planner.commands.answers import remembered
from services.planner.grammar.phrases import Phrase, read
from services.planner.plan_builder import Lost, PlanBuilder, Refusal
from services.planner.reference.fits import fitting
from services.planner.reference.places import spot

CLEARLY = 0.6
"""Share of the visits from which a thing is usually at one place (chosen)."""
TOLD = 3
"""Places told at once (chosen: more nobody listens to)."""
_UNTIDY = frozenset({"mess", "disgrace", "tip", "pigsty", "sty", "shambles", "state", "dump", "disaster", "nightmare"})
"""What somebody calls a place that is to be tidied."""


# --- names
def name_place(builder: PlanBuilder, slots: Slots) -> None:
    """What the robot stands in or before, or a place that has a name already, is called so from now on."""
    words = without_determiners(slots["words"])
    if _UNTIDY.intersection(words[-1:]) and "thing" in slots:
        place = " ".join(without_determiners(slots["thing"]))
        raise Lost(f"I call no place a {words[-1]}", f"tidy up the {place}")
    name, part, kind = " ".join(words), "", kind_named(" ".join(slots.get("thing", slots["words"])))
    if "spot" in slots:
        part = spot(builder, slots["spot"]).name
    elif kind is None or len(slots.get("thing", ())) > 1:
        raise Refusal(f"I cannot tell whether {name} is a room, a surface or a place")
    if not words or len(words) > 4:
        raise Refusal(f"{name} is too long for a name")
    builder.steps.append(PlanStep(action="name", object=part, target="" if part else kind or "", text=name))


# --- rules
def rule(builder: PlanBuilder, slots: Slots) -> None:
    """`mugs go on the shelf`: of all of a kind, not of the one that is meant by "the mug"."""
    things = slots["thing"]
    phrase = read(things, builder.vocabulary)
    plural = isinstance(phrase, Phrase) and (
        (phrase.plural and not phrase.sense.names) or (phrase.sense.new and _is_plural(things[-1]))
    )
    whole = isinstance(phrase, Phrase) and not (phrase.sense.every or phrase.relation or phrase.but or phrase.count > 1)
    if things[0] in ONES or not (plural and whole):
        said, place = " ".join(things), " ".join(slots["spot"])
        raise Lost(f"I do not know which {said} you mean; say from now on for all", f"{said} always belong on {place}")
    rule_always(builder, slots)


def rule_always(builder: PlanBuilder, slots: Slots) -> None:
    """Where things of the kind belong from now on."""
    kind = slots["thing"][slots["thing"][:1] in (("all",), ("every",), ("each",)) :]
    things = " ".join(without_determiners(kind or slots["thing"]))
    if not isinstance(read(slots["thing"], builder.vocabulary), Phrase):
        raise Lost(f"I know no {things}")
    where_to = spot(builder, slots["spot"])
    if where_to.room:
        there = builder.vocabulary.surfaces(where_to.name)
        usual = [r for r in _goes(builder, things) if r in there]
        to = (usual[0] if usual else builder.in_room(where_to.name)).name
    elif where_to.receptacle is not None:
        to = where_to.receptacle.name
    else:
        raise Refusal(f"I cannot put things on the {where_to.name}")
    if builder.vocabulary.spot(slots["thing"]):
        raise Refusal(f"the {things} is no thing that I could put away")
    builder.steps.append(PlanStep(action="rule", object=things, target=to))


def forget_rule(builder: PlanBuilder, slots: Slots) -> None:
    """The rule about some things, or the one that was told last."""
    told = builder.world.edits.rules
    things = normalise(" ".join(without_determiners(slots.get("words", ()))))
    about = [r for r in told if not things or things in (r.things, f"{r.things}s", r.things.removesuffix("s"))]
    if not about:
        raise Refusal(f"you have told me no rule{f' about {things}' if things else ''}")
    builder.steps.append(PlanStep(action="forget", target="rule", text=about[-1].things))


def rules(builder: PlanBuilder, slots: Slots) -> None:
    """The rules that people told, the newest first."""
    told = [f"{r.things} go {_on(builder, r.to)}" for r in reversed(builder.world.edits.rules)]
    if not told:
        builder.say("You have told me no rules. Say, for example, that mugs go on the shelf.")
        return
    builder.say(f"You have told me that {enumeration(told)}.")


def belongs(builder: PlanBuilder, slots: Slots) -> None:
    """Where things go when they are put away."""
    phrase = read(slots["thing"], builder.vocabulary)
    if not isinstance(phrase, Phrase) or phrase.sense.new:
        raise Lost(f"I know no {' '.join(without_determiners(slots['thing']))}")
    fits = fitting(builder, phrase)
    known = [t for t in (*builder.world.objects, *builder.world.specs) if fits(t)]
    if known:
        to = builder.destination(known[0], builder.world.household.words.tidy)
    else:
        found = _goes(builder, " ".join(slots["thing"]))
        if not found:
            raise Lost(f"I do not know where {phrase.noun} go")
        to = found[0]
    said = " ".join(slots["thing"])
    verb = "go" if phrase.plural else "goes"
    builder.say(f"{said[:1].upper()}{said[1:]} {verb} {to.spoken}.")


def _goes(builder: PlanBuilder, things: str) -> list[Receptacle]:
    """Where things of these words go by the rules, the first choice first."""
    words = builder.world.household.words
    about = rule_about(things, "", words)

    def fits(rule: Destination) -> bool:
        wanted = ((rule.kinds, about.kinds), (rule.colours, about.colours), (rule.names, about.names))
        return all(not these or set(these) & set(those) for these, those in wanted)

    return [r for rule in words.tidy if fits(rule) for r in builder.named(rule.to)]


def _on(builder: PlanBuilder, to: list[str]) -> str:
    return next((r.spoken for name in to if (r := builder.world.household.receptacle(name))), "nowhere")


# --- where things were
def usual(builder: PlanBuilder, slots: Slots) -> None:
    """Where something mostly was on the days that it was seen."""
    thing = _thing(builder, slots["thing"])
    now, found = builder.world.seen_until, of_thing(thing, builder.world.sightings)
    if not found:
        kind = kind_of_phrase(thing, builder.world.household, builder.world.sightings)
        kin = [s for s in builder.world.sightings if kind and s.kind == kind]
        if not kin:
            builder.say(f"I have not seen any {thing} yet.")
            return
        builder.say(f"I have not seen the {thing}. Others of the kind are usually {_mostly(builder, kin, now)}.")
        return
    verb = "are" if _is_plural(thing) else "is"
    builder.say(f"The {thing} {verb} usually {_mostly(builder, found, now)}.")


def _mostly(builder: PlanBuilder, found: list[Sighting], now: float) -> str:
    """`on the counter in the kitchen, sometimes on the table`."""
    weights: dict[str, float] = {}
    for s in found:
        place = _place(builder, s)
        weights[place] = weights.get(place, 0.0) + decayed(s, now)
    order = sorted(weights, key=lambda place: -weights[place])[:TOLD]
    first, *others = order
    if not others:
        return first
    if weights[first] >= CLEARLY * sum(weights.values()):
        return f"{first}, sometimes {enumeration(others, 'or')}"
    return enumeration(order, "or")


def last_seen(builder: PlanBuilder, slots: Slots) -> None:
    """Where something was when it was seen last, today or days ago; what is known to be somewhere now is told so.

    Nobody goes and looks: what was never seen is said to be.
    """
    thing = _thing(builder, slots["thing"])
    found = of_thing(thing, builder.world.sightings)
    try:
        present = remembered(builder, slots)
    except Refusal as refusal:
        if isinstance(refusal, Lost) and not found:
            raise
        present = False
    if found:
        s = max(found, key=lambda s: s.last)
        seen = "I last saw it" if present else f"I last saw the {thing} {_place(builder, s)},"
        builder.say(f"{seen} {ago(builder.world.seen_until - s.last)}.")
    elif not present:
        builder.say(f"I have not seen any {thing} yet.")


def _thing(builder: PlanBuilder, words: Words) -> str:
    """The words for a thing, which need not be known."""
    bare = without_determiners(words)
    if not bare or builder.vocabulary.spot(words):
        raise Refusal(f"the {' '.join(bare) or 'thing'} stays where it is")
    return " ".join(bare)


def _is_plural(noun: str) -> bool:
    return noun.endswith("s") and not noun.endswith("ss")


def _place(builder: PlanBuilder, s: Sighting) -> str:
    """`on the counter in the kitchen`."""
    household = builder.world.household
    r, room = household.receptacle(s.part) if s.part else None, household.room_at(s.position[0], s.position[1])
    name = r.name if r is not None else s.part or "floor"
    on = r.spoken if r is not None else f"on the {name}"
    return on if room is None or room.name.split()[0] in name else f"{on} in the {room.name}"
