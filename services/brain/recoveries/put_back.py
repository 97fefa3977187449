"""Recovery: what was taken in place of the object is put back on its surface, and the object is grabbed anew."""

import math

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from services.brain.mission.context import Context
from services.brain.recoveries.recovery import Task
from services.brain.recoveries.regrasp import regrasp
from services.brain.steps.find import label_of
from services.brain.steps.leaf import Call, Leaf, Settle
from services.brain.steps.motion import ANOTHER_HELD, Release
from services.brain.tree.composites import Sequence

STOOD_STILL = 0.03
"""Distance [m] within which the object still is where it was found. Chosen: half of what lies between the middles of
neighbours that touch; it is seen to a centimetre."""


class HoldsWhatWasMeant(Leaf):
    """FAILURE when pictures since the hand closed show the object where it was, and something else in the hand."""

    def __init__(self, ctx: Context, item: str) -> None:
        super().__init__("holds_what_was_meant", ctx)
        self._item = item

    def update(self) -> Status:
        ctx, found = self.ctx, self.ctx.mission.search.found.get(self._item)
        meant = next((o for o in ctx.objects if found is not None and o.id and o.id == found.id), None)
        held = next((o for o in ctx.objects if o.held), None)
        if found is None or meant is None or held is None or held is meant or meant.seen_at <= held.seen_at:
            return Status.SUCCESS
        if math.dist(meant.position[:2], found.position[:2]) > STOOD_STILL:
            return Status.SUCCESS
        detail = f"the {meant.label} is seen where it was, and the {held.label} is in the hand"
        return ctx.fail("GRABBING", ANOTHER_HELD, detail, f"I took something else for the {self._item}.")


def put_back(ctx: Context, task: Task) -> Behaviour:
    """Place it where the object stands, which the hand does not hold after all, then grab again."""
    away = Release("place_it_back", ctx, lambda: f"place {ctx.origin_of(label_of(ctx, task.item))}")
    empty, still = Call("hand_is_empty", ctx, lambda: _forget(ctx)), Settle("settle", ctx)
    return Sequence("put_back", away, empty, still, regrasp(ctx, task))


def took_another(ctx: Context) -> bool:
    """The hand holds something else, and the surface from which it comes is known."""
    return ctx.mission.failed_with(ANOTHER_HELD) and bool(ctx.origin_of(ctx.gripper.holding))


def _forget(ctx: Context) -> None:
    """Nothing of what was asked for was put down."""
    delivery = ctx.mission.delivery
    delivery.released, delivery.put_down, delivery.grabbed = False, "", False
    ctx.mission.at = ""
