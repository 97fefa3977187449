"""The sequences of manipulation as generators: each `yield` is one step of robot time, a `Failure` ends the goal."""

import math
from collections.abc import Callable, Generator, Sequence
from typing import Any, TypeVar

import numpy as np

from common import messages as m
from common import topics
from common.geometry import Pose2, compose
from common.io import Io
from common.messages import WorldObject
from services.manipulation.arm_model import Array, Obstacle
from services.manipulation.config import ManipulationConfig
from services.manipulation.grasp import approach_rotation, shown
from services.manipulation.object_source import ObjectSource
from services.manipulation.plan import GrabPlan, Held, PlacePlan, PlanError, Planner
from services.manipulation.surroundings import obstacles, spots, target_of
from services.manipulation.trajectory import timed
from services.manipulation.verify import Grip, holds, judge

T = TypeVar("T")
Steps = Generator[None, None, T]
DT = 0.02
FLOOR_SPOTS = ((0.60, 0.0), (0.60, 0.2), (0.60, -0.2))
DROP = 0.004
BIN_DROP = 0.06


class Failure(Exception):
    """The goal failed; `code` is the status code."""

    def __init__(self, code: str, detail: str) -> None:
        super().__init__(detail)
        self.code, self.detail = code, detail


class Robot:
    """What the sequences see and move: joint angles, gripper, base pose, and the streams to the drivers."""

    def __init__(self, config: ManipulationConfig, io: Io, source: ObjectSource) -> None:
        self.config, self.io, self.source = config, io, source
        self.now = 0.0
        self.joints: Array = np.zeros(7)
        self.grip = Grip(0.0, 0.0)
        self.base: Pose2 = (0.0, 0.0, 0.0)
        self.phase = ""
        self.held: Held | None = None
        self.planner: Planner | None = None
        self._command: Array | None = None
        self._late = 0

    # --- motion
    def follow(self, path: Sequence[Array], speed: float) -> Steps[None]:
        """Stream a joint path and wait until the arm has come to rest at its end."""
        start = self._command if self._command is not None else self.joints
        points = [start, *path] if np.abs(start - path[0]).max() > 1e-3 else list(path)
        for q in timed(points, speed, self.config.joint_acceleration, DT):
            self._stream(q)
            yield
            self._check_blocked(q)
        for _ in range(round(self.config.settle / DT)):
            self._stream(points[-1])
            yield
            if np.abs(self.joints - points[-1]).max() < 0.01:
                break
        self._command = None

    def _stream(self, q: Array) -> None:
        self._command = q
        self.io.publish(topics.ARM_COMMAND, m.ArmCommand(position=q.tolist(), period=DT, t=self.now))

    def _check_blocked(self, q: Array) -> None:
        error = np.abs(self.joints - q)
        # The servos lag behind a moving set-point; only a lasting error means that something is in the way.
        self._late = self._late + 1 if error.max() > self.config.blocked_error else 0
        if self._late > 15:
            self._late = 0
            worst = int(error.argmax())
            raise Failure("BLOCKED", f"joint_{worst + 1} is {error[worst]:.2f} rad behind")

    def forget_command(self) -> None:
        """The arm was stopped or moved by somebody else."""
        self._command, self._late = None, 0

    def move_gripper(self, closed: float) -> Steps[None]:
        """Open or close and wait until the width has settled."""
        effort = self.config.grip_effort
        self.io.publish(topics.GRIPPER_COMMAND, m.GripperCommand(position=closed, max_effort=effort))
        still, last = 0, self.grip.width
        for n in range(round(1.5 / DT)):
            yield
            still = still + 1 if abs(self.grip.width - last) < 2e-4 else 0
            last = self.grip.width
            if still >= 8 and n > 15:
                return

    def wait(self, seconds: float) -> Steps[None]:
        for _ in range(round(seconds / DT)):
            yield

    def work(self, fn: Callable[..., T], *args: Any) -> Steps[T]:
        """Run slow work in the worker and wait for it."""
        job = self.io.submit(fn, *args, seconds=self.config.planning_seconds)
        while not job.poll(self.now):
            yield
        try:
            return job.result()
        except PlanError as error:
            raise Failure(error.code, str(error)) from None


def grab(robot: Robot, goal: m.ManipulationGoal, wanted: str) -> Steps[str]:
    """Reach, grasp, retract; another candidate after a miss. Returns the evidence."""
    config, planner = robot.config, _planner(robot)
    since = robot.now - config.fresh
    tried: set[str] = set()
    last = Failure("UNREACHABLE", "no grasp tried")
    for _ in range(config.max_candidates):
        found = yield from _sighted(robot, goal, wanted, since)
        robot.phase = "reach"
        target = target_of(found, robot.base, robot.io.scene)
        around = obstacles(robot.io.scene, robot.base, robot.source.objects(), without=found.label)
        try:
            plan = yield from robot.work(
                planner.grab, target, around, robot.joints.copy(), config.approach_distance, config.lift_height,
                config.reach, frozenset(tried),
            )  # fmt: skip
        except Failure as failure:
            raise (failure if not tried else last) from None
        options, name = planner.candidates(target), plan.grasp.name
        robot.io.publish(topics.GRASPS, shown(target, options, robot.base, robot.now, tried, name, goal.id))
        tried.add(plan.grasp.name)
        robot.io.log.info("grasp chosen", object=found.label, grasp=plan.grasp.name)
        try:
            return (yield from _execute_grab(robot, plan, goal, found))
        except Failure as failure:
            if failure.code not in ("EMPTY_GRASP", "SLIPPED", "BLOCKED"):
                raise
            last = failure
            robot.io.log.warning("grasp failed", code=failure.code, detail=failure.detail, grasp=plan.grasp.name)
            if failure.code == "BLOCKED" and robot.held is not None and holds(robot.grip, config):
                return (yield from _carry_again(robot, robot.held, around))
            robot.phase = "retract"
            robot.held = None
            yield from robot.move_gripper(0.0)
            yield from go_home(robot)
            # What was seen while the hand was at work may have been half hidden by it.
            since = robot.now
    raise last


def _sighted(robot: Robot, goal: m.ManipulationGoal, wanted: str, since: float) -> Steps[WorldObject]:
    """The object to grab as it was seen after `since`; an older sighting will do when no newer one comes in time."""
    robot.phase = "look"
    end = robot.now + (robot.config.look_patience if robot.io.peer("perception") else 0.0)
    while True:
        found = robot.source.resolve(goal, wanted, robot.base, since)
        if found is not None and (found.seen_at >= since or robot.now >= end):
            return found
        if robot.now >= end:
            what = wanted or (goal.object.label if goal.object else "object")
            raise Failure("NO_OBJECT", f"no {what} is known here")
        yield


def _aimed(robot: Robot, plan: GrabPlan, goal: m.ManipulationGoal, found: WorldObject) -> Steps[GrabPlan]:
    """The plan corrected by what the wrist camera sees from in front of the object, or as it was."""
    config, since = robot.config, robot.now
    if not robot.io.peer("perception"):
        return plan
    robot.phase = "aim"
    seen: WorldObject | None = None
    while seen is None and robot.now - since < config.aim_patience:
        yield
        closer = robot.source.resolve(goal, found.label, robot.base, since)
        seen = closer if closer is not None and closer.label == found.label and closer.seen_at >= since else None
    if seen is None:
        return plan
    was, new = (target_of(o, robot.base, robot.io.scene).position for o in (found, seen))
    shift = new[0] - was[0], new[1] - was[1]
    if not config.aim_least <= math.hypot(*shift) <= config.aim_most:
        return plan
    robot.io.log.info("aim corrected", object=found.label, by_mm=round(1000 * math.hypot(*shift), 1))
    try:
        return (yield from robot.work(
            _planner(robot).refine, plan, shift, config.approach_distance, config.lift_height
        ))  # fmt: skip
    except Failure:
        return plan


def _execute_grab(robot: Robot, plan: GrabPlan, goal: m.ManipulationGoal, found: WorldObject) -> Steps[str]:
    config = robot.config
    yield from robot.move_gripper(0.0)
    yield from robot.follow(plan.reach, config.joint_speed)
    plan = yield from _aimed(robot, plan, goal, found)
    yield from robot.follow(plan.insert, config.joint_speed * 0.6)
    robot.phase = "grasp"
    yield from robot.move_gripper(1.0)
    _judge(robot, plan, None)
    closed = robot.grip
    robot.held = plan.held
    robot.phase = "retract"
    yield from robot.follow(plan.lift, config.joint_speed * 0.5)
    _judge(robot, plan, closed.width)
    yield from robot.follow(plan.carry, config.joint_speed * 0.8)
    yield from robot.wait(0.2)
    _judge(robot, plan, closed.width)
    robot.source.remember(plan.held.label, None, "", robot.now)
    return f"{plan.held.label} held: width {robot.grip.width * 1000:.1f} mm, force {robot.grip.force:.0f} N"


def _carry_again(robot: Robot, held: Held, around: list[Obstacle]) -> Steps[str]:
    """Something was in the way with the object in hand: another path to the carry pose, without letting go."""
    robot.forget_command()
    path = yield from robot.work(_planner(robot).carry, held, robot.joints.copy(), around)
    yield from robot.follow(path, robot.config.joint_speed * 0.5)
    if not holds(robot.grip, robot.config):
        raise Failure("SLIPPED", f"the {held.label} was lost on the way to the carry pose")
    robot.source.remember(held.label, None, "", robot.now)
    return f"{held.label} held: width {robot.grip.width * 1000:.1f} mm, force {robot.grip.force:.0f} N"


def _judge(robot: Robot, plan: GrabPlan, at_close: float | None) -> None:
    nominal = plan.grasp.width if plan.held.kind != "bowl" else 0.0
    code = judge(robot.grip, nominal, at_close, robot.config)
    if code:
        was = "" if at_close is None else f", was {at_close * 1000:.1f} mm"
        detail = f"width {robot.grip.width * 1000:.1f} mm{was}, force {robot.grip.force:.0f} N"
        raise Failure(code, detail)


def place(robot: Robot, where: str) -> Steps[str]:
    """Set the held object down on a receptacle, or with "" on the delivery surface or whatever is in reach."""
    planner, scene = _planner(robot), robot.io.scene
    held = robot.held or _unknown(robot)
    robot.phase = "place"
    footprint = max(held.size[0], held.size[1])
    known = [o for o in robot.source.objects() if o.label != held.label]
    names = [where] if where else [scene.delivery, *(r.name for r in scene.receptacles if not r.depth)]
    choices: list[tuple[str, list[tuple[float, float]], float, float]] = []
    for name in dict.fromkeys(names):
        r = scene.receptacle(name)
        if r is None:
            continue
        taken = [] if r.depth else known
        surface, drop = (r.depth, BIN_DROP) if r.depth else (r.center[2], DROP)
        free = spots(r, robot.base, footprint if not r.depth else max(r.size), taken)
        if free:
            choices.append((r.name, free, surface, drop))
    if not where:
        choices.append(("floor", list(FLOOR_SPOTS), 0.0, DROP))
    if not choices:
        raise Failure("UNREACHABLE", f"no free spot of the {where} is within reach from here")
    last = Failure("UNREACHABLE", "nothing within reach")
    for name, free, surface, drop in choices:
        try:
            plan = yield from robot.work(
                planner.place, held, free, surface, drop, _around(robot, held, name), robot.joints.copy()
            )
        except Failure as failure:
            last = failure
            continue
        return (yield from _execute_place(robot, plan, held, name, surface))
    raise last


def _around(robot: Robot, held: Held, where: str) -> list[Obstacle]:
    """What the arm must not touch while it puts something down; what lies in a bin may be covered."""
    r = robot.io.scene.receptacle(where)
    inside = where if r is not None and r.depth else None
    objects = [o for o in robot.source.objects() if o.on != inside]
    return obstacles(robot.io.scene, robot.base, objects, without=held.label, margin=0.0)


def _execute_place(robot: Robot, plan: PlacePlan, held: Held, name: str, surface: float) -> Steps[str]:
    config = robot.config
    yield from robot.follow(plan.reach, config.joint_speed * 0.8)
    if robot.grip.width <= config.empty_width:
        robot.held = None
        raise Failure("SLIPPED", f"the {held.label} was lost on the way")
    yield from robot.follow(plan.lower, config.joint_speed * 0.4)
    yield from robot.wait(0.2)
    robot.phase = "release"
    yield from robot.move_gripper(0.0)
    robot.held = None
    if robot.grip.width < min(_planner(robot).arm.widest, held.width) + 0.004:
        raise Failure("STUCK", f"the gripper opened to {robot.grip.width * 1000:.0f} mm only")
    robot.phase = "retract"
    try:
        yield from robot.follow(plan.retreat, config.joint_speed * 0.5)
        yield from robot.follow(plan.home, config.joint_speed)
    except Failure as failure:
        # The object stands; another way home from here.
        robot.io.log.warning("on the way home", code=failure.code, detail=failure.detail)
        robot.forget_command()
        yield from go_home(robot)
    x, y, _ = compose(robot.base, (*plan.spot, 0.0))
    robot.source.remember(held.label, (x, y, surface + held.size[2] / 2), name, robot.now)
    return f"{held.label} on the {name}, gripper open at {robot.grip.width * 1000:.0f} mm"


def go_home(robot: Robot) -> Steps[str]:
    """The carry pose, by a path around what is known."""
    around = obstacles(robot.io.scene, robot.base, robot.source.objects(), margin=0.0)
    path = yield from robot.work(_planner(robot).to_home, robot.joints.copy(), around)
    yield from robot.follow(path, robot.config.joint_speed)
    return "arm at home"


def _planner(robot: Robot) -> Planner:
    if robot.planner is None:
        raise Failure("NO_ROBOT", "no robot/description was received; is the simulation or the arm's driver up?")
    return robot.planner


def _unknown(robot: Robot) -> Held:
    """Something is in the gripper that a former process grasped: assume it hangs straight down from the hand."""
    name = next((o.label for o in robot.source.objects() if o.held), "object")
    size = next((o.size for o in robot.source.objects() if o.held), (0.06, 0.06, 0.10))
    offset = np.array([0.0, 0.0, size[2] / 2])
    return Held(name, "", approach_rotation(0.0, np.pi / 2), offset, size, robot.grip.width, 0.0)
