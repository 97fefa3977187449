"""Leaves that give a thing the name that a person says, or forget it; perception keeps the names."""

from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from common import messages as m
from common import topics
from common.topic import Topic
from services.brain.mission.channel import Result
from services.brain.mission.context import Context
from services.brain.mission.mission import Failure
from services.brain.recoveries.clarify import asked_which, several_match
from services.brain.recoveries.recovery import Recovery, Task, with_recoveries
from services.brain.steps.leaf import Say, SendGoal
from services.brain.tree.composites import Sequence


def teach(ctx: Context, step: m.PlanStep, node_id: str, name: str) -> Sequence:
    """Have perception keep a name, ask which thing is meant where it could be several, and say what came of it."""
    asked = (Recovery("several_match", several_match, ask_which),)
    once = with_recoveries("keep_name", ctx, TeachName("teach", ctx, step), asked, Task(step.text))
    return Sequence(node_id, once, Say("say_done", ctx, lambda: done(step)), name=name)


def forget(ctx: Context, step: m.PlanStep, node_id: str, name: str) -> Sequence:
    """Have perception forget a name, and say so."""
    return Sequence(node_id, TeachName("forget", ctx, step), Say("say_done", ctx, lambda: done(step)), name=name)


def ask_which(ctx: Context, task: Task) -> Behaviour:
    """Ask until the answer names one of the things, and teach that one."""
    teach_it = TeachName("teach_the_one_meant", ctx, m.PlanStep(action="teach", text=task.item))
    return asked_which(ctx, task.item, teach_it)


def done(step: m.PlanStep) -> str:
    """What is said of a name that was taught or forgotten."""
    if step.action == "forget":
        return f"I have forgotten the {step.text}."
    return f"I will know the {step.text} again."


class TeachName(SendGoal):
    """Asks perception to keep or to forget a name."""

    def __init__(self, node_id: str, ctx: Context, step: m.PlanStep) -> None:
        super().__init__(node_id, ctx, ctx.peers.perception, state="GROUNDING", timeout=ctx.config.perception_timeout)
        self._step = step

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        step = self._step
        label = self.ctx.mission.search.chosen.get(step.text, step.object)
        return topics.TEACH, m.TeachRequest(id=goal_id, name=step.text, forget=step.action == "forget", label=label)

    def step(self) -> str:
        return f"{self._step.action} {self._step.text}"

    def spoken(self) -> str:
        return f"I could not {self._step.action} that name."

    def succeed(self, result: Result) -> Status:
        ctx, taught = self.ctx, result.message
        assert isinstance(taught, m.TeachResult)
        ctx.mission.search.options = taught.candidates
        if taught.ok:
            ctx.note(f"{self._step.action}: {taught.name}", taught.label, "did")
            return Status.SUCCESS
        self.feedback_message = taught.detail
        spoken = f"I did not {'forget' if self._step.action == 'forget' else 'learn'} that: {taught.detail}."
        return self.fail_with(Failure("GROUNDING", taught.code or "FAILED", taught.detail, spoken))
