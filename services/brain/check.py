"""After putting down: look, and claim only what was seen."""

import math
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Sequence

from common import messages as m
from common import topics
from common.topics import Topic
from services.brain.behaviours import Goal, Leaf, Settle
from services.brain.context import Context
from services.brain.decorators import Attempts, When
from services.brain.goals import Answer
from services.brain.mission import Failure
from services.brain.placement import Finding, found_at, not_found

ASTRAY = ("NOT_SEEN", "MISPLACED", "TOPPLED")
"""Codes of a look that shows an object not where, or not as, it belongs."""
LOOKS = 2
"""Pictures in a row that must show a fault before it is believed; each costs a settle and a second or two."""
ASIDE = 0.4
"""rad by which the base turns before the second look for an object that is not to be seen: the folded arm hides some
0.2 rad of the head camera's picture, and turns with the base."""


class Check(Goal):
    """Asks perception where the object is that was put down last, in a picture taken from now on.

    Perception that cannot be asked is no failure as long as nobody has seen its process: the mission then claims no
    more than the hand felt. One that was alive and does not answer is `UNCHECKED`.
    """

    def __init__(self, name: str, ctx: Context, target: str) -> None:
        super().__init__(name, ctx, ctx.perception, state="RELEASING", timeout=ctx.config.check_timeout)
        self._target = target

    def update(self) -> Status:
        ctx = self.ctx
        strange = self._sent_at is None and not self.channel.known and not ctx.io.has_subscribers(topics.OBJECT_QUERY)
        if strange or not ctx.mission.put_down:
            return self._unchecked("nobody answers object queries")
        return super().update()

    def step(self) -> str:
        return f"check {self.ctx.mission.put_down}"

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        ctx = self.ctx
        return topics.OBJECT_QUERY, m.ObjectQuery(id=goal_id, query=ctx.mission.put_down, since=ctx.now)

    def done(self, answer: Answer) -> Status:
        ctx, pose = self.ctx, answer.message
        assert isinstance(pose, m.ObjectPose)
        label = ctx.mission.put_down
        if pose.found and pose.seen_at <= ctx.hand.put_down.get(label, math.inf):
            return self._unchecked("what was seen is older than the release")
        finding = found_at(pose, label, self._target, ctx.io.scene) if pose.found else not_found(
            label, self._target, ctx.io.scene
        )  # fmt: skip
        return conclude(ctx, finding, pose.picture)

    def give_up(self, failure: Failure) -> Status:
        if failure.stage != "RELEASING" or failure.code in ("STOPPED", "CANCELLED"):
            return super().give_up(failure)
        if not self.channel.known:
            return self._unchecked(failure.detail)
        spoken = f"I put down the {self.ctx.mission.put_down}, but I could not check where it is."
        return super().give_up(Failure(failure.stage, "UNCHECKED", f"{failure.code}: {failure.detail}", spoken))

    def _unchecked(self, why: str) -> Status:
        """Put down as far as the hand felt; the mission says that nobody looked."""
        ctx = self.ctx
        ctx.mission.unchecked = [*ctx.mission.unchecked, ctx.mission.put_down or "object"]
        ctx.note(f"not checked: {ctx.mission.put_down or 'object'}", why)
        self.feedback_message = why
        return Status.SUCCESS


class TurnAside(Goal):
    """Turns the base on the spot, so that the arm hides another part of the surface before it from the camera.

    SUCCESS whatever navigation says: the look that follows tells what is to be seen from there.
    """

    def __init__(self, name: str, ctx: Context) -> None:
        super().__init__(name, ctx, ctx.navigation, state="RELEASING", timeout=ctx.config.check_timeout)

    def update(self) -> Status:
        if self._sent_at is None and not self.ctx.io.has_subscribers(topics.NAV_GOAL):
            return Status.SUCCESS
        return super().update()

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        self.ctx.mission.at = ""
        x, y, theta = self.ctx.here
        return topics.NAV_GOAL, m.NavGoal(id=goal_id, x=x, y=y, theta=theta + ASIDE)

    def give_up(self, failure: Failure) -> Status:
        self.feedback_message = f"not turned: {failure.code}"
        return Status.SUCCESS


class InPlace(Leaf):
    """SUCCESS when the object, as it was found, is already where it belongs."""

    def __init__(self, name: str, ctx: Context, thing: str, target: str) -> None:
        super().__init__(name, ctx)
        self._thing, self._target = thing, target

    def update(self) -> Status:
        ctx, pose = self.ctx, self.ctx.mission.found.get(self._thing)
        label = ctx.mission.put_down
        if pose is None or pose.label != label or pose.seen_at <= ctx.hand.put_down.get(label, math.inf):
            return Status.FAILURE
        finding = found_at(pose, label, self._target, ctx.io.scene)
        if finding.fault:
            return Status.FAILURE
        return conclude(ctx, finding, b"")


def conclude(ctx: Context, finding: Finding, picture: bytes) -> Status:
    """Write down what was seen; what is not where it belongs counts as not released."""
    mission, label = ctx.mission, ctx.mission.put_down
    name = ctx.pictures.keep(mission.id, picture)
    ctx.note(f"looked at the {label}", finding.words, "saw", picture=name)
    if not finding.fault:
        mission.released, mission.failure = True, None
        mission.checked = [*mission.checked, finding.words]
        return Status.SUCCESS
    mission.released = False
    spoken = f"I put down the {label}, but {finding.words.partition(', at (')[0]}."
    ctx.fail(Failure("RELEASING", finding.fault, finding.words, spoken))
    return Status.FAILURE


def checked(ctx: Context, target: str) -> Behaviour:
    """Look once physics has settled; a fault is believed when another picture shows it too.

    What is not to be seen is looked for from a little aside.
    """
    aside = Sequence(name="aside", memory=True, children=[TurnAside("turn aside", ctx), Settle("come to rest", ctx)])
    moved = When("hidden by the arm?", aside, lambda: looks.used > 0 and unseen(ctx))
    look = Sequence(name="look", memory=True, children=[moved, Check("check", ctx, target)])
    looks = Attempts("look at it", ctx, look, LOOKS - 1, again=lambda: astray(ctx))
    return looks


def unseen(ctx: Context) -> bool:
    """The last look did not show the object."""
    failure = ctx.mission.failure
    return failure is not None and failure.code == "NOT_SEEN"


def astray(ctx: Context) -> bool:
    """The last look showed the object not where, or not as, it belongs."""
    failure = ctx.mission.failure
    return failure is not None and failure.code in ASTRAY
