"""Recovery: objects that may be the one that is looked for, but cannot be told from here, are looked at from nearer,
and then from other sides."""

import math
from collections.abc import Callable, Collection
from functools import partial

from py_trees.behaviour import Behaviour

from common import messages as m
from services.brain.mission.context import Context
from services.brain.mission.search import ALL_SIDES
from services.brain.recoveries.clarify import ask_which, several_match
from services.brain.recoveries.identify import ask_about_the_near, near_possible
from services.brain.recoveries.recovery import Recovery, Task, with_recoveries
from services.brain.steps.find import LocateObject
from services.brain.steps.leaf import Settle
from services.brain.steps.views import GoAndLook
from services.brain.tree.composites import Retry, Sequence
from services.brain.world.standing_poses import reading_pose, standing_pose

MOST = 8
"""Looks from nearer, one after the other, for one view (chosen: at as many objects as stand on a table, and at some of
them from another side)."""
MOST_OF_THE_REST = 5
"""Such looks after the search [count]. Chosen: each takes some ten seconds, and little comes of them."""
AFTER_A_CLOSER_LOOK = (
    Recovery("several_match", several_match, ask_which),
    Recovery("identify_near", near_possible, ask_about_the_near),
)


class MoveCloser(GoAndLook):
    """Drives before one of the objects that may be meant, of which `left` tells, one after the other.

    One that was looked at is seen from another side.
    """

    NOTHING_LEFT = ("NOT_FOUND", "nothing left to look at from nearer")

    def __init__(self, node_id: str, ctx: Context, left: Callable[[Context], list[m.WorldObject]]) -> None:
        super().__init__(node_id, ctx)
        self._left = left
        self._target: m.WorldObject | None = None

    def initialise(self) -> None:
        super().initialise()
        ctx, search = self.ctx, self.ctx.mission.search
        self._target = self.view = None
        plan, here = ctx.io.household, ctx.robot_pose
        while self.view is None and (left := self._left(ctx)):
            found = min(left, key=lambda o: len(search.directions(o)))
            search.drop(found.label)
            x, y, _ = found.position
            seen_from = search.directions(found)
            self.view = reading_pose(plan, (x, y), here, seen_from) if seen_from else standing_pose(plan, (x, y), here)
            # One that cannot be reached, or has no other side, is not tried again either.
            angles = [math.atan2(self.view[1] - y, self.view[0] - x)] if self.view else [0.0] * ALL_SIDES
            search.looked_near(found, angles)
            self._target = found
        ctx.mission.at = ""

    def step(self) -> str:
        return f"look closer at {self._target.label}" if self._target is not None else "look closer"

    def spoken(self) -> str:
        return "I could not look at it from nearer."


def look_closer(
    ctx: Context, task: Task, left: Callable[[Context], list[m.WorldObject]] | None = None, most: int = MOST
) -> Behaviour:
    """Drive up to one of them after the other and look again, until one is the object or none is `left`."""
    looked = LocateObject("look", ctx, task.item)
    left = left or promising
    look = Sequence(
        "closer_view",
        MoveCloser("closer", ctx, left),
        Settle("settle", ctx),
        with_recoveries("look_or_ask", ctx, looked, AFTER_A_CLOSER_LOOK, task),
    )
    return Retry("look_closer", ctx, look, most - 1, again=lambda: bool(left(ctx)), at_once=True)


def promising(ctx: Context) -> list[m.WorldObject]:
    """The objects that may be meant and can be told from nearer, of those in this room if none of them was asked for.

    What is seen through a door is seen again from its own room.
    """
    search, plan = ctx.mission.search, ctx.io.household
    x, y, _ = ctx.robot_pose
    room = plan.room_at(x, y)
    known = _known(ctx, search.unsure)
    return known if search.options else [o for o in known if plan.room_at(o.position[0], o.position[1]) is room]


def remaining(ctx: Context) -> list[m.WorldObject]:
    """All objects that may be meant and can be told from nearer, the nearest first."""
    known = _known(ctx, [*ctx.mission.search.unsure, *ctx.mission.search.unlikely])
    return sorted(known, key=lambda o: math.dist(o.position[:2], ctx.robot_pose[:2]))


def _known(ctx: Context, labels: Collection[str]) -> list[m.WorldObject]:
    if ctx.mission.failed_for_good:
        return []
    return [o for label in labels if (o := ctx.known_object(label)) is not None]


def unsure(ctx: Context) -> bool:
    """Perception named objects that may be meant, and they are worth a look before the search goes on."""
    return bool(promising(ctx))


look_at_the_rest = partial(look_closer, left=remaining, most=MOST_OF_THE_REST)
"""After the search: also at what is unlikely to be meant, because nothing else was."""


def unseen_from_near(ctx: Context) -> bool:
    """The search has left objects that may be meant and were not looked at from nearer."""
    return bool(remaining(ctx))
