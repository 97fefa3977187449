"""Recovery: when several objects match, ask which of them was meant and look for that one."""

from py_trees.behaviour import Behaviour

from common.naming.names import unnumbered
from services.brain.mission.context import Context
from services.brain.recoveries.recovery import Task
from services.brain.steps.ask import AskQuestion, HearChoice, which
from services.brain.steps.find import LocateObject
from services.brain.tree.composites import Retry, Sequence


def ask_which(ctx: Context, task: Task) -> Behaviour:
    """Ask until the answer names one of them, and look for that one."""
    return asked_which(ctx, task.item, LocateObject("look_for_the_one_meant", ctx, task.item))


def asked_which(ctx: Context, item: str, then: Behaviour) -> Behaviour:
    """Ask which one is meant until `then` succeeds with the answer, at most `max_retry_attempts` times."""
    question = AskQuestion("which", ctx, lambda: which(ctx))
    ask = Sequence("ask_which", question, HearChoice("hear_choice", ctx, item), then)
    return Retry("clarify", ctx, ask, ctx.config.max_retry_attempts - 1, again=lambda: not ctx.mission.failed_for_good)


def several_match(ctx: Context) -> bool:
    """Perception named more than one object that the words can mean, and their names tell them from each other.

    Nobody is asked while some of them can be told better from nearer, and nobody who has not answered.
    """
    search = ctx.mission.search
    if search.unsure or search.unanswered:
        return False
    names = {unnumbered(name) for name in search.options}
    return len(names) > 1 or (len(search.options) > 1 and not search.perhaps)
