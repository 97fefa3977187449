"""Recovery: an object that is not in view is looked for by turning, then from other viewpoints, then reported."""

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from common.naming.likeness import LEAST, ROUGHLY
from common.naming.names import normalise
from services.brain.mission.context import Context
from services.brain.mission.remarks import PERSON
from services.brain.recoveries.clarify import ask_which, several_match
from services.brain.recoveries.identify import ask_whether, may_be
from services.brain.recoveries.look_closer import look_closer, unsure
from services.brain.recoveries.recovery import Recovery, Task, with_recoveries
from services.brain.steps.find import LocateObject, ReportNotFound, known_by_name
from services.brain.steps.identify import MOST_ASKED
from services.brain.steps.leaf import Settle
from services.brain.steps.views import MoveToViewpoint
from services.brain.tree.composites import Condition, Retry, Selector, Sequence
from services.brain.world.placement import may_lie_flat

VIEWPOINTS, FROM_NEAR, THERE = (2, 5, 9), 9, 12
"""Viewpoints of each search attempt, the last for all that follow (chosen: near and cheap first), how many are from
near after that where something may lie flat, and how many where it was said to be (chosen: the floor of a room)."""
UNFAMILIAR = 0.065
"""Likeness to a name that says nothing of looks from which a thing is asked about before the last attempt. Chosen: what
is no plain mug or can, whose own word would have been said."""
AFTER_A_GLANCE = (
    Recovery("several_match", several_match, ask_which),
    Recovery("look_closer", unsure, look_closer),
    Recovery("identify", may_be, ask_whether),
)


def search(ctx: Context, task: Task) -> Behaviour:
    """Where it was said to be, then `max_retry_attempts` attempts, of which the first turns on the spot and the others
    go to where more can be seen, then from near what may lie flat.

    What may be meant is asked about before them where it was said where it is, and before the last one: at once what
    fits ROUGHLY, and whatever is UNFAMILIAR for words of which one says nothing of looks, a yellow trophy, a magnifying
    glass: to look on for it would not tell which it is. So is whatever fits at all once that place, or everything, has
    been looked at: to look on takes minutes, a question seconds.
    """
    numbers = range(1, ctx.config.max_retry_attempts + 1)
    *first, last = [
        _attempt(ctx, task, f"attempt {n}", VIEWPOINTS[min(n, len(VIEWPOINTS)) - 1], n > 1) for n in numbers
    ]
    flat = may_lie_flat(task.item, ctx.io.household)
    looked_there = _attempt(ctx, task, "there", THERE, there=True, near=flat)
    there = Selector("there", _ask(ctx, task), looked_there, _ask_all(ctx, task, True))
    told = Condition("told", there, lambda: bool(ctx.told_place(task.item)), Status.FAILURE)
    near = [_ask_all(ctx, task), _attempt(ctx, task, "from near", FROM_NEAR, near=True)]
    return Selector("search", told, *first, _ask(ctx, task, False), last, *(near if flat else []))


def _ask(ctx: Context, task: Task, there: bool = True) -> Condition:
    words = normalise(task.item).split()
    least = ROUGHLY if all(known_by_name(ctx, task.item, word) for word in words) else UNFAMILIAR
    return _asked(ctx, task, f"unknown_{'there' if there else 'anywhere'}", least, there)


def _ask_all(ctx: Context, task: Task, there: bool = False) -> Condition:
    return _asked(ctx, task, "all_there" if there else "all", LEAST, there, most=1)


def _asked(ctx: Context, task: Task, node_id: str, least: float, there: bool, most: int = MOST_ASKED) -> Condition:
    def worth_it() -> bool:
        return may_be(ctx, least, place=ctx.told_place(task.item) if there else "")

    return Condition(node_id, ask_whether(ctx, task, least, there=there, most=most), worth_it, Status.FAILURE)


def _attempt(
    ctx: Context, task: Task, label: str, most: int, elsewhere: bool = True, there: bool = False, near: bool = False
) -> Behaviour:
    looked = LocateObject("look", ctx, task.item)
    look = Sequence(
        "view",
        MoveToViewpoint("viewpoint", ctx, label, task.item, elsewhere, there, near),
        Settle("settle", ctx),
        with_recoveries("look_or_ask", ctx, looked, AFTER_A_GLANCE, task),
        name=f"view of {label}",
    )
    more, free = (lambda: more_to_see(ctx)), (lambda: kept_away(ctx))
    return Retry("attempt", ctx, look, most - 1, more, label, free, at_once=True)


def can_go_on(ctx: Context) -> bool:
    """The failure at hand is none that forbids to look on."""
    return not ctx.mission.failed_for_good


def more_to_see(ctx: Context) -> bool:
    """Looking on may help, and not everything has been looked at."""
    return can_go_on(ctx) and not ctx.mission.failed_with("NOTHING_NEW")


def kept_away(ctx: Context) -> bool:
    """People kept the robot from a view, and it has not been so for as long as it waits for people on any other way."""
    lost = len(ctx.mission.search.unreached) * ctx.config.view_patience
    return ctx.mission.failed_with(PERSON) and lost <= ctx.config.people_patience


def report_not_found(ctx: Context, task: Task) -> Behaviour:
    """The search has ended without result: the reason that counts, whatever failed last."""
    return ReportNotFound("not_found", ctx, task.item, ctx.config.max_retry_attempts)
