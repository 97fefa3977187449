"""Recovery: after a failed grab look again, drive up again, grab again."""

from py_trees.behaviour import Behaviour

from services.brain.mission.context import Context
from services.brain.recoveries.recovery import Task
from services.brain.steps.identify import not_plain
from services.brain.steps.leaf import Settle
from services.brain.tree.composites import Retry, Sequence


def regrasp(ctx: Context, task: Task) -> Behaviour:
    """Find, approach and grab, `grab_retries` times."""
    again = Sequence("look_and_grab_again", task.find(), task.approach(), task.grab(), Settle("settle", ctx))
    more = max(0, ctx.config.grab_retries - 1)
    return Retry("regrasp", ctx, again, more, again=lambda: grab_failed(ctx) and not not_plain(ctx))


def grab_failed(ctx: Context) -> bool:
    """Manipulation could not grab it, and trying again may help."""
    failure = ctx.mission.failure
    return failure is not None and failure.stage == "GRABBING" and not failure.permanent
