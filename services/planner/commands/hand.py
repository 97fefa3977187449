"""What is done with the hand: picking up, putting down, opening, closing. Pure."""

from common.language.noun_phrase import PLURAL_PRONOUNS, PRONOUNS
from common.language.pattern import Slots
from services.planner.grammar.senses import is_alive
from services.planner.plan_builder import PlanBuilder, Refusal
from services.planner.reference.pronouns import Referent
from services.planner.reference.resolve import referent, referents


def pick_up(builder: PlanBuilder, slots: Slots) -> None:
    everything = referents(builder, slots["thing"], prefer_held=True)
    meant = everything[0]
    if len(everything) > 1:
        builder.collect([m.object for m in everything])
        return
    if meant.object.held:
        builder.say(f"I am holding the {meant.object.label} already.")
        builder.last = [meant.object]
        return
    if builder.world.held and any(s.action == "grasp" for s in builder.steps):
        raise Refusal("I can hold only one thing at a time")
    take(builder, meant)


def put_down(builder: PlanBuilder, slots: Slots) -> None:
    if "thing" not in slots or " ".join(slots["thing"]) in PRONOUNS | PLURAL_PRONOUNS:
        builder.release()
        return
    meant = referent(builder, slots["thing"], prefer_held=True)
    if not meant.object.held:
        raise Refusal(f"I am not holding the {meant.object.label}")
    builder.release()


def open_hand(builder: PlanBuilder, slots: Slots) -> None:
    if builder.world.held is None:
        builder.hand_alone("release")
    else:
        builder.release()


def close_hand(builder: PlanBuilder, slots: Slots) -> None:
    if (held := builder.world.held) is None:
        builder.hand_alone("grasp")
    else:
        builder.say(f"I am holding the {held.label}.")


def take(builder: PlanBuilder, meant: Referent) -> None:
    """Look for it where it is said to be, and grasp it."""
    if is_alive(tuple(meant.object.label.split())):
        raise Refusal("I pick up neither people nor animals")
    if meant.at is not None and not meant.object.seen:
        builder.go(meant.at)
    builder.take(meant.object, meant.words)
