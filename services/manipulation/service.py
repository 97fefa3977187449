"""Manipulation: takes goals from the brain, runs one sequence at a time, answers with evidence."""

import math
from collections.abc import Sequence

from common import messages as m
from common import topics
from common.bus.port import Io
from common.gateway import refusal
from common.geometry import Pose2
from common.goal_inbox import GoalInbox
from common.runtime import StartError
from services.manipulation.config import ManipulationConfig
from services.manipulation.execution import place_executor, recovery
from services.manipulation.execution.feedback import Feedback
from services.manipulation.execution.led_hand import LedHand
from services.manipulation.execution.policy import PolicyError, load_policy
from services.manipulation.execution.policy_executor import grab_by_policy
from services.manipulation.execution.pull_executor import grab_or_pull
from services.manipulation.execution.robot import Failure, Robot, Steps, T
from services.manipulation.grasps.grasp_store import GraspStore
from services.manipulation.planning.object_source import ObjectSource

DESCRIPTION_PATIENCE = 3.0
"""How long a goal waits for the robot's description [s]; chosen: it is latched and comes at once."""
NEXT_ATTEMPT = 3.0
"""How long an arm over a surface waits for the next attempt to put down what it holds [s]. Chosen: the brain sends one
after a second."""
LETTING_GO = "release"
"""The phase of placing in which the fingers open."""


class ManipulationService:
    """Grabs, places and releases objects; claims `done` on the evidence of width and force."""

    NAME = "manipulation"
    HZ = 50
    CONFIG = ManipulationConfig
    READS, WRITES = topics.subscribed(NAME), topics.published(NAME)
    ON_DEMAND = (topics.HEAD_RGBD, topics.WRIST_RGBD)  # for a policy, while it plays

    def __init__(self, config: ManipulationConfig, io: Io) -> None:
        self._config, self._io = config, io
        try:
            self._policy = load_policy(config.policy) if config.policy else None
        except PolicyError as error:
            raise StartError(f"manipulation.policy: {error}") from None
        self._robot = Robot(config, io, ObjectSource(io.household))
        self._feedback = Feedback(config, io, self._robot)
        self._store = GraspStore(io.state_dir, lambda why: io.log.warning("not kept what is in the hand", reason=why))
        self._steps: Steps[str] | None = None
        self._goal = m.ManipulationGoal(goal="")
        self._inbox: GoalInbox[m.ManipulationGoal, m.ManipulationStatus] = GoalInbox(
            io, (topics.MANIPULATION_GOAL,), self._take, self._repeat, self._preempted
        )
        self._led = LedHand(self._robot)
        self._looked_for = ""
        self._waiting_since: float | None = None
        self._fold_at = math.inf
        self._status = m.ManipulationStatus(status="idle")
        io.publish(topics.MANIPULATION_STATUS, self._status)

    def step(self, now: float) -> None:
        io, robot = self._io, self._robot
        robot.now = now
        unknown = not self._feedback.begun
        self._feedback.update(now)
        if unknown and robot.grip.holds():
            robot.grasped = self._store.recall(robot.grip.width, self._config.slip_width)
        for look in io.take_all(topics.NAVIGATION_GOAL):
            verb, _, item = look.goal.partition(" ")
            if verb == "find":
                self._looked_for = item.strip()
        if io.take_all(topics.ROBOT_STOP):
            self._led.stop()
            self._end(Failure("STOPPED", "robot/stop"))
            self._fold_at = math.inf
        self._inbox.receive()
        led_away = self._led.left_out and refusal(io.latest(topics.BRAIN_STATE))
        if self._steps is None and (led_away or now > self._fold_at):
            self._fold()
        if self._steps is not None:
            self._advance(now)
        self._led.step(self._feedback.mjcf, self._steps is not None)
        if self._feedback.begun:
            self._store.keep(robot.grasped, robot.grip.width)

    # --- goals
    def _repeat(self, goal: m.ManipulationGoal, answer: m.ManipulationStatus | None) -> None:
        self._io.publish(topics.MANIPULATION_STATUS, answer or self._status)

    def _preempted(self, old: m.ManipulationGoal, new: m.ManipulationGoal) -> None:
        self._end(Failure("PREEMPTED", f"replaced by {new.goal}"))

    def _take(self, goal: m.ManipulationGoal) -> None:
        self._goal, self._fold_at = goal, math.inf
        verb, _, rest = goal.goal.strip().partition(" ")
        robot = self._robot
        if goal.goal.strip() == "stop":
            robot.forget_command()
            self._publish("idle", "", "STOPPED", "the arm holds")
            return
        steps = self._sequence(verb, rest.strip())
        if steps is None:
            detail = f"{goal.goal!r}: expected grab, release, place <receptacle>, home or stop"
            self._publish("failed", "", "UNKNOWN_GOAL", detail)
            return
        self._io.log.info("goal", goal=goal.goal, id=goal.id, attempt=goal.attempt)
        self._steps, self._waiting_since = steps, robot.now
        robot.phase, robot.grasped = "start", robot.grasped if robot.grip.holds() else None
        robot.forget_command()
        self._publish("executing", "start")

    def _fold(self) -> None:
        """Back to the carry pose with an arm that a person, or a placing that failed, has left elsewhere."""
        self._led.left_out, self._fold_at = False, math.inf
        self._goal = m.ManipulationGoal(goal="home", id=self._io.new_id(self.NAME))
        self._waiting_since = self._robot.now
        self._steps = self._with_planner(recovery.fold(self._robot))

    def _sequence(self, verb: str, rest: str) -> Steps[str] | None:
        robot = self._robot
        if verb == "grab" and not rest:
            return self._grab()
        if verb == "release" and not rest:
            return self._release()
        if verb == "place" and rest:
            return self._place(rest)
        if verb == "home" and not rest:
            return self._with_planner(recovery.fold(robot))
        return None

    def _with_planner(self, steps: Steps[T]) -> Steps[T]:
        """Wait for the robot's description first, for a while."""
        while self._robot.planner is None and self._robot.now - (self._waiting_since or 0.0) < DESCRIPTION_PATIENCE:
            yield
        return (yield from steps)

    def _grab(self) -> Steps[str]:
        robot, goal = self._robot, self._goal
        wanted = goal.object.label if goal.object else self._looked_for
        if robot.grip.holds():
            label = robot.grasped.label if robot.grasped else ""
            if not label or not wanted or label == wanted or goal.attempt > 1:
                return (yield from self._with_planner(recovery.retract_grasped(robot, goal.object)))
            raise Failure("HAND_FULL", f"the {label} is in the gripper")
        if self._policy is not None:
            played = grab_by_policy(robot, self._policy, goal, self._looked_for, lambda: self._feedback.mjcf)
            return (yield from self._with_planner(played))
        return (yield from self._with_planner(grab_or_pull(robot, goal, self._looked_for)))

    def _release(self) -> Steps[str]:
        robot = self._robot
        if not robot.grip.holds():
            yield from self._with_planner(recovery.retract_empty(robot))
            if self._let_go():
                return "put down by an earlier attempt, the gripper is open"
            raise Failure("LOST_OBJECT", "nothing was held, the gripper is open")
        return (yield from self._with_planner(recovery.brought_back(robot, place_executor.place(robot, ""))))

    def _let_go(self) -> bool:
        """An earlier attempt of this goal has opened the fingers over its place."""
        return bool(self._goal.id) and self._store.released() == self._goal.id

    def _place(self, where: str) -> Steps[str]:
        robot, beside = self._robot, self._goal.object
        if beside is not None and beside.frame != "map":
            raise Failure("UNKNOWN_PLACE", f"where the {beside.label} is must be told in frame map, not {beside.frame}")
        if self._io.household.receptacle(where) is None:
            known = ", ".join(r.name for r in self._io.household.receptacles)
            raise Failure("UNKNOWN_PLACE", f"no receptacle {where!r}; known: {known}")
        if not robot.grip.holds():
            yield from self._with_planner(recovery.retract_empty(robot))
            if self._let_go():
                return "put down by an earlier attempt, the gripper is open"
            raise Failure("NOT_HOLDING", "nothing is in the gripper")
        return (yield from self._with_planner(recovery.brought_back(robot, place_executor.place(robot, where, beside))))

    # --- running
    def _advance(self, now: float) -> None:
        assert self._steps is not None
        age = self._io.age(topics.JOINT_STATES, now)
        started = self._waiting_since or 0.0
        if age > self._config.state_timeout and now - started > self._config.state_timeout:
            silent = "no joint_states yet" if math.isinf(age) else f"joint_states silent for {age:.1f} s"
            self._end(Failure("STALE_STATE", silent))
            return
        phase = self._robot.phase
        try:
            next(self._steps)
        except StopIteration as stop:
            self._steps = None
            self._io.log.info("done", goal=self._goal.goal, evidence=stop.value)
            self._publish("done", "", "", str(stop.value))
        except Failure as failure:
            self._end(failure)
            if self._goal.goal != "home" and self._robot.grip.holds():
                self._fold_at = now + NEXT_ATTEMPT
        else:
            if self._robot.phase != phase:
                if self._robot.phase == LETTING_GO:
                    self._store.release(self._goal.id)
                self._publish("executing", self._robot.phase)

    def _end(self, failure: Failure) -> None:
        if self._steps is None:
            return
        self._steps.close()
        self._steps = None
        self._robot.forget_command()
        self._io.log.warning("failed", goal=self._goal.goal, code=failure.code, detail=failure.detail)
        self._publish(
            "failed", self._robot.phase, failure.code, failure.detail, failure.blockers, failure.stance
        )  # fmt: skip

    def _publish(
        self, status: m.ManipStatus, phase: str, code: str = "", detail: str = "", blockers: Sequence[str] = (),
        stance: Pose2 | None = None,
    ) -> None:  # fmt: skip
        goal = self._goal
        self._status = m.ManipulationStatus(
            status=status, goal_id=goal.id, attempt=goal.attempt, phase=phase, code=code, detail=detail,
            blockers=list(blockers), stance=stance,
        )  # fmt: skip
        if status != "executing":
            self._inbox.end(goal, self._status)
        self._io.publish(topics.MANIPULATION_STATUS, self._status)
