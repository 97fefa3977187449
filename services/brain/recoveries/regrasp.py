"""Recovery: after a failed grab look again, drive up again, grab again."""

from py_trees.behaviour import Behaviour

from services.brain.mission.context import Context
from services.brain.recoveries.recovery import Task
from services.brain.steps.find import label_of
from services.brain.steps.identify import not_plain
from services.brain.steps.motion import ANOTHER_HELD
from services.brain.tree.composites import Retry, Sequence

STANCES = 2
"""Other stances that are gone to for one try. Chosen: each costs some ten seconds, the third rarely helps."""


def regrasp(ctx: Context, task: Task) -> Behaviour:
    """Find, approach and grab, `grab_retries` times; what was only stood before wrongly is no try."""
    once = Sequence("look_and_grab_again", task.find(), task.approach(), task.grab())
    again = Retry("from_another_stance", ctx, once, STANCES, again=lambda: stands_wrongly(ctx, task.item))
    more = max(0, ctx.config.grab_retries - 1)
    return Retry("regrasp", ctx, again, more, again=lambda: grab_failed(ctx) and not not_plain(ctx))


def grab_failed(ctx: Context) -> bool:
    """Manipulation could not grab it, and trying again may help."""
    failure = ctx.mission.failure
    if failure is None or ctx.mission.failed_with(ANOTHER_HELD):
        return False
    return failure.stage == "GRABBING" and not failure.permanent


def stands_wrongly(ctx: Context, item: str) -> bool:
    """Manipulation has not tried, and says where else it can."""
    return grab_failed(ctx) and label_of(ctx, item) in ctx.mission.search.stances
