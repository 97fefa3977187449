"""Recovery: objects that may be the one that is looked for, but cannot be told from here, are looked at from nearer,
and then from other sides."""

import math
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from common import messages as m
from common import topics
from common.geometry import Pose2
from common.topic import Topic
from services.brain.mission.context import Context
from services.brain.mission.mission import SIDES, Failure
from services.brain.recoveries.clarify import ask_which, several_match
from services.brain.recoveries.identify import ask_about_the_near, near_possible
from services.brain.recoveries.recovery import Recovery, Task, with_recoveries
from services.brain.steps.find import LocateObject
from services.brain.steps.leaf import SendGoal, Settle
from services.brain.tree.composites import Retry, Sequence
from services.brain.world.reading_poses import reading_pose
from services.brain.world.standing_poses import standing_pose

MOST = 8
"""Looks from nearer, one after the other, for one view (chosen: at as many objects as stand on a table, and at some of
them from another side)."""
AFTER_A_CLOSER_LOOK = (
    Recovery("several_match", several_match, ask_which),
    Recovery("identify_near", near_possible, ask_about_the_near),
)


class MoveCloser(SendGoal):
    """Drives before the first of the objects that may be meant: of those that were looked at from nearer least often.

    One that was looked at is seen from another side.
    """

    def __init__(self, node_id: str, ctx: Context) -> None:
        limit = ctx.config.navigation_timeout
        super().__init__(node_id, ctx, ctx.peers.navigation, state="GROUNDING", timeout=limit)
        self._target: m.WorldObject | None = None

        self._pose: Pose2 | None = None

    def initialise(self) -> None:
        super().initialise()
        ctx, search = self.ctx, self.ctx.mission.search
        self._target = self._pose = None
        while self._pose is None and search.unsure:
            label = min(search.unsure, key=lambda name: len(search.inspected.get(name, ())))
            search.unsure = [other for other in search.unsure if other != label]
            found, seen_from = ctx.known_object(label), search.inspected.get(label, [])
            if found is None:
                continue
            x, y, _ = found.position
            plan, here = ctx.io.household, ctx.robot_pose
            self._pose = reading_pose(plan, (x, y), here, seen_from) if seen_from else standing_pose(plan, (x, y), here)
            # One that cannot be reached, or has no other side, is not tried again either.
            angles = [math.atan2(self._pose[1] - y, self._pose[0] - x)] if self._pose else [0.0] * SIDES
            search.inspected = {**search.inspected, label: [*seen_from, *angles]}
            self._target = found
        ctx.mission.at = ""

    def update(self) -> Status:
        if self._pose is None:
            self.feedback_message = "nothing left to look at from nearer"
            self.ctx.record_failure(Failure("GROUNDING", "NOT_FOUND", self.feedback_message, self.spoken()))
            return Status.FAILURE
        return super().update()

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        assert self._pose is not None
        x, y, theta = self._pose
        return topics.NAV_GOAL, m.NavGoal(id=goal_id, x=x, y=y, theta=theta)

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
        with_recoveries("look_or_ask", ctx, looked, AFTER_A_CLOSER_LOOK, task),
    )
    return Retry("look_closer", ctx, look, MOST - 1, again=lambda: unsure(ctx))


def unsure(ctx: Context) -> bool:
    """Perception named objects that may be meant and were not looked at from nearer in this mission."""
    return bool(ctx.mission.search.unsure) and not ctx.mission.failed_for_good
