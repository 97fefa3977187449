"""Putting things where they belong: tidying up, putting away, throwing away. Pure."""

from collections.abc import Iterable

from common.scene import Receptacle
from services.planner.commands import take
from services.planner.config import Rule
from services.planner.draft import Draft, Refusal
from services.planner.forms import Slots
from services.planner.resolve import Meant, spot, things
from services.planner.vocabulary import Spot


def put_away(draft: Draft, slots: Slots) -> None:
    _sort(draft, things(draft, slots["thing"], prefer_held=True), draft.config.tidy)


def throw_away(draft: Draft, slots: Slots) -> None:
    _sort(draft, things(draft, slots["thing"], prefer_held=True), draft.config.throw)


def tidy(draft: Draft, slots: Slots) -> None:
    """Everything on a surface, in a room or in the whole flat goes where the rules say."""
    where = _area(draft, slots)
    surfaces = draft.vocabulary.surfaces() if where is None else _surfaces_of(draft, where)
    name = "place" if where is None else where.name
    names = {r.name for r in surfaces}
    there = [t for t in draft.world.things if t.on in names and not t.held]
    draft.look_at(surfaces)
    if not there:
        draft.look_first(surfaces, f"I have not seen what lies on the {name} yet, so send me there first")
    near = sorted(there, key=lambda t: (draft.world.distance(t), t.label))
    _sort(draft, [Meant(t) for t in near], draft.config.tidy, quiet=True)
    if not any(t.on != _now(draft, t.label) for t in there):
        draft.say(f"The {name} is tidy already.")


def _now(draft: Draft, label: str) -> str:
    return next((t.on for t in draft.world.things if t.label == label), "")


def _sort(draft: Draft, everything: Iterable[Meant], rules: tuple[Rule, ...], quiet: bool = False) -> None:
    """Each where its rule says; what is there already stays."""
    moved = list(everything)
    for meant in moved:
        where = draft.destination(meant.thing, rules)
        if meant.thing.on != where.name or meant.thing.held:
            take(draft, meant)
            draft.place(where)
        elif not quiet:
            draft.say(f"The {meant.thing.label} is in its place already.")
    draft.last = [m.thing for m in moved]


def _area(draft: Draft, slots: Slots) -> Spot | None:
    words = slots.get("spot", ())
    phrase = " ".join(w for w in words if w not in ("the", "my", "this", "whole", "entire", "all"))
    if phrase in ("", "up", "flat", "apartment", "house", "home", "place", "everything", "mess"):
        return None
    if phrase in ("room", "here"):
        x, y, _ = draft.world.pose
        room = draft.world.scene.room_at(x, y)
        return Spot(room.name, room=True) if room else None
    where = spot(draft, words)
    if where.receptacle is None and not where.room:
        raise Refusal(f"I do not know how to tidy up the {where.name}")
    return where


def _surfaces_of(draft: Draft, where: Spot) -> list[Receptacle]:
    if where.receptacle is None:
        return draft.vocabulary.surfaces(where.name)
    if where.receptacle.depth:
        raise Refusal(f"I cannot empty the {where.name}")
    return [where.receptacle]
