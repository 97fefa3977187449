"""After putting down: look, and claim only what was seen."""

import math
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from common import messages as m
from common import topics
from common.topics import Topic
from services.brain.behaviours import Goal, Leaf
from services.brain.context import Context
from services.brain.decorators import Attempts
from services.brain.goals import Answer
from services.brain.mission import Failure
from services.brain.placement import Finding, found_at, not_found

ASTRAY = ("NOT_SEEN", "MISPLACED", "TOPPLED")
"""Codes of a look that shows an object not where, or not as, it belongs."""
LOOKS = 2
"""Pictures in a row that must show a fault before it is believed; each costs a settle and a second or two."""


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
        strange = self._sent_at is None and not self.channel.known and not ctx.io.matched(topics.OBJECT_QUERY)
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
    """Look once physics has settled; a fault is believed when another picture shows it too."""
    return Attempts("look at it", ctx, Check("check", ctx, target), LOOKS - 1, again=lambda: astray(ctx))


def astray(ctx: Context) -> bool:
    """The last look showed the object not where, or not as, it belongs."""
    failure = ctx.mission.failure
    return failure is not None and failure.code in ASTRAY
