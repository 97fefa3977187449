"""The planner: answers each `plan_request` with an `action_plan`, by the grammar or by a language model over it."""

from collections import OrderedDict

import msgspec

from common import messages as m
from common import topics
from common.bus.port import Io, Job
from common.chat import ChatError, NoAnswer
from common.goal_inbox import GoalInbox
from services.planner.config import PlannerConfig
from services.planner.grammar import grammar
from services.planner.language_model.backend import Backend
from services.planner.language_model.llm import Call, Reply
from services.planner.transcriptions import chosen
from services.planner.world import World, believed

REMEMBERED = 32
"""Requests whose answers and rejections are kept (chosen: more than a mission asks)."""
GRACE = 1.0
"""Time beyond the model's own limit after which its answer is given up [s] (chosen: ten steps)."""


class Pending(msgspec.Struct):
    """A request that the language model works on."""

    request: m.PlanRequest
    world: World
    rejected: list[m.RejectedPlan]
    due: float
    call: Call
    job: Job[Reply]


class PlannerService:
    """Turns a command into steps that fit the known world."""

    NAME = "planner"
    HZ = 10
    CONFIG = PlannerConfig
    READS, WRITES = topics.subscribed(NAME), topics.published(NAME)

    def __init__(self, config: PlannerConfig, io: Io) -> None:
        self._config, self._io = config, io
        self._backend = Backend(config, io)
        self._pending: Pending | None = None
        self._inbox: GoalInbox[m.PlanRequest, m.ActionPlan] = GoalInbox(
            io, (topics.PLAN_REQUEST,), self._take, self._repeat
        )
        self._now = 0.0
        self._rejected: OrderedDict[str, list[m.RejectedPlan]] = OrderedDict()

    def step(self, now: float) -> None:
        self._now = now
        self._inbox.receive()
        self._poll(now)
        self._backend.step(now, self._pending is None)

    # --- the language model
    def _repeat(self, request: m.PlanRequest, answer: m.ActionPlan | None) -> None:
        if answer is not None:
            self._io.publish(topics.ACTION_PLAN, answer)

    def _take(self, request: m.PlanRequest) -> None:
        """Only the newest request counts: a sender has one outstanding. A model is asked once enough was seen."""
        now = self._now
        rejected, world = self._rejections(request), self._world(request, now)
        self.close()
        if request.alternatives:
            self._publish(request, self._of_alternatives(request, world))
            return
        plan = self._by_grammar(request, world, rejected)
        llm = self._backend.llm
        if llm is None or plan.again:
            self._publish(request, plan)
            return
        call, seconds = Call(), self._config.llm_seconds
        job = self._io.submit(llm.plan, request.command, world, rejected, call, seconds=seconds)
        self._pending = Pending(request, world, rejected, now + self._config.llm_timeout + GRACE, call, job)

    def _poll(self, now: float) -> None:
        pending = self._pending
        if pending is None:
            return
        ready = pending.job.poll(now)
        if ready or (now > pending.due and not self._io.lockstep):
            self.close()
            outcome = self._outcome(pending, ready, now)
            self._publish(pending.request, outcome)

    def close(self) -> None:
        """Let go of the question under way."""
        if self._pending is not None:
            self._pending.call.cancelled = True
            self._pending = None

    def _outcome(self, pending: Pending, ready: bool, now: float) -> m.ActionPlan:
        """The model's plan; the grammar's where the model failed or knows none."""
        try:
            if not ready:
                raise NoAnswer("timed out")
            reply = pending.job.result()
            self._backend.answered()
        except ChatError as error:
            if isinstance(error, NoAnswer):
                self._backend.failed(str(error), now)
            return self._by_grammar(pending.request, pending.world, pending.rejected, f"llm: {error}")
        plan = m.ActionPlan(request_id=pending.request.id, steps=reply.steps, source="llm", detail=reply.detail)
        if plan.steps:
            return plan
        reason = f"llm: {reply.detail or 'no plan'}"
        other = self._by_grammar(pending.request, pending.world, pending.rejected, reason)
        return other if other.steps or not reply.detail else plan

    def _by_grammar(
        self, request: m.PlanRequest, world: World, rejected: list[m.RejectedPlan], why: str = ""
    ) -> m.ActionPlan:
        plan = grammar.plan(request.command, world, self._config, rejected, request.done, request.id)
        plan.source = f"{plan.source} ({why})" if why else plan.source
        return plan

    def _of_alternatives(self, request: m.PlanRequest, world: World) -> m.ActionPlan:
        """By the grammar alone, as what was heard is asked about before anything is made of it."""

        def plan(text: str) -> m.ActionPlan:
            return self._by_grammar(msgspec.structs.replace(request, command=text), world, [])

        return chosen(request.command, request.alternatives, plan, world.names)

    # --- requests and answers
    def _publish(self, request: m.PlanRequest, plan: m.ActionPlan) -> None:
        self._inbox.end(request, plan)
        self._io.publish(topics.ACTION_PLAN, plan)
        steps = "; ".join(step.words for step in plan.steps)
        self._io.log.info("planned", command=request.command, steps=steps, detail=plan.detail, source=plan.source)

    def _world(self, request: m.PlanRequest, now: float) -> World:
        seen, pose = self._io.latest(topics.WORLD_OBJECTS), self._io.latest(topics.POSE)
        home = self._io.household.home
        where = (pose.x, pose.y, pose.theta) if pose else (home.x, home.y, home.theta)
        io, history = self._io, request.history
        world = believed(io.household, request.world, seen.objects if seen else [], where, now, history)
        world.edits = io.latest(topics.HOUSEHOLD_EDITS) or world.edits
        world.battery = io.latest(topics.BATTERY)
        if (seen_before := io.latest(topics.SIGHTINGS)) is not None:
            world.sightings, world.seen_until = seen_before.sightings, seen_before.t
        return world

    def _rejections(self, request: m.PlanRequest) -> list[m.RejectedPlan]:
        """Every plan rejected so far for this command of this mission, the newest last."""
        key = f"{request.mission_id} {request.command}"
        history = self._rejected.get(key, [])
        if request.rejected is None:
            self._rejected.pop(key, None)
            return []
        self._rejected[key] = [*history, request.rejected]
        self._rejected.move_to_end(key)
        while len(self._rejected) > REMEMBERED:
            self._rejected.popitem(last=False)
        return self._rejected[key]
