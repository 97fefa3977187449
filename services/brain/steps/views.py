"""Leaves that drive to where more can be seen."""

from typing import Any

from py_trees.common import Status

from common import messages as m
from common import topics
from common.geometry import Pose2
from common.topic import Topic
from services.brain.mission.channel import Result
from services.brain.mission.context import Context
from services.brain.mission.mission import Failure
from services.brain.mission.remarks import PERSON
from services.brain.steps.leaf import SendGoal
from services.brain.steps.motion import drive_to
from services.brain.world import viewpoint_search

HELD_UP = (PERSON, "WAITING", "GIVING_WAY", "BACKING_OFF")
"""Navigation's codes while somebody or something keeps it from getting on."""


class GoAndLook(SendGoal):
    """A drive to one of several views: where it is held up for `view_patience`, another one is taken first.

    A subclass sets the `view` [map] as it begins; None: there is none, with the code and words of `NOTHING_LEFT`.
    """

    NOTHING_LEFT: tuple[str, str]

    def __init__(self, node_id: str, ctx: Context, name: str = "") -> None:
        limit = ctx.config.navigation_timeout
        super().__init__(node_id, ctx, ctx.peers.navigation, state="GROUNDING", timeout=limit, name=name)
        self._held_up = self._at = 0.0
        self.view: Pose2 | None = None

    def initialise(self) -> None:
        super().initialise()
        self._held_up, self._at = 0.0, self.ctx.now

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        assert self.view is not None
        return drive_to(goal_id, self.view)

    def update(self) -> Status:
        if self.view is None:
            code, self.feedback_message = self.NOTHING_LEFT
            return self.ctx.fail("GROUNDING", code, self.feedback_message, self.spoken())
        ctx, told = self.ctx, self.ctx.io.latest(topics.NAVIGATION_FEEDBACK)
        if told is not None and told.goal_id == self.channel.goal_id and told.code in HELD_UP:
            self._held_up += ctx.now - self._at
        self._at = ctx.now
        result = self.channel.result
        over = self._sent_at is None or (result is not None and result.status in ("ok", "failed"))
        if over or self._held_up <= ctx.config.view_patience:
            return super().update()
        failed = self._failed(PERSON, f"held up for {self._held_up:.0f} s")
        ctx.send_only(ctx.peers.navigation, "stop")
        return failed


class MoveToViewpoint(GoAndLook):
    """Brings the camera to the view that shows most that is new: by turning on the spot, `elsewhere`, or where the
    `item` was said to be (`there`); if `near`, also of what was not seen from so near."""

    NOTHING_LEFT = ("NOTHING_NEW", "everything has been looked at")

    def __init__(
        self,
        node_id: str,
        ctx: Context,
        name: str,
        item: str,
        elsewhere: bool,
        there: bool = False,
        near: bool = False,
    ) -> None:
        super().__init__(node_id, ctx, name)
        self._item, self._elsewhere, self._there, self._near = item, elsewhere, there, near

    def initialise(self) -> None:
        super().initialise()
        ctx, mission, pose = self.ctx, self.ctx.mission, self.ctx.robot_pose
        looked_from, missed = [*mission.search.visited, pose], mission.search.unreached
        home, views = ctx.io.household, ctx.viewpoints
        if self._there:
            told, floor = ctx.told_points(self._item), ctx.told_floor(self._item)
            self.view = viewpoint_search.there(home, views, pose, looked_from, missed, told, floor, self._near)
        elif self._elsewhere:
            likely = ctx.likelihood(self._item)
            self.view = viewpoint_search.elsewhere(home, views, pose, looked_from, missed, likely, self._near)
        else:
            self.view = viewpoint_search.turn(views, pose, looked_from)
        mission.search.visited = looked_from
        mission.at = ""

    def succeed(self, result: Result) -> Status:
        assert self.view is not None
        search = self.ctx.mission.search
        search.visited = [*search.visited, self.view]
        return super().succeed(result)

    def fail_with(self, failure: Failure) -> Status:
        assert self.view is not None
        search = self.ctx.mission.search
        search.unreached = [*search.unreached, self.view]
        return super().fail_with(failure)

    def step(self) -> str:
        return f"search: {self.name}"

    def spoken(self) -> str:
        return "I could not get to where I wanted to look."
