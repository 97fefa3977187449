"""The rules that every plan obeys, whoever made it. Pure: a plan and the known world in, the reason against it out."""

from collections.abc import Sequence

import msgspec

from common.household import Household
from common.kinds import kind_of
from common.messages import AROUND, KnownWorld, PlanStep
from common.robot.grip import OPENING

MAX_STEPS = 60
"""Chosen: 15 objects of four steps each, more than any household has."""


class Objection(msgspec.Struct, frozen=True):
    """Why a plan cannot be carried out, as a clause that can be spoken; `step`: number from 1, 0 for the whole plan."""

    step: int
    reason: str

    def __str__(self) -> str:
        return f"step {self.step}: {self.reason}" if self.step else self.reason


def known_world(household: Household, seen: Sequence[str], held: str) -> KnownWorld:
    """What the planner is told and plans are checked against."""
    places = [household.home.name, *(p.name for p in household.places), *(r.name for r in household.rooms)]
    return KnownWorld(
        objects=list(dict.fromkeys(seen)),
        places=list(dict.fromkeys(places)),
        receptacles=[r.name for r in household.receptacles],
        held=held,
    )


def objection(
    steps: Sequence[PlanStep], world: KnownWorld, household: Household, max_steps: int = MAX_STEPS
) -> Objection | None:
    """The first objection to a plan; None when it can be carried out.

    Names are the household's, its aliases, kinds of objects, labels in `world`, or words for a thing that nobody has
    listed: whether there is one only looking can tell.
    """
    if not steps:
        return Objection(0, "the plan has no steps")
    if len(steps) > max_steps:
        return Objection(0, f"the plan has {len(steps)} steps")
    held, found = world.held, set[str]()
    for number, step in enumerate(steps, 1):
        reason = _objection(step, held, found, world, household)
        if reason:
            return Objection(number, reason)
        if step.hand_alone:
            continue
        if step.action == "find":
            found.add(_name(step.object, household))
        elif step.action == "grasp":
            held = step.object
        elif step.action in ("place", "release"):
            held = ""
    return None


def _objection(step: PlanStep, held: str, found: set[str], world: KnownWorld, household: Household) -> str:
    match step.action:
        case "grasp" | "release" if step.hand_alone:
            return f"the hand holds the {held}, which has to be put down" if held else ""
        case "find":
            return _not_a_thing(step.object, world, household)
        case "grasp":
            return _no_grasp(step.object, held, found, world, household)
        case "place":
            if not held:
                return "there is nothing in the hand to place"
            if no_surface := _no_surface(step.target, household):
                return no_surface
            return _not_a_thing(step.near, world, household) if step.near else ""
        case "release":
            return "" if held else "there is nothing in the hand to release"
        case "navigate" if step.target == AROUND:
            return ""
        case "navigate":
            where = step.target or step.object
            known = is_destination(where, household) or where in found or _is_listed(where, world, household)
            return "" if known else f"I know no {where}"
        case "say":
            return "" if step.text.strip() else "there is nothing to say"
        case "teach" | "forget" | "name":
            return "" if step.text.strip() else "no name was said"
        case "rule":
            if not step.object.strip():
                return "no thing was said that the rule is about"
            return _no_surface(step.target, household)
        case _:
            return ""


def _no_surface(name: str, household: Household) -> str:
    return "" if household.receptacle(name) else f"there is no {name or 'place'} to put things on"


def _no_grasp(thing: str, held: str, found: set[str], world: KnownWorld, household: Household) -> str:
    if not_a_thing := _not_a_thing(thing, world, household):
        return not_a_thing
    if held:
        return f"the hand already holds the {held}"
    if _name(thing, household) not in found:
        return f"the {thing} must be found before it can be grasped"
    return _too_big(thing, household)


def is_destination(name: str, household: Household) -> bool:
    """A place, room or receptacle, by name or alias."""
    places = any(name == p.name or name in p.aliases for p in (household.home, *household.places))
    return (
        places or any(name == r.name or name in r.aliases for r in household.rooms) or bool(household.receptacle(name))
    )


def _name(thing: str, household: Household) -> str:
    spec = household.thing(thing)
    return spec.name if spec else thing


def _is_listed(thing: str, world: KnownWorld, household: Household) -> bool:
    """Is it named in the household, by kind or name, or has it been seen?"""
    return bool(household.thing(thing)) or thing in world.objects or thing in {o.kind for o in household.things}


def _not_a_thing(thing: str, world: KnownWorld, household: Household) -> str:
    if not thing:
        return "no object is named"
    if _is_listed(thing, world, household):
        return ""
    fixed = is_destination(thing, household) or any(thing in (f.name, *f.name.split()) for f in household.furniture)
    return f"I know no {thing} that I could pick up" if fixed else ""


def _too_big(thing: str, household: Household) -> str:
    """Bowls are gripped at the rim; everything else between the pads."""
    spec = household.thing(thing)
    if spec is None or kind_of(spec.kind).by_the_rim or min(spec.size) <= OPENING:
        return ""
    return f"the {thing} does not fit into the gripper"
