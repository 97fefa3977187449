"""Recovery: objects that may be the one that is looked for, but cannot be told from here, are looked at from nearer."""

from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from common import messages as m
from common import topics
from common.topics import Topic
from services.brain.mission.context import Context
from services.brain.mission.mission import Failure
from services.brain.recoveries.clarify import ask_which, several_match
from services.brain.recoveries.recovery import Recovery, Task, with_recoveries
from services.brain.steps.find import LocateObject
from services.brain.steps.leaf import SendGoal, Settle
from services.brain.tree.composites import Retry, Sequence
from services.brain.world.standing_poses import standing_pose

MOST = 6
"""Objects looked at from nearer, one after the other, for one view (chosen: as many as stand on a table)."""
SEVERAL = (Recovery("several_match", several_match, ask_which),)


class MoveCloser(SendGoal):
    """Drives before the first of the objects that may be meant and were not looked at from nearer yet."""

    def __init__(self, node_id: str, ctx: Context) -> None:
        limit = ctx.config.navigation_timeout
        super().__init__(node_id, ctx, ctx.peers.navigation, state="GROUNDING", timeout=limit)
        self._target: m.WorldObject | None = None

    def initialise(self) -> None:
        super().initialise()
        ctx, search = self.ctx, self.ctx.mission.search
        known = [o for label in search.unsure if (o := ctx.known_object(label)) is not None]
        self._target = known[0] if known else None
        if self._target is not None:
            # One that cannot be reached is not tried a second time either.
            search.inspected = [*search.inspected, self._target.label]
            search.unsure = [label for label in search.unsure if label != self._target.label]
        ctx.mission.at = ""

    def update(self) -> Status:
        if self._target is None:
            self.feedback_message = "nothing left to look at from nearer"
            self.ctx.record_failure(Failure("GROUNDING", "NOT_FOUND", self.feedback_message, self.spoken()))
            return Status.FAILURE
        return super().update()

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        assert self._target is not None
        ctx, (x, y, _) = self.ctx, self._target.position
        pose = standing_pose(ctx.io.household, (x, y), ctx.robot_pose)
        return topics.NAV_GOAL, m.NavGoal(id=goal_id, x=pose[0], y=pose[1], theta=pose[2])

    def step(self) -> str:
        return f"look closer at {self._target.label}" if self._target is not None else "look closer"

    def spoken(self) -> str:
        return "I could not look at it from nearer."


def look_closer(ctx: Context, task: Task) -> Behaviour:
    """Drive up to one of them after the other and look again, until one is the object or none is left."""
    looked = LocateObject("look", ctx, task.item)
    look = Sequence(
        "closer_view",
        MoveCloser("closer", ctx),
        Settle("settle", ctx),
        with_recoveries("look_or_ask", ctx, looked, SEVERAL, task),
    )
    return Retry("look_closer", ctx, look, MOST - 1, again=lambda: unsure(ctx))


def unsure(ctx: Context) -> bool:
    """Perception named objects that may be meant and were not looked at from nearer in this mission."""
    return bool(ctx.mission.search.unsure) and not ctx.mission.failed_for_good
