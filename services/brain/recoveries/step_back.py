"""Recovery: what was found and is not seen there any more may lie on the floor before it: look from farther back."""

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from services.brain.mission.context import Context
from services.brain.recoveries.recovery import Task
from services.brain.steps.find import LocateObject
from services.brain.steps.leaf import Settle
from services.brain.steps.views import GoAndLook
from services.brain.tree.composites import Condition, Sequence
from services.brain.world.standing_poses import reading_pose

BACK = (1.2, 1.4, 1.6)
"""Distances [m] of the base from where it was. Chosen: the head camera sees the floor from half a metre on, and what
rolls comes towards the robot."""


class StepBack(GoAndLook):
    """Drives to where the floor shows before what the `item` was found on."""

    NOTHING_LEFT = ("NOT_FOUND", "there is no room to look from")

    def __init__(self, ctx: Context, item: str) -> None:
        super().__init__("step_back", ctx)
        self._item = item

    def initialise(self) -> None:
        super().initialise()
        ctx, found = self.ctx, self.ctx.mission.search.found.get(self._item)
        self.view = reading_pose(ctx.io.household, found.position[:2], ctx.robot_pose, [], BACK) if found else None
        ctx.mission.at = ""

    def step(self) -> str:
        return f"step back and look for {self._item}"

    def spoken(self) -> str:
        return "I could not step back."


def step_back(ctx: Context, task: Task) -> Behaviour:
    """Look once from farther back, if it was found before."""
    look = LocateObject("look_from_there", ctx, task.item)
    back = Sequence("from_farther_back", StepBack(ctx, task.item), Settle("settle", ctx), look)
    return Condition("was_found", back, lambda: task.item in ctx.mission.search.found, Status.FAILURE)


def may_have_fallen(ctx: Context) -> bool:
    """Something was found in this mission, and what is looked for is not seen now."""
    mission = ctx.mission
    return mission.failed_with("NOT_FOUND") and bool(mission.search.found) and not mission.failed_for_good
