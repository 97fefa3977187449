"""Putting down with a look afterwards: what is not where it belongs is said, picked up and put down again."""

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Selector, Sequence

from services.brain.behaviours import Do, Say, Settle
from services.brain.check import InPlace, astray, checked
from services.brain.context import Context
from services.brain.decorators import Attempts, When
from services.brain.robot import LOST, Release


def put_and_check(ctx: Context, name: str, goal: str, target: str) -> Behaviour:
    """Carry out the `goal` that opens the hand, let physics settle, look.

    `target`: the receptacle where the object belongs; "" anywhere.
    """
    steps = [Release(name, ctx, lambda: goal), Settle("settle", ctx), checked(ctx, target)]
    return Sequence(name=f"{name} and look", memory=True, children=steps)


def put_right(
    ctx: Context, thing: str, find: Behaviour, grasp: Behaviour, back: Behaviour, goal: str, target: str
) -> Behaviour:
    """Put down and look; what was lost on the way or is not where it belongs is picked up and brought `back` again."""
    last = put_and_check(ctx, "put down at last", goal, target)
    bring = Sequence(name="bring it again", memory=True, children=[grasp, back, last])
    in_place = InPlace("in place already", ctx, thing, target)
    steps = [
        Say("say what is wrong", ctx, lambda: announcement(ctx)),
        Do("look again", ctx, lambda: forget_place(ctx)),
        find,
        Selector(name="where it belongs", memory=True, children=[in_place, bring]),
    ]
    again = Sequence(name="put it right", memory=True, children=steps)
    rounds = Attempts("put right", ctx, again, ctx.config.put_right_attempts - 1, again=lambda: amiss(ctx))
    mend = When("lost or not where it belongs", rounds, lambda: amiss(ctx), Status.FAILURE)
    first = put_and_check(ctx, "put down", goal, target)
    return Selector(name=f"put down {thing}", memory=True, children=[first, mend])


def amiss(ctx: Context) -> bool:
    """The object was lost on the way, or the look showed it not where, or not as, it belongs."""
    failure = ctx.mission.failure
    return astray(ctx) or (failure is not None and failure.code in LOST)


def announcement(ctx: Context) -> str:
    failure = ctx.mission.failure
    return f"{failure.spoken} I will try again." if failure and astray(ctx) else ""


def forget_place(ctx: Context) -> None:
    """The robot does not stand where the thing is any more."""
    ctx.mission.at = ""
