"""Collision-free motions of the arm, with and without something in the hand: what grabbing and placing are made of."""

from collections import Counter, deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Generic, TypeVar

import numpy as np

from common.geometry import Array
from common.kinds import kind_of
from services.manipulation.arm.arm_model import ArmModel, Obstacle, Pose
from services.manipulation.arm.ik import InverseKinematics
from services.manipulation.arm.touch import Reaction
from services.manipulation.arm.trajectory import Leg, connect, legs
from services.manipulation.grasps.antipodal import antipodal
from services.manipulation.grasps.clearance import HandClearance
from services.manipulation.grasps.evidence import as_held, believed, has_parts, seen_between
from services.manipulation.grasps.grasp import POOR, Grasp
from services.manipulation.grasps.grasped_object import GraspedObject
from services.manipulation.grasps.mouth import in_the_mouth
from services.manipulation.grasps.over_edge import flat_and_wide, is_round, over_an_edge
from services.manipulation.grasps.rules import candidates
from services.manipulation.grasps.surface import surface
from services.manipulation.grasps.target import Target

PLAINLY = 0.012
"""How much wider [m] than the hand takes a flat thing is that is only taken over an edge: the error of extents of
what is seen in part."""
REMEMBERED = 4
"""Targets of which answers are kept: one as measured, as seen, and without what is completed of it, and one more."""
CARTESIAN_STEP = 0.02
"""Distance [m] between the configurations along a straight line. Chosen: joints in between hardly leave it."""
MAX_JUMP = 0.6
"""Largest change of a joint [rad] from one of them to the next. Chosen: more is another branch of the inverse
kinematics."""
TRANSIT_MARGINS = (0.02, 0.01, 0.005)
"""Margins [m] around obstacles and the robot itself in free motion, widest first. Chosen: from the error of a sighting
at 2 m down to that of one at arm's length; the arm itself lags by up to .03 rad, 5 mm at the elbow."""
NEAR = 0.05
"""Distance [m] from what is known around up to which the arm, and what it holds, goes slowly. Chosen: the error of
localisation, 3 cm, with the lag of the arm and what a path moves between two collision checks."""
NEAREST = 0.02
"""How near [m] to what it goes over something in the hand may be that hangs lower than believed: a windmill hung askew
by 43 degrees and met the edge of its cabinet from the side; an apple and a whisk hung 49 and 55 mm lower."""
LEAVING = 0.15
"""Way [m] of the hand from where it has lifted something on which it may meet what stands around. Chosen: at the speed
of transit a bowl that hung askew met its shelf with 67 N in the 60 ms until the arm stood."""
# Tip and turn [rad] of the hand at the carry pose: for long objects it is turned or tips up, so that they stay clear.
# At 0.2 what was taken from the side keeps within the 0.35 m to the edges that the base drives up to, at 0.4 no more.
_CARRY = tuple((tip, turn) for tip in (0.0, 0.2, 0.4, 0.8) for turn in (0.0, np.pi / 2, -np.pi / 2))


class PlanError(Exception):
    """No plan; `code` is the status code, the text says why, `blockers` the objects in the way, the worst first."""

    def __init__(self, code: str, detail: str, blockers: Sequence[str] = ()) -> None:
        super().__init__(detail)
        self.code, self.blockers = code, tuple(blockers)


def inflated(around: Sequence[Obstacle], margin: float) -> list[Obstacle]:
    """The solids grown by the margin kept in transit."""
    grow = 2 * margin
    return [replace(o, size=(o.size[0] + grow, o.size[1] + grow, o.size[2] + grow)) for o in around]


def counted(reasons: Iterable[str]) -> str:
    """`no IK x3, grasp collides x1`."""
    return ", ".join(f"{why} x{n}" for why, n in Counter(reasons).items())


T = TypeVar("T")


class LastAnswers(Generic[T]):
    """What a function answered for the last few targets: grasps on a surface take half a second to find, and one plan
    asks for those of the same target up to three times."""

    def __init__(self, answer: Callable[[Target], T]) -> None:
        self._answer = answer
        self._known: deque[tuple[Target, T]] = deque(maxlen=REMEMBERED)

    def __call__(self, target: Target) -> T:
        # Targets are equal whose points differ: the same one is meant.
        found = next(((answer,) for known, answer in self._known if known is target), None)
        if found is None:
            found = (self._answer(target),)
            self._known.append((target, found[0]))
        return found[0]


class Planner:
    """Lives in the worker thread; owns the arm's model."""

    def __init__(self, robot_mjcf: str, seed: int) -> None:
        self.arm = ArmModel(robot_mjcf)
        self.ik = InverseKinematics(self.arm)
        self.clearance = HandClearance(self.arm)
        self.reaction = Reaction(self.arm)
        self.carries = tuple(self.arm.home + np.array([0, 0, 0, 0, 0, tip, turn]) for tip, turn in _CARRY)
        self._seed = seed
        self._on_surface = LastAnswers(self._antipodal)
        self.believed = LastAnswers(self._believed)

    def rng(self) -> np.random.Generator:
        """The same draws for every plan."""
        return np.random.default_rng(self._seed)

    def _believed(self, target: Target) -> Target:
        """The object with its measured shape, or as it was seen. Of what is too wide, slice by slice or all around,
        only thin parts can be held, as a pot by its handle: then what was seen is not completed to the far side.
        """
        found = believed(target)
        if found.family == "irregular":
            return found if self._worth(found) >= POOR else max(found, replace(found, shape="long"), key=self._worth)
        if not self._nowhere_held(found) or not has_parts(found):
            return found
        parts = replace(found, shape="long")
        return parts if self._on_surface(parts) else found

    def _nowhere_held(self, target: Target) -> bool:
        """Something round that stands, and was seen, is held well nowhere by its wall."""
        if not is_round(target) or min(target.size[:2]) <= self.arm.widest or flat_and_wide(target, self.arm.widest):
            return False
        return not self._rules(target) and self._worth(target) < POOR

    def _worth(self, target: Target) -> float:
        """That of the best grasp on its surface."""
        return max((grasp.worth for grasp in self._on_surface(target)), default=-np.inf)

    def candidates(self, target: Target) -> Iterator[list[Grasp]]:
        """Every grasp that this hand could try, in stages: over an edge; by the rules of kind and shape; on the seen
        surface, which comes first where no rule knows the shape. What is plainly too wide is only taken over an edge;
        nothing is held where nothing of it was seen.
        """
        arm = self.arm
        yield over_an_edge(target, arm.forward, arm.widest)
        if not is_round(target) and flat_and_wide(target, arm.widest + PLAINLY):
            return
        stages = self._rules, self._on_surface
        # By its wall beside its middle a bowl turns between the pads, and leans on what it is lifted from.
        shapeless = target.shape in ("long", "irregular") and not (target.lies or kind_of(target.kind).by_the_rim)
        for stage in reversed(stages) if shapeless else stages:
            yield [grasp for grasp in stage(target) if seen_between(target, grasp)]

    def _rules(self, target: Target) -> list[Grasp]:
        arm = self.arm
        points = surface(target)
        by_rule = (as_held(target, points, grasp) for grasp in candidates(target, arm.forward, arm.widest))
        return [grasp for grasp in by_rule if grasp is not None] + in_the_mouth(target)

    def _antipodal(self, target: Target) -> list[Grasp]:
        arm = self.arm
        return antipodal(target, arm.forward, arm.hand.open, arm.widest)

    def surround(self, around: Sequence[Obstacle], end: Array, others: Sequence[Array] = ()) -> None:
        """Boxes, and the robot itself, with the widest transit margins that leave `end`, and one of the `others`, free,
        else with none: the boxes come first, the robot keeps what it can where something else is near."""
        for margin, own in (*((m, m) for m in TRANSIT_MARGINS), *((0.0, m) for m in TRANSIT_MARGINS)):
            self.arm.set_obstacles(inflated(around, margin), own)
            if not self.arm.collides(end) and not (others and all(self.arm.collides(q) for q in others)):
                return
        self.arm.set_obstacles(around, 0.0)

    def legs(self, path: Sequence[Array], around: Sequence[Obstacle], leaving: float = 0.0) -> list[Leg]:
        """A path in parts: where the arm, or what it holds, keeps `NEAR` away from everything around, and where not,
        or where the hand has come less than `leaving` [m]."""
        self.arm.set_obstacles(inflated(around, NEAR), 0.0)
        start = self.arm.pose(path[0]).position

        def near(q: Array) -> bool:
            return self.arm.collides(q) or float(np.linalg.norm(self.arm.pose(q).position - start)) < leaving

        return legs(path, near)

    def carry(self, held: GraspedObject, now: Array, around: Sequence[Obstacle]) -> list[Leg]:
        """A path to a carry pose with the object in hand, from wherever the arm is.

        Raises:
            PlanError: BLOCKED.
        """
        path = self.to_carry(held, now, around)
        if path is None:
            raise PlanError("BLOCKED", f"no way to the carry pose with the {held.label} in hand")
        return path

    def to_carry(self, held: GraspedObject, start: Array, around: Sequence[Obstacle]) -> list[Leg] | None:
        """A path to the first carry pose where the held object is clear of the arm; None if there is no way."""
        goals, rng = [self.arm.nearest_turn(carry, start) for carry in self.carries], self.rng()
        self.arm.hold(*held.box())
        try:
            self.surround(around, start, goals)
            paths = (connect(self.arm, start, goal, rng) for goal in goals if not self.arm.collides(goal))
            path = next((path for path in paths if path is not None), None)
            return None if path is None else self.legs(path, around, LEAVING)
        finally:
            self.arm.hold(None)

    def bring(
        self, held: GraspedObject, start: Array, goal: Array, around: Sequence[Obstacle], above: float
    ) -> list[Leg]:
        """A path with the object in hand to where it is `above` [m] what it is put on; empty if there is no way.

        It goes over the edge of that as if the object hung lower by nearly as much, or by half of it, where it can.
        """
        try:
            for lower in (max(0.0, above - NEAREST), above / 2, 0.0):
                self.arm.hold(*held.box(lower))
                self.surround(around, goal, [start])
                # No way is looked for from, or to, where only the longer object would touch something.
                if lower and (self.arm.collides(start) or self.arm.collides(goal)):
                    continue
                if path := connect(self.arm, start, goal, self.rng()):
                    self.arm.hold(*held.box())
                    return self.legs(path, around)
            return []
        finally:
            self.arm.hold(None)

    def to_home(self, now: Array, around: Sequence[Sequence[Obstacle]]) -> list[Array]:
        """A path to the carry pose around the first set of obstacles that leaves one; straight where none does."""
        self.arm.hold(None)
        goal = self.arm.nearest_turn(self.arm.home, now)
        for some in around:
            self.surround(some, now, [goal])
            if path := connect(self.arm, now, goal, self.rng()):
                return path
        return [now, goal]

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
