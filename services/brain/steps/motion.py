"""Leaves that move the robot; both pipelines use them."""

from collections.abc import Callable
from typing import Any

import msgspec
from py_trees.common import Status

from common import messages as m
from common import topics
from common.geometry import Pose2
from common.topic import Topic
from services.brain.mission.channel import Channel, Result
from services.brain.mission.context import Context
from services.brain.mission.mission import Failure
from services.brain.mission.remarks import PERSON
from services.brain.steps.leaf import SendGoal
from services.brain.world.neighbours import standing
from services.brain.world.placement import rested
from services.brain.world.standing_poses import place_pose

Text = Callable[[], str]
LOST = ("LOST_OBJECT", "NOT_HOLDING", "SLIPPED")
"""Manipulation's codes for a hand that is empty and should have held something."""
ANOTHER_HELD = "ANOTHER_HELD"
"""Failure code: something else than what was meant is in the hand."""
BEYOND_THE_HAND = {"TOO_HEAVY": "too heavy for me", "TOO_WIDE": "too wide for my hand"}
"""Why no grasp can hold an object, in words, by manipulation's code."""


def drive_to(goal_id: str, pose: Pose2, about: m.ObjectRef | None = None) -> tuple[Topic[Any], m.Message]:
    """The goal of standing at a pose [map]; `about`: the object before which it is."""
    x, y, theta = pose
    return topics.NAV_GOAL, m.NavGoal(id=goal_id, x=x, y=y, theta=theta, object=about)


class Move(SendGoal):
    """A goal in words, `text`, to a peer that moves the robot: without an answer in time the peer is told to stop."""

    def __init__(self, node_id: str, ctx: Context, channel: Channel, text: Text, **more: Any) -> None:
        super().__init__(node_id, ctx, channel, **more)
        self._text = text

    def step(self) -> str:
        return self._text()

    def fail_with(self, failure: Failure) -> Status:
        if failure.code == "TIMEOUT":
            self.ctx.send_only(self.channel, "stop")
        return super().fail_with(failure)


class Navigate(Move):
    """A navigation goal in words, or as the pose of `place` with `drive_by = "poses"`.

    A way that is blocked is tried again on another path `navigation_retries` times in all: what navigation reports as
    `recoveries` counts, only what is missing is made up for by further attempts. Where people are all that is in the
    way it is tried again for `people_patience`: they walk on.
    """

    def __init__(
        self, node_id: str, ctx: Context, text: Text, spoken: Text, state: m.BrainStateName, place: str = ""
    ) -> None:
        limit, retries = ctx.config.navigation_timeout, ctx.config.navigation_retries
        super().__init__(node_id, ctx, ctx.peers.navigation, text, state=state, timeout=limit, retries=retries)
        self._spoken, self._place = spoken, place
        self._recovered = 0

    def initialise(self) -> None:
        super().initialise()
        self._recovered = 0

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        ctx = self.ctx
        if self._place and ctx.config.drive_by == "poses":
            pose = place_pose(ctx.io.household, self._place, ctx.robot_pose)
            if pose is not None:
                return drive_to(goal_id, pose)
        return topics.NAVIGATION_GOAL, m.NavigationGoal(goal=self._text(), id=goal_id)

    def spoken(self) -> str:
        return self._spoken()

    def try_again(self, code: str) -> bool:
        if code == PERSON:
            return self.elapsed < self.ctx.config.people_patience
        if code != "BLOCKED":
            return super().try_again(code)
        told = self.ctx.io.latest(topics.NAVIGATION_FEEDBACK)
        ours = told is not None and told.goal_id == self.channel.goal_id
        if told is not None and ours and told.attempt in (0, self.channel.attempt):
            self._recovered += max(0, told.recoveries)
        return self._tries + self._recovered < self._retries


class Manipulate(Move):
    """A manipulation goal in words; `about` gives the object it concerns."""

    def __init__(
        self,
        node_id: str,
        ctx: Context,
        text: Text,
        about: Callable[[], m.ObjectRef | None],
        *,
        state: m.BrainStateName,
        retries: int = 0,
    ) -> None:
        limit = ctx.config.manipulation_timeout
        super().__init__(node_id, ctx, ctx.peers.manipulation, text, state=state, timeout=limit, retries=retries)
        self._about = about

    def initialise(self) -> None:
        super().initialise()
        ctx, delivery = self.ctx, self.ctx.mission.delivery
        # What has fallen once stays in mind as it stood before.
        delivery.around = {**standing(ctx.objects, ctx.robot_pose, ctx.now), **delivery.around}
        delivery.rests = delivery.rests | {
            item: rested(
                pose, item, ctx.io.household, delivery.rests.get(item), *((known.shape, known.top) if known else ())
            )
            for item, pose in ctx.mission.search.found.items()
            for known in (ctx.known_object(pose.label),)
        }

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        message = m.ManipulationGoal(goal=self._text(), id=goal_id, object=self._about(), to=self.to())
        return topics.MANIPULATION_GOAL, message

    def to(self) -> str:
        """The receptacle on which what is grabbed is to be put, as far as the command says."""
        return ""


class Grab(Manipulate):
    """Holding is believed only after `done`; `item`: how the plan calls the object."""

    def __init__(
        self, node_id: str, ctx: Context, label: Text, about: Callable[[], m.ObjectRef | None], item: str = ""
    ) -> None:
        super().__init__(node_id, ctx, lambda: "grab", about, state="GRABBING")
        self._label, self._item = label, item

    def to(self) -> str:
        return self.ctx.mission.destination(self._item)

    def succeed(self, result: Result) -> Status:
        label = self._label()
        self.ctx.gripper.mark_grasped(label, self.ctx.origin_of(label))
        self.ctx.mission.search.stances.pop(label, None)
        self.ctx.mission.delivery.grabbed = True
        return Status.SUCCESS

    def unfinished(self) -> None:
        self.ctx.gripper.mark_uncertain(self._label())

    def _failed(self, code: str, detail: str) -> Status:
        """Note where manipulation says that the base would have to stand."""
        told = self.channel.result.message if self.channel.result is not None else None
        stances = self.ctx.mission.search.stances
        stances.pop(self._label(), None)
        if isinstance(told, m.ManipulationStatus) and told.stance is not None:
            stances[self._label()] = told.stance
        return super()._failed(code, detail)

    def spoken(self) -> str:
        return f"I could not pick up the {self._label()}."

    def fail_with(self, failure: Failure) -> Status:
        if why := BEYOND_THE_HAND.get(failure.code):
            failure = msgspec.structs.replace(failure, spoken=f"The {self._label()} is {why}.")
        search = self.ctx.mission.search
        if failure.code == "TOO_WIDE" and self._label() not in search.too_wide:
            # From where it was seen first it may have looked larger than it is.
            search.too_wide = [*search.too_wide, self._label()]
            failure = msgspec.structs.replace(failure, code="LOOKS_TOO_WIDE")
        return super().fail_with(failure)


class Release(Manipulate):
    """`release`, or `place <receptacle>` next to the object `near`; until it is `done` the object counts as held."""

    def __init__(
        self,
        node_id: str,
        ctx: Context,
        text: Text = lambda: "release",
        near: Callable[[], m.ObjectRef | None] = lambda: None,
    ) -> None:
        super().__init__(node_id, ctx, text, near, state="RELEASING", retries=ctx.config.release_retries)

    def update(self) -> Status:
        ctx, hand = self.ctx, self.ctx.gripper
        if self._sent_at is None and not self.channel.resuming and hand.has_lost_object(ctx.now):
            return self.fail_with(Failure(ctx.state, "LOST_OBJECT", "the fingers are empty"))
        return super().update()

    def fail_with(self, failure: Failure) -> Status:
        label = self.ctx.gripper.holding
        if failure.code in LOST:
            self.ctx.gripper.mark_released(self.ctx.now)
            self.ctx.mission.delivery.lost = [*self.ctx.mission.delivery.lost, label]
            failure = msgspec.structs.replace(failure, spoken=f"I lost the {label or 'object'} on the way.")
        return super().fail_with(failure)

    def succeed(self, result: Result) -> Status:
        self.ctx.mission.delivery.put_down, self.ctx.mission.delivery.unlike = self.ctx.gripper.holding, ""
        self.ctx.gripper.mark_released(self.ctx.now)
        self.ctx.mission.delivery.released = True
        return Status.SUCCESS

    def unfinished(self) -> None:
        self.ctx.gripper.mark_uncertain(self.ctx.gripper.holding)

    def spoken(self) -> str:
        return f"I could not put down the {self.ctx.gripper.holding or 'object'}."
