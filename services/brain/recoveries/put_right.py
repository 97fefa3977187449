"""Recovery: what was lost on the way or does not stand where it belongs is picked up and put down again."""

from py_trees.behaviour import Behaviour

from services.brain.mission.context import Context
from services.brain.recoveries.recovery import Task
from services.brain.steps.leaf import Call, Say
from services.brain.steps.motion import LOST
from services.brain.steps.verify import is_misplaced
from services.brain.tree.composites import Retry, Selector, Sequence


def put_right(ctx: Context, task: Task) -> Behaviour:
    """Say what is wrong, look for the object, and unless it stands where it belongs by now bring it again."""
    bring = Sequence("bring_it_again", task.grasp(), task.carry_back(), task.put_down())
    again = Sequence(
        "put_it_right",
        Say("say_what_is_wrong", ctx, lambda: announcement(ctx)),
        Call("look_again", ctx, lambda: forget_place(ctx)),
        task.find(),
        Selector("where_it_belongs", task.in_place(), bring),
    )
    return Retry("put_right", ctx, again, ctx.config.put_right_attempts - 1, again=lambda: needs_replacing(ctx))


def needs_replacing(ctx: Context) -> bool:
    """The object was lost on the way, or the look showed it not where, or not as, it belongs."""
    return is_misplaced(ctx) or ctx.mission.failed_with(*LOST)


def announcement(ctx: Context) -> str:
    """What is said before the object is picked up again."""
    failure = ctx.mission.failure
    return f"{failure.spoken} I will try again." if failure and is_misplaced(ctx) else ""


def forget_place(ctx: Context) -> None:
    """The robot does not stand where the object is any more."""
    ctx.mission.at = ""
