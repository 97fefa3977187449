"""The arm as the sequences see and move it; each `yield` is one step of robot time, a `Failure` ends the goal."""

from collections.abc import Callable, Generator, Sequence
from typing import Any, TypeVar

import numpy as np

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Array, Pose2
from common.robot.grip import Grip
from services.manipulation.arm import touch
from services.manipulation.arm.contacts import ContactLog
from services.manipulation.arm.servo import Servo
from services.manipulation.arm.touch import BLOCKED, HIT, MET, TOO_HEAVY, Compliance, Guard, Watch, Way
from services.manipulation.arm.trajectory import Leg, timed, turned_back
from services.manipulation.config import ManipulationConfig
from services.manipulation.grasps.grasped_object import GraspedObject
from services.manipulation.planning.motion_planner import PlanError, Planner
from services.manipulation.planning.object_source import ObjectSource

T = TypeVar("T")
Steps = Generator[None, None, T]
DT = 0.02
"""Period of a step and of the arm's commands [s]: the service's 50 Hz."""
GRIPPER_TICKS = 5
"""Steps between two commands to the gripper [count]: 10 Hz."""
SHORT = 0.05
"""Error [rad] of a joint, at rest, from which the arm has not arrived: some 3 cm of the hand. Chosen: it sags by
less."""
BACK, SLOWLY = 0.12, 0.3
"""Way [rad] back off what was met, some 5 cm of the hand; share of the joint speed then. Chosen."""
ARRIVING = 0.2
"""Share of the joint speed near something. Chosen: at the whole of it a pad knocked on an edge that was a little nearer
than believed with 143 N, at 0.3 with 77, in the 60 ms until it is felt and the arm stands."""
CALM, READINGS = 0.1, 10
"""How long [s] the arm rests before its torques are taken, and how many readings of them: what braked it shows as 10 N
on the hand for a moment. Chosen."""
BRAKING = 5.0
"""Deceleration [rad/s^2] off what was met: what the large joints of a Kinova Gen3 can do (5.2 by the user guide)."""


class Failure(Exception):
    """The goal failed; `code` is the status code, `blockers` the objects in the way, the worst first.

    `stance`: where the base would have to stand for it (x, y, theta) [map].
    """

    def __init__(self, code: str, detail: str, blockers: Sequence[str] = (), stance: Pose2 | None = None) -> None:
        super().__init__(detail)
        self.code, self.detail, self.blockers, self.stance = code, detail, tuple(blockers), stance


class Robot:
    """What the sequences see and move: joint angles, gripper, base pose, and the streams to the drivers.

    `sent_to`: by label, the stances (x, y, theta) [map] that were told for an object that is not grasped yet;
    `met_before`: spots (x, y) [map] on whose ways what is held, or the arm, has met something.
    """

    def __init__(self, config: ManipulationConfig, io: Io, source: ObjectSource) -> None:
        self.config, self.io, self.source = config, io, source
        self.now = 0.0
        self.joints: Array = np.zeros(7)
        self.torques: Array = np.zeros(7)
        self.grip = Grip(0.0, 0.0)
        self.base: Pose2 = (0.0, 0.0, 0.0)
        self.phase = ""
        self.grasped: GraspedObject | None = None
        self.contacts = ContactLog()
        self.sent_to: dict[str, list[Pose2]] = {}
        self.met_before: list[tuple[float, float]] = []
        self.planner: Planner | None = None
        self.servo: Servo | None = None
        self._command: Array | None = None
        self._late = 0
        self._weighs: bool | None = None

    # --- motion
    def follow(self, path: Sequence[Array], speed: float, guard: Guard | None = None, most: float = HIT) -> Steps[None]:
        """Stream a joint path and wait until the arm has come to rest at its end.

        Without a `guard` it is watched that the arm meets nothing with more than `most` [N] on the hand; off what it
        meets it goes back a little, along the path.

        Raises:
            Failure: BLOCKED, or what the guard feels; the arm is then where it has met something.
        """
        start = self._command if self._command is not None else self.joints
        points = [start, *path] if np.abs(start - path[0]).max() > 1e-3 else list(path)
        feeler, sent = guard or self._watch(most), [points[0]]
        try:
            yield from self._stream_along(points, speed, feeler, sent)
        except Failure as failure:
            # What pulls at something stays strained: let go at once the arm would fall with it.
            if failure.code != TOO_HEAVY:
                back = BACK if guard is None and failure.code == BLOCKED else 0.0
                if back:
                    self.io.log.info("backing off", detail=failure.detail, phase=self.phase)
                slowly = self.config.joint_speed * SLOWLY
                for q in turned_back(np.array(sent), self.joints, slowly, back, BRAKING, DT):
                    self.stream(q)
                    yield
                self.forget_command()
            raise
        self._command = None

    def travel(self, way: Sequence[Leg], share: float = 1.0) -> Steps[None]:
        """Follow the legs of a path with a `share` of the joint speed, slowly and gently where they are near something.

        Before such a leg the arm comes to rest: the load it begins with is what it is watched by.

        Raises:
            Failure: as `follow`.
        """
        speed = self.config.joint_speed
        for n, leg in enumerate(way):
            if leg.near:
                yield from self.wait(CALM if n else 0.0)
                yield from self.follow(leg.path, speed * min(share, ARRIVING), most=MET)
            else:
                yield from self.follow(leg.path, speed * share)

    def _stream_along(
        self, points: Sequence[Array], speed: float, feeler: Guard | Watch | None, sent: list[Array]
    ) -> Steps[None]:
        """`sent`: the set-points until now are added to it."""
        for q in timed(points, speed, self.config.joint_acceleration, DT):
            self.stream(q)
            sent.append(q)
            yield
            self._check_blocked(q)
            self._check_touched(feeler)
        for _ in range(round(self.config.settle / DT)):
            self.stream(points[-1])
            yield
            self._check_touched(feeler)
            if np.abs(self.joints - points[-1]).max() < 0.01:
                return
        error = np.abs(self.joints - points[-1])
        if error.max() > SHORT:
            raise _behind(error)

    def stream(self, q: Array) -> None:
        """One set-point (7,) [rad] for the next 20 ms; within the joints' limits, which a measured angle may pass."""
        if self.planner is not None:
            q = np.clip(q, self.planner.arm.low, self.planner.arm.high)
        self._command = q
        self.io.publish(topics.ARM_COMMAND, m.ArmCommand(position=q.tolist(), period=DT, t=self.now))

    def _check_blocked(self, q: Array) -> None:
        error = np.abs(self.joints - q)
        # The servos lag behind a moving set-point; only a lasting error means that something is in the way.
        self._late = self._late + 1 if error.max() > self.config.blocked_error else 0
        if self._late > 15:
            self._late = 0
            raise _behind(error)

    def guard(self, rest: Array, most: float = MET, way: Way = "any") -> Guard | None:
        """For a motion near objects; `rest`: torques (7,) [Nm] of the arm in the air."""
        return Guard(self.planner.reaction, rest, most, way) if self.planner is not None else None

    def _watch(self, most: float) -> Watch | None:
        if self.planner is None:
            return None
        holds, reaction = self.grip.holds(), self.planner.reaction
        if self._weighs is None or not holds:
            self._weighs = touch.tells_weight(reaction, self.joints, self.torques)
        return touch.watch(reaction, self.joints, self.torques, holds, self._weighs, most)

    def _check_touched(self, feeler: Guard | Watch | None) -> None:
        code, force = feeler.feel(self.joints, self.torques) if feeler is not None else ("", 0.0)
        if code:
            raise Failure(code, f"{force:.0f} N on the hand")

    def forget_command(self) -> None:
        """The arm was stopped or moved by somebody else."""
        self._command, self._late = None, 0

    def move_gripper(
        self, closed: float, effort: float = 0.0, guard: Guard | None = None, hand: Compliance | None = None
    ) -> Steps[None]:
        """Open or close and wait until the width has settled. Said again and again: one lost command costs nothing.

        `effort` [N] is what a finger presses at most, the configured one unless told; `hand`: moves the arm meanwhile.

        Raises:
            Failure: what the guard feels; the fingers go on pressing until they are told otherwise.
        """
        command = m.GripperCommand(position=closed, max_effort=effort or self.config.grip_effort)
        still, last = 0, self.grip.width
        for n in range(round(1.5 / DT)):
            if n % GRIPPER_TICKS == 0:
                self.io.publish(topics.GRIPPER_COMMAND, command)
            yield
            try:
                self._check_touched(guard)
            except Failure:
                self.stream(self.joints)
                self.forget_command()
                raise
            if hand is not None:
                self.stream(hand.step(self.joints, self.torques))
            still = still + 1 if abs(self.grip.width - last) < 2e-4 else 0
            last = self.grip.width
            if still >= 8 and n > 15:
                return

    def at_rest(self) -> Steps[Array]:
        """The torques (7,) [Nm] of the arm once it is still, over some readings."""
        yield from self.wait(CALM)
        felt = []
        for _ in range(READINGS):
            yield
            felt.append(self.torques)
        return np.asarray(np.mean(felt, axis=0))

    def lifted(self) -> Steps[float]:
        """The upward force [N] of the hand at rest."""
        felt = yield from self.at_rest()
        if self.planner is None:
            return 0.0
        own = self.planner.reaction.weight(self.joints) if self._weighs else 0.0
        return float(self.planner.reaction.force(self.joints, felt - own)[2])

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
            raise Failure(error.code, str(error), error.blockers) from None


def _behind(error: Array) -> Failure:
    """The joints (7,) [rad] that did not come along."""
    worst = int(error.argmax())
    return Failure(BLOCKED, f"joint_{worst + 1} is {error[worst]:.2f} rad behind")


def planner_of(robot: Robot) -> Planner:
    if robot.planner is None:
        raise Failure("NO_ROBOT", "no robot/description was received; is the simulation or the arm's driver up?")
    return robot.planner
