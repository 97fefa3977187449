"""The planner: answers each `plan_request` with an `action_plan`, by the grammar or by a language model over it."""

from collections import OrderedDict
from typing import TypeVar

from common import messages as m
from common import topics
from common.io import Io
from services.planner import grammar
from services.planner.config import PlannerConfig
from services.planner.world import World, believed

T = TypeVar("T")
REMEMBERED = 32


class PlannerService:
    """Turns a command into steps that fit the known world."""

    NAME = "planner"
    HZ = 10
    CONFIG = PlannerConfig
    READS = (topics.PLAN_REQUEST, topics.WORLD_OBJECTS, topics.POSE)
    WRITES = (topics.ACTION_PLAN,)

    def __init__(self, config: PlannerConfig, io: Io) -> None:
        self._config, self._io = config, io
        self._answers: OrderedDict[str, m.ActionPlan] = OrderedDict()
        self._rejected: OrderedDict[str, list[m.RejectedPlan]] = OrderedDict()

    def step(self, now: float) -> None:
        for request in self._io.drain(topics.PLAN_REQUEST):
            if request.id in self._answers:
                self._io.publish(topics.ACTION_PLAN, self._answers[request.id])
            else:
                self._answer(request, now)

    def _answer(self, request: m.PlanRequest, now: float) -> None:
        rejected = self._rejections(request)
        plan = grammar.plan(
            request.command, self._world(request, now), self._config, rejected, request.done, request.id
        )
        self._publish(request, plan)

    def _publish(self, request: m.PlanRequest, plan: m.ActionPlan) -> None:
        _remember(self._answers, request.id, plan)
        self._io.publish(topics.ACTION_PLAN, plan)
        steps = "; ".join(" ".join(p for p in (s.action, s.object, s.target) if p) for s in plan.steps)
        self._io.log.info("planned", command=request.command, steps=steps, detail=plan.detail, source=plan.source)

    def _world(self, request: m.PlanRequest, now: float) -> World:
        seen, pose = self._io.latest(topics.WORLD_OBJECTS), self._io.latest(topics.POSE)
        home = self._io.scene.home
        where = (pose.x, pose.y, pose.theta) if pose else (home.x, home.y, home.theta)
        return believed(self._io.scene, request.world, seen.objects if seen else [], where, now)

    def _rejections(self, request: m.PlanRequest) -> list[m.RejectedPlan]:
        """Every plan rejected so far for this command of this mission, the newest last."""
        key = f"{request.id.partition('.')[0]} {request.command}"
        history = self._rejected.get(key, [])
        if request.rejected is None:
            self._rejected.pop(key, None)
            return []
        _remember(self._rejected, key, [*history, request.rejected])
        return self._rejected[key]


def _remember(memory: OrderedDict[str, T], key: str, value: T) -> None:
    memory[key] = value
    memory.move_to_end(key)
    while len(memory) > REMEMBERED:
        memory.popitem(last=False)
