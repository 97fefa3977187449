"""Recovery: an object that may be the one asked for is asked about, before anything is brought or given up."""

from functools import partial

from py_trees.behaviour import Behaviour

from common import messages as m
from common.naming.likeness import LEAST, LIKELY
from services.brain.mission.context import Context
from services.brain.recoveries.recovery import Task
from services.brain.steps.find import LocateObject
from services.brain.steps.identify import ANOTHER, MOST_ASKED, ask_identity, candidates
from services.brain.tree.composites import Retry, Sequence


def ask_whether(
    ctx: Context, task: Task, least: float = LIKELY, near: bool = False, there: bool = False, most: int = MOST_ASKED
) -> Behaviour:
    """Ask about the likeliest objects, then about the next, until the person says that one is the one that is meant, at
    `most` so often; `least` and `near` as of `candidates`, `there`: of what is where it was said to be."""

    def left() -> list[m.PossibleObject]:
        return candidates(ctx, least, near, ctx.told_place(task.item) if there else "")

    ask = ask_identity(ctx, lambda: task.item, left, LocateObject("look_for_the_one_meant", ctx, task.item))
    return Retry("identify", ctx, ask, most - 1, again=lambda: was_another(ctx) and bool(left()))


def ask_and_grab(ctx: Context, task: Task) -> Behaviour:
    """Ask which object is meant, the one before the robot first; approach and grab the one that the person confirms."""
    asked = ask_whether(ctx, task, LEAST)
    return Sequence("ask_and_grab", asked, task.approach(), task.grab())


def may_be(ctx: Context, least: float = LIKELY, near: bool = False, place: str = "") -> bool:
    """An object is seen that may be the one asked for, and nobody was asked about it."""
    return not ctx.mission.failed_for_good and bool(candidates(ctx, least, near, place))


def was_another(ctx: Context) -> bool:
    """The person has said that it was not the one."""
    return ctx.mission.failed_with(ANOTHER)


ask_about_the_near, near_possible = partial(ask_whether, near=True), partial(may_be, near=True)
"""Between one look from nearer and the next: what was looked at, and may be it still."""
ask_about_the_rest = partial(ask_whether, least=LEAST)
"""After the search: also what fits the words badly, because nothing fits them better."""
remains_possible = partial(may_be, least=LEAST)
