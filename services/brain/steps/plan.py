"""Leaves of the VLA pipeline: await a command, ask for a plan and check it, complete on evidence."""

from collections.abc import Callable
from typing import Any

import msgspec
from py_trees.common import Status

from common import messages as m
from common import topics
from common.plan_rules import Objection, objection
from common.topic import Topic
from services.brain.mission.channel import Result
from services.brain.mission.context import Context
from services.brain.mission.mission import Failure
from services.brain.mission.voice import refused
from services.brain.steps.begin import take_command
from services.brain.steps.leaf import Leaf, SendGoal
from services.brain.steps.verify import with_care


class AwaitCommand(Leaf):
    """Until somebody says something: WAITING, or LISTENING while speech takes in an utterance."""

    def update(self) -> Status:
        ctx = self.ctx
        ctx.renew_mission()
        if not ctx.mission.active and not take_command(ctx):
            hearing = ctx.voice.speaking is not None and ctx.voice.speaking.state in ("listening", "transcribing")
            ctx.show_state("LISTENING" if hearing else "WAITING")
            return Status.RUNNING
        return Status.SUCCESS


class RequestPlan(SendGoal):
    """Asks the planner and checks its plan against the known world; an impossible one is rejected with the reason."""

    def __init__(self, node_id: str, ctx: Context) -> None:
        super().__init__(node_id, ctx, ctx.peers.planner, state="PLANNING", timeout=ctx.config.planning_timeout)

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        return topics.PLAN_REQUEST, self.request(goal_id)

    def request(self, goal_id: str) -> m.PlanRequest:
        ctx = self.ctx
        mission = ctx.mission
        return m.PlanRequest(
            id=goal_id,
            command=mission.command,
            world=ctx.known_world(),
            rejected=mission.planning.rejected,
            done=mission.planning.looked,
            mission_id=mission.id,
            history=ctx.history(),
        )

    def step(self) -> str:
        return f"plan: {self.ctx.mission.command}"

    def spoken(self) -> str:
        return "I could not make a plan for that."

    def succeed(self, result: Result) -> Status:
        ctx, plan = self.ctx, result.message
        assert isinstance(plan, m.ActionPlan)
        wrong = objection(plan.steps, ctx.known_world(), ctx.io.household)
        if wrong is None:
            ctx.mission.planning.steps, ctx.mission.planning.look_again = plan.steps, plan.again
            if plan.again:
                ctx.mission.planning.looked = [*ctx.mission.planning.looked, *plan.steps]
            for step in plan.steps:
                if step.action == "find" and step.text:
                    ctx.mission.search.chosen.setdefault(step.object, step.text)
            ctx.note("plan accepted", "; ".join(step.words for step in plan.steps), "planned")
            return Status.SUCCESS
        ctx.mission.planning.suggestion = plan.suggestion
        if not plan.steps and plan.detail:
            wrong = Objection(0, plan.detail)
        ctx.mission.planning.rejected = m.RejectedPlan(steps=plan.steps, reason=wrong.reason, step=wrong.step)
        reason = str(wrong)
        self.feedback_message = reason
        code = "REJECTED" if plan.steps else "NO_PLAN"
        return self.fail_with(Failure("PLANNING", code, reason, spoken=refused("do", reason)))


class ChooseTranscription(RequestPlan):
    """Asks the planner which of several transcriptions makes most sense; one that it doubts has to be asked about."""

    def request(self, goal_id: str) -> m.PlanRequest:
        return msgspec.structs.replace(super().request(goal_id), alternatives=self.ctx.mission.heard.alternatives)

    def succeed(self, result: Result) -> Status:
        mission, plan = self.ctx.mission, result.message
        assert isinstance(plan, m.ActionPlan)
        texts = [mission.command, *(one.text for one in mission.heard.alternatives)]
        mission.heard.alternatives = []
        if plan.suggestion in texts:
            mission.command, mission.heard.confidence = plan.suggestion, 0.0
            self.ctx.note("perhaps heard", plan.suggestion, "heard")
        return Status.SUCCESS

    def fail_with(self, failure: Failure) -> Status:
        """Without a planner what was heard first is asked about as ever."""
        self.ctx.mission.heard.alternatives = []
        return Status.SUCCESS


class PlanIsComplete(Leaf):
    """FAILURE as long as the latest plan only goes and looks."""

    def update(self) -> Status:
        return Status.FAILURE if self.ctx.mission.planning.look_again else Status.SUCCESS


class CompleteWithEvidence(Leaf):
    """COMPLETED when every step of the plan left its mark on the hand."""

    def __init__(self, node_id: str, ctx: Context, summary: Callable[[], str]) -> None:
        super().__init__(node_id, ctx)
        self._summary = summary

    def update(self) -> Status:
        ctx, mission, done = self.ctx, self.ctx.mission, self.ctx.mission.delivery
        steps = [s for s in mission.planning.steps if not s.hand_alone]
        lets_go = any(s.action in ("place", "release") for s in steps)
        grasps = any(s.action == "grasp" for s in steps)
        if (grasps and not done.grabbed) or (lets_go and not done.released):
            return ctx.fail("COMPLETED", "NO_EVIDENCE", spoken="I am not sure that it worked.")
        if not with_care(ctx):
            return Status.FAILURE
        unchecked = (f"{item}: not checked" for item in done.unchecked)
        detail = "; ".join([self._summary(), *done.checked, *unchecked])
        ctx.end_mission("delivered", detail)
        ctx.show_state("COMPLETED", detail=detail)
        return Status.SUCCESS
