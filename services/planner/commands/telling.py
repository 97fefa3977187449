"""How things, and where they are, are named in an answer. Pure."""

from common.language.normalise import enumeration, indefinite
from services.planner.grammar.phrases import Phrase
from services.planner.grammar.senses import Spot
from services.planner.plan_builder import PlanBuilder, Refusal
from services.planner.world import BelievedObject

MANY = 8
"""Objects told at once (chosen: more nobody listens to)."""


def place_of(builder: PlanBuilder, item: BelievedObject) -> str:
    """`on the counter in the kitchen`."""
    receptacle, room = builder.world.receptacle_of(item), builder.world.room_of(item)
    if receptacle is None:
        return f"in the {room}" if room else "somewhere I cannot name"
    near = not room or room.split()[0] in receptacle.name
    return receptacle.spoken if near else f"{receptacle.spoken} in the {room}"


def inventory(builder: PlanBuilder, known: list[BelievedObject]) -> str:
    """Grouped by where they are."""
    groups: dict[str, list[str]] = {}
    for item in sorted(known, key=lambda t: (builder.world.distance(t), t.label))[:MANY]:
        groups.setdefault(place_of(builder, item), []).append(a(item))
    more = f" and {len(known) - MANY} more" if len(known) > MANY else ""
    return enumeration([f"{enumeration(names)} {place}" for place, names in groups.items()]) + more


def told(there: list[BelievedObject], place: Spot) -> str:
    if not there:
        return f"I see nothing that I know {place.spoken}."
    return f"{capital(enumeration([a(t) for t in there]))} {be(there)} {place.spoken}."


def not_after_moving(builder: PlanBuilder) -> None:
    if builder.moved:
        raise Refusal("I can only tell you that when I am there, so ask me again then")


def none_of(phrase: Phrase) -> str:
    """`no red mug`, `nothing to eat`: how to say that there is none of what was asked for."""
    name = " ".join((*phrase.colours, phrase.singular or phrase.noun))
    return f"nothing{name[8:]}" if name.startswith("anything") else f"no {name.removeprefix('any ')}"


def a(item: BelievedObject) -> str:
    return indefinite(item.label)


def be(known: list[BelievedObject]) -> str:
    return "is" if len(known) == 1 else "are"


def capital(text: str) -> str:
    return text[:1].upper() + text[1:]
