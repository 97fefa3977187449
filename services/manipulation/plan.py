"""Plans a whole grab or placement: inverse kinematics for candidates, collision-free paths between the phases."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from services.manipulation.arm_model import ArmModel, Array, Obstacle, Pose
from services.manipulation.grasp import Grasp, Target, candidates
from services.manipulation.ik import InverseKinematics, seeds
from services.manipulation.surroundings import with_thing
from services.manipulation.trajectory import connect

CARTESIAN_STEP = 0.02
MAX_JUMP = 0.6
HELD_SHRINK = 0.008
TRANSIT_MARGINS = (0.02, 0.01, 0.005)
# Close to the body; for long things the hand is turned or tips up so that they stay clear of the arm.
_CARRY = tuple((tip, turn) for tip in (0.0, 0.4, 0.8) for turn in (0.0, np.pi / 2, -np.pi / 2))


class PlanError(Exception):
    """No plan; `code` is the status code, the text says why."""

    def __init__(self, code: str, detail: str) -> None:
        super().__init__(detail)
        self.code = code


USUAL_SIZE = (0.06, 0.06, 0.10)  # of something in the hand that nobody described [m]


@dataclass(frozen=True)
class Held:
    """What is in the gripper: the pose it was grasped with, relative to the object's underside centre."""

    label: str
    kind: str
    rotation: Array
    offset: Array
    size: tuple[float, float, float]
    width: float
    yaw: float

    def box(self) -> tuple[Array, Array]:
        """Half extents and centre of the object in the pinch frame."""
        c, s = np.cos(self.yaw), np.sin(self.yaw)
        turned = self.rotation.T @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
        half = np.abs(turned) @ (np.array(self.size) / 2) - HELD_SHRINK
        center = self.rotation.T @ (np.array([0, 0, self.size[2] / 2]) - self.offset)
        return np.maximum(half, 0.004), center


def inflated(around: Sequence[Obstacle], margin: float) -> list[Obstacle]:
    """The boxes grown by the margin kept in transit."""
    grow = 2 * margin
    return [Obstacle(o.center, (o.size[0] + grow, o.size[1] + grow, o.size[2] + grow), o.yaw) for o in around]


@dataclass(frozen=True)
class GrabPlan:
    """Joint paths of the phases, and what will be held."""

    grasp: Grasp
    reach: list[Array]
    insert: list[Array]
    lift: list[Array]
    carry: list[Array]
    held: Held


@dataclass(frozen=True)
class PlacePlan:
    reach: list[Array]
    lower: list[Array]
    retreat: list[Array]
    home: list[Array]
    spot: tuple[float, float]


class Planner:
    """Lives in the worker thread; owns the arm's model."""

    def __init__(self, robot_mjcf: str, seed: int) -> None:
        self.arm = ArmModel(robot_mjcf)
        self.ik = InverseKinematics(self.arm)
        self.carries = tuple(self.arm.home + np.array([0, 0, 0, 0, 0, tip, turn]) for tip, turn in _CARRY)
        self._seed = seed

    def candidates(self, target: Target) -> list[Grasp]:
        """Every grasp that this hand could try."""
        return candidates(target, self.arm.forward, self.arm.widest)

    def grab(
        self,
        target: Target,
        around: Sequence[Obstacle],
        now: Array,
        approach: float,
        lift: float,
        reach: float,
        skip: frozenset[str],
    ) -> GrabPlan:
        """The first candidate grasp that can be reached and carried away.

        Raises:
            PlanError: UNREACHABLE.
        """
        distance = float(np.hypot(target.position[0] - self.arm.forward, target.position[1]))
        if distance > reach:
            raise PlanError("UNREACHABLE", f"{target.label} is {distance:.2f} m from the arm, reach is {reach:.2f} m")
        options = [g for g in self.candidates(target) if g.name not in skip]
        if not options:
            raise PlanError("UNREACHABLE", f"no grasp left to try on {target.label}")
        failures: dict[str, int] = {}
        for grasp in options:
            plan = self._try_grab(target, grasp, around, now, approach, lift)
            if isinstance(plan, GrabPlan):
                return plan
            failures[plan] = failures.get(plan, 0) + 1
        reasons = ", ".join(f"{why} x{n}" for why, n in failures.items())
        raise PlanError("UNREACHABLE", f"no reachable grasp of {target.label} at {distance:.2f} m: {reasons}")

    def _try_grab(
        self, target: Target, grasp: Grasp, around: Sequence[Obstacle], now: Array, approach: float, lift: float
    ) -> "GrabPlan | str":
        arm = self.arm
        rng = np.random.default_rng(self._seed)
        own = Obstacle(target.position, target.size, target.yaw)
        arm.hold(None)
        arm.set_obstacles(around)
        at = self.ik.solve(grasp.pose, seeds(arm, grasp.pose, now), avoid=True)
        if at is None:
            return "no IK"
        at = arm.nearest_turn(at, now)
        if arm.collides(at):
            return "grasp collides"
        back = self.straight(at, grasp.pose, grasp.pose.moved(-approach * grasp.pose.rotation[:, 2]))
        if back is None:
            return "no straight approach"
        up = self.straight(at, grasp.pose, grasp.pose.moved(np.array([0.0, 0.0, lift])))
        if up is None:
            return "no straight lift"
        if any(arm.collides(q) for q in back):
            return "approach collides"
        self._surround(with_thing(around, own), back[-1])
        there = connect(arm, now, back[-1], rng)
        if there is None:
            return "no path to the pre-grasp"
        bottom = np.array([target.position[0], target.position[1], target.bottom])
        held = Held(
            target.label, target.kind, grasp.pose.rotation, grasp.pose.position - bottom, target.size, grasp.width,
            target.yaw,
        )  # fmt: skip
        arm.hold(*held.box())
        self._surround(around, up[-1])
        away = self._to_carry(up[-1], rng)
        arm.hold(None)
        if away is None:
            return "no path to the carry pose"
        return GrabPlan(grasp, there, [at, *back][::-1], [at, *up], away, held)

    def refine(self, plan: GrabPlan, shift: tuple[float, float], approach: float, lift: float) -> GrabPlan:
        """The same grasp of an object that stands `shift` [m] (x, y in the base frame) from where it was planned.

        Raises:
            PlanError: UNREACHABLE.
        """
        grasp = replace(plan.grasp, pose=plan.grasp.pose.moved(np.array([*shift, 0.0])))
        self.arm.hold(None)
        at = self.ik.solve(grasp.pose, [plan.insert[-1]])
        if at is not None:
            back = self.straight(at, grasp.pose, grasp.pose.moved(-approach * grasp.pose.rotation[:, 2]))
            up = self.straight(at, grasp.pose, grasp.pose.moved(np.array([0.0, 0.0, lift])))
            if back is not None and up is not None and not any(self.arm.collides(q) for q in (at, *back)):
                return replace(plan, grasp=grasp, insert=[at, *back][::-1], lift=[at, *up])
        raise PlanError("UNREACHABLE", "the corrected grasp is out of reach")

    def _surround(self, around: Sequence[Obstacle], end: Array) -> None:
        """Boxes with the widest transit margin that leaves `end` free, or as they are."""
        for margin in TRANSIT_MARGINS:
            self.arm.set_obstacles(inflated(around, margin))
            if not self.arm.collides(end):
                return
        self.arm.set_obstacles(around)

    def carry(self, held: Held, now: Array, around: Sequence[Obstacle]) -> list[Array]:
        """A path to a carry pose with the object in hand, from wherever the arm is.

        Raises:
            PlanError: BLOCKED.
        """
        self.arm.hold(*held.box())
        self.arm.set_obstacles(around)
        path = self._to_carry(now, np.random.default_rng(self._seed))
        self.arm.hold(None)
        if path is None:
            raise PlanError("BLOCKED", f"no way to the carry pose with the {held.label} in hand")
        return path

    def _to_carry(self, start: Array, rng: np.random.Generator) -> list[Array] | None:
        """A path to the first carry pose where the held object is clear of the arm."""
        for carry in self.carries:
            goal = self.arm.nearest_turn(carry, start)
            if not self.arm.collides(goal):
                path = connect(self.arm, start, goal, rng)
                if path is not None:
                    return path
        return None

    def place(
        self,
        held: Held,
        spots: Sequence[tuple[float, float]],
        surface: float,
        drop: float,
        around: Sequence[Obstacle],
        now: Array,
    ) -> PlacePlan:
        """Set the held object down on the first spot of a surface that works, `drop` above it.

        Raises:
            PlanError: UNREACHABLE.
        """
        rng = np.random.default_rng(self._seed)
        failures: dict[str, int] = {}
        for spot in spots[:10]:
            for turn in (0.0, 0.5, -0.5, 1.0, -1.0, 2.0, -2.0, np.pi):
                plan = self._try_place(held, spot, surface + drop, turn, around, now, rng)
                if isinstance(plan, PlacePlan):
                    return plan
                failures[plan] = failures.get(plan, 0) + 1
        reasons = ", ".join(f"{why} x{n}" for why, n in failures.items()) or "no free spot within reach"
        raise PlanError("UNREACHABLE", f"cannot put {held.label} there: {reasons}")

    def _try_place(
        self,
        held: Held,
        spot: tuple[float, float],
        height: float,
        turn: float,
        around: Sequence[Obstacle],
        now: Array,
        rng: np.random.Generator,
    ) -> "PlacePlan | str":
        arm = self.arm
        arm.set_obstacles(around)
        approach = held.rotation[:, 2]
        # Straight down has no azimuth of its own: the hand's x axis points away from the robot there.
        level = approach if np.hypot(approach[0], approach[1]) > 0.2 else held.rotation[:, 0]
        was = np.arctan2(level[1], level[0])
        delta = np.arctan2(spot[1], spot[0] - arm.forward) - was + turn
        c, s = np.cos(delta), np.sin(delta)
        spin = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
        target = Pose(np.array([*spot, height]) + spin @ held.offset, spin @ held.rotation)
        above = target.moved(np.array([0.0, 0.0, 0.08]))
        arm.hold(None)
        high = self.ik.solve(above, seeds(arm, above, now))
        if high is None:
            return "no IK"
        high = arm.nearest_turn(high, now)
        down = self.straight(high, above, target)
        if down is None:
            return "no straight way down"
        if any(arm.collides(q) for q in down):
            return "placing collides"
        arm.hold(*held.box())
        if arm.collides(high):
            return "object collides above the spot"
        self._surround(around, high)
        there = connect(arm, now, high, rng)
        arm.hold(None)
        arm.set_obstacles(around)
        if there is None:
            return "no path"
        tilted = abs(approach[2]) < 0.85
        away = -0.10 * target.rotation[:, 2] if tilted else np.array([0.0, 0.0, 0.12])
        stands = Obstacle((*spot, height + held.size[2] / 2), held.size, held.yaw + delta)
        beside = with_thing(around, stands)
        back = self._leave(target, away, [*down[-2::-1], high], down[-1], beside)
        if back is None:
            return "no way back"
        self._surround(beside, back[-1])
        home = connect(arm, back[-1], arm.nearest_turn(arm.home, back[-1]), rng)
        if home is None:
            return "no path home"
        return PlacePlan(there, [high, *down], [down[-1], *back], home, spot)

    def _leave(
        self, target: Pose, away: Array, as_it_came: list[Array], at: Array, beside: Sequence[Obstacle]
    ) -> list[Array] | None:
        """Off what was put down: by `away`, by a part of it, or where the arm is stretched the way it came."""
        self.arm.set_obstacles(beside)
        for share in (1.0, 0.6):
            path = self.straight(at, target, target.moved(share * away))
            if path is not None and not self.arm.collides(path[-1]):
                return path
        return None if self.arm.collides(as_it_came[-1]) else as_it_came

    def to_home(self, now: Array, around: Sequence[Obstacle]) -> list[Array]:
        """A path to the carry pose; straight where nothing better is found."""
        self.arm.hold(None)
        self._surround(around, now)
        goal = self.arm.nearest_turn(self.arm.home, now)
        return connect(self.arm, now, goal, np.random.default_rng(self._seed)) or [now, goal]

    def pose(self, q: Array) -> Pose:
        """Where the pinch point is."""
        return self.arm.pose(q)

    def straight(self, start: Array, begin: Pose, end: Pose) -> list[Array] | None:
        """Configurations along a straight line of the pinch point, without the first; None when the arm cannot."""
        gap = end.position - begin.position
        count = max(2, round(float(np.linalg.norm(gap)) / CARTESIAN_STEP))
        path, q = [], start
        for i in range(1, count + 1):
            solved = self.ik.solve(Pose(begin.position + gap * (i / count), begin.rotation), [q])
            if solved is None or np.abs(solved - q).max() > MAX_JUMP:
                return None
            path.append(solved)
            q = solved
        return path
