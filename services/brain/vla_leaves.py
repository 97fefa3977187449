"""Leaves of the VLA pipeline: hear, plan, look."""

from collections.abc import Callable
from typing import Any

import msgspec
from py_trees.common import Status

from common import messages as m
from common import topics
from common.geometry import Pose2
from common.plan_rules import Objection, known_world, objection
from common.topics import Topic
from services.brain import search
from services.brain.behaviours import Goal, Leaf
from services.brain.context import Context
from services.brain.floor import standing_pose
from services.brain.goals import Answer
from services.brain.mission import Failure
from services.brain.robot import Drive, take_command


class Await(Leaf):
    """Until somebody says something: WAITING, or LISTENING while speech takes in an utterance."""

    def update(self) -> Status:
        ctx = self.ctx
        ctx.renew()
        if not ctx.mission.active and not take_command(ctx):
            hearing = ctx.speaking is not None and ctx.speaking.state in ("listening", "transcribing")
            ctx.enter("LISTENING" if hearing else "WAITING")
            return Status.RUNNING
        return Status.SUCCESS


class Plan(Goal):
    """Asks the planner and checks its plan against the known world; an impossible one is rejected with the reason."""

    def __init__(self, name: str, ctx: Context) -> None:
        super().__init__(name, ctx, ctx.planner, state="PLANNING", timeout=ctx.config.planning_timeout)

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        ctx = self.ctx
        mission = ctx.mission
        request = m.PlanRequest(
            id=goal_id,
            command=mission.command,
            world=self._world(),
            rejected=mission.rejected,
            done=mission.looked,
            mission_id=mission.id,
        )
        return topics.PLAN_REQUEST, request

    def step(self) -> str:
        return f"plan: {self.ctx.mission.command}"

    def spoken(self) -> str:
        return "I could not make a plan for that."

    def done(self, answer: Answer) -> Status:
        ctx, plan = self.ctx, answer.message
        assert isinstance(plan, m.ActionPlan)
        wrong = objection(plan.steps, self._world(), ctx.io.scene)
        if wrong is None:
            ctx.mission.plan, ctx.mission.again = plan.steps, plan.again
            if plan.again:
                ctx.mission.looked = [*ctx.mission.looked, *plan.steps]
            for step in plan.steps:
                if step.action == "find" and step.text:
                    ctx.mission.chosen.setdefault(step.object, step.text)
            ctx.note("plan accepted", "; ".join(map(in_words, plan.steps)), "planned")
            return Status.SUCCESS
        if not plan.steps and plan.detail:
            wrong = Objection(0, plan.detail)
        ctx.mission.rejected = m.RejectedPlan(steps=plan.steps, reason=wrong.reason, step=wrong.step)
        reason = str(wrong)
        self.feedback_message = reason
        code = "REJECTED" if plan.steps else "NO_PLAN"
        return self.give_up(Failure("PLANNING", code, reason, spoken=f"I cannot do that: {reason}."))

    def _world(self) -> m.KnownWorld:
        ctx = self.ctx
        world = ctx.io.latest(topics.WORLD_OBJECTS)
        return known_world(ctx.io.scene, [o.label for o in world.objects] if world else [], ctx.hand.holding)


class Enough(Leaf):
    """FAILURE as long as the latest plan only goes and looks."""

    def update(self) -> Status:
        return Status.FAILURE if self.ctx.mission.again else Status.SUCCESS


def in_words(step: m.PlanStep) -> str:
    """A step as `brain/state` and the journal show it."""
    return " ".join(part for part in (step.action, step.object, step.target, step.text) if part)


class Look(Goal):
    """Asks perception for an object from where the robot stands."""

    def __init__(self, name: str, ctx: Context, thing: str) -> None:
        super().__init__(name, ctx, ctx.perception, state="GROUNDING", timeout=ctx.config.perception_timeout)
        self._thing = thing

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        return topics.OBJECT_QUERY, m.ObjectQuery(
            id=goal_id, query=self.ctx.mission.chosen.get(self._thing, self._thing)
        )

    def step(self) -> str:
        return f"look for {self._thing}"

    def spoken(self) -> str:
        return f"I could not find the {self._thing}."

    def done(self, answer: Answer) -> Status:
        ctx, pose = self.ctx, answer.message
        assert isinstance(pose, m.ObjectPose)
        ctx.mission.options = pose.candidates
        if not pose.found:
            self.feedback_message = pose.detail or "not seen"
            code = "AMBIGUOUS" if pose.candidates else "NOT_FOUND"
            return self.give_up(Failure("GROUNDING", code, pose.detail, self.spoken()))
        ctx.mission.found[self._thing] = pose
        x, y, z = pose.position
        evidence = f"{pose.label} at ({x:.2f}, {y:.2f}, {z:.2f}), confidence {pose.confidence:.2f}"
        ctx.note(f"found {self._thing}", evidence, "saw")
        return Status.SUCCESS


class TakeView(Goal):
    """Brings the camera to the view that shows most that is new: by turning on the spot, or `elsewhere`."""

    def __init__(self, name: str, ctx: Context, elsewhere: bool) -> None:
        config = ctx.config
        super().__init__(name, ctx, ctx.navigation, state="GROUNDING", timeout=config.navigation_timeout)
        self._elsewhere = elsewhere
        self._target: Pose2 | None = None

    def initialise(self) -> None:
        super().initialise()
        ctx, mission, pose = self.ctx, self.ctx.mission, self.ctx.here
        looked_from = [*mission.visited, pose]
        if self._elsewhere:
            self._target = search.elsewhere(ctx.io.scene, ctx.viewpoints, pose, looked_from)
        else:
            self._target = search.turn(ctx.viewpoints, pose, looked_from)
        # A view that cannot be reached is not tried a second time either.
        mission.visited = [*mission.visited, pose, *([self._target] if self._target else [])]
        mission.at = ""

    def update(self) -> Status:
        if self._target is None:
            self.feedback_message = "everything has been looked at"
            self.ctx.fail(Failure("GROUNDING", "NOTHING_NEW", self.feedback_message, self.spoken()))
            return Status.FAILURE
        return super().update()

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        assert self._target is not None
        x, y, theta = self._target
        return topics.NAV_GOAL, m.NavGoal(id=goal_id, x=x, y=y, theta=theta)

    def step(self) -> str:
        return f"search: {self.name}"

    def spoken(self) -> str:
        return "I could not get to where I wanted to look."


class NotFound(Leaf):
    """Ends a search without result with the reason that counts, whatever failed last."""

    def __init__(self, name: str, ctx: Context, thing: str, tries: int) -> None:
        super().__init__(name, ctx)
        self._thing, self._tries = thing, tries

    def update(self) -> Status:
        detail = f"not seen in {self._tries} search attempts"
        self.ctx.fail(Failure("GROUNDING", "NOT_FOUND", detail, f"I could not find the {self._thing}."))
        return Status.FAILURE


class Evidence(Leaf):
    """COMPLETED when every step of the plan left its mark on the hand."""

    def __init__(self, name: str, ctx: Context, summary: Callable[[], str]) -> None:
        super().__init__(name, ctx)
        self._summary = summary

    def update(self) -> Status:
        ctx, mission = self.ctx, self.ctx.mission
        steps = [s for s in mission.plan if not s.hand_alone]
        lets_go = any(s.action in ("place", "release") for s in steps)
        grasps = any(s.action == "grasp" for s in steps)
        if (grasps and not mission.grabbed) or (lets_go and not mission.released):
            ctx.fail(Failure("COMPLETED", "NO_EVIDENCE", spoken="I am not sure that it worked."))
            return Status.FAILURE
        detail = "; ".join(
            [self._summary(), *mission.checked, *(f"{thing}: not checked" for thing in mission.unchecked)]
        )
        ctx.finish("delivered", detail)
        ctx.enter("COMPLETED", detail=detail)
        return Status.SUCCESS


class Approach(Drive):
    """`nav_goal`: a standing pose before a thing that was found, with the thing for whoever knows a better stance."""

    def __init__(self, ctx: Context, thing: str) -> None:
        super().__init__(
            "approach",
            ctx,
            text=lambda: f"find {label_of(ctx, thing)}",
            spoken=lambda: f"I could not reach the {thing}.",
            state="NAVIGATING",
        )
        self._thing = thing

    def step(self) -> str:
        return f"approach {label_of(self.ctx, self._thing)}"

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        ctx, ref = self.ctx, reference(self.ctx, self._thing)
        if ref is None or ref.frame != "map":
            return super().goal(goal_id)  # nobody has said where in the map it is: navigation looks for it
        x, y, theta = standing_pose(ctx.io.scene, (ref.position[0], ref.position[1]), ctx.here)
        return topics.NAV_GOAL, m.NavGoal(id=goal_id, x=x, y=y, theta=theta, object=ref)


def label_of(ctx: Context, thing: str) -> str:
    """The name of a thing as perception has it."""
    pose = ctx.mission.found.get(thing)
    return (pose.label if pose else "") or thing


def reference(ctx: Context, thing: str) -> m.ObjectRef | None:
    """What perception said about the thing, for manipulation."""
    pose = ctx.mission.found.get(thing)
    if pose is None:
        return None
    fields = {k: getattr(pose, k) for k in ("label", "position", "orientation", "size", "frame", "tilt")}
    return msgspec.convert(fields, m.ObjectRef)
