"""Physical faults: what the world does to a grasp, injected into MuJoCo by the evaluator and asserted from its state.

The injectors sit behind the simulation's door, as message faults do: `afflicted` returns a class in the simulation's
place whose every step they follow. No service can reach them: nothing below `services/` imports `evaluation`.
"""

import math
from itertools import pairwise
from typing import Any, Literal

import msgspec
import mujoco
import numpy as np
from msgspec.structs import replace

from common import topics
from common.kinds import kind_of
from common.robot import SIDES, Hand, subtree
from common.scene import Scene
from common.support import MARGIN
from common.time.lockstep import DT
from evaluation.shortest import FloorPlan
from evaluation.strikes import Report, Struck
from services.sim.objects import GROUP
from services.sim.physics import Physics
from services.sim.truth import touching

Kind = Literal["shove", "slip", "heavy", "wide", "jam", "obstacle"]
ARRIVED = 0.06
"""Speed of the hand [m/s] below which it comes to rest around an object: a third of its speed on the way in."""
CLOSED = 0.5
"""Share of the gripper's stroke that is commanded, beyond which it counts as told to close."""
SHOVE, SHOVE_SPEED, BEYOND = 0.03, 0.5, 0.045
"""The least shove [m] and its speed [m/s], at which a bottle rocks and does not fall; over before the fingers close.
An object is pushed so far [m] beyond its own half width from the pinch point: pads that reach 19 mm close beside it,
also when it rocks back by 15 mm."""
SHOVING = 0.3
"""Longest that a shove lasts [s]."""
SHARE = 0.3
"""The share of an object's weight that lowered friction can still hold: it slides whatever its pose."""
SLID = 0.01
"""Travel in the hand [m] that counts as sliding: five times the slip of a good grasp at its worst."""
JAM, STIFF_REF, STIFF_IMP = 500.0, (0.004, 1.0), (0.9999, 0.9999, 0.001, 0.5, 2.0)
"""Dry friction [N] of a jammed finger: six times what the gripper's motor can do. MuJoCo's default friction constraint
creeps by 0.3 m/s under that motor; this solref and solimp leave under 0.1 mm/s."""
HELD_UP = 0.3
"""Seconds that a hand told to close has to stand open before its finger counts as jammed; closing takes 0.1 s."""
STAYS = 0.005
"""Most that the width [m] of a jammed hand changes, half of what is free on both sides of the smallest gap."""
PULLED = 20.0
"""Force [N] with which the pads pull an object up, which shows that the hand tried to lift it: five times the weight of
the heaviest object of the scenes, and a third of the lightest one that is too heavy."""
NEAR = 1.0
"""Distance [m] of the base within which an object is in reach and an obstacle has to be avoided."""
AT_REST, DROVE = 0.02, 0.3
"""Speed of the base [m/s] below which it rests, and for how long [s] when a drive is over."""


class PhysicalFault(msgspec.Struct, frozen=True, kw_only=True):
    """What happens to the grasp of `thing`, or in the robot's way (`thing`: an obstacle).

    `shove`: pushed out of the hand as the fingers come. `slip`: after it was carried `after` metres the pads lose
    their friction for `seconds`. `jam`: a finger stays where it is for `seconds` when it should close. `heavy`: it has
    the mass `amount` [kg]. `wide`: it is `amount` [m] wide and deep, which nobody told the robot. `obstacle` changes
    nothing: it is watched whether it came in the way.
    """

    kind: Kind
    thing: str
    seconds: float = 0.0
    after: float = 0.0
    amount: float = 0.0

    def world(self, scene: Scene) -> Scene:
        """The scene with the object as it really is."""
        changes: dict[str, Any] = {}
        if self.kind == "heavy":
            changes["mass"] = self.amount
        objects = []
        for spec in scene.objects:
            if spec.name == self.thing and self.kind == "wide":
                height = self.amount if kind_of(spec.kind).shape == "sphere" else spec.size[2]
                changes["size"] = (self.amount, self.amount, height)
            objects.append(replace(spec, **changes) if spec.name == self.thing else spec)
        return replace(scene, objects=tuple(objects))


class Injector:
    """One fault. `step` follows every 10 ms of physics and returns what was seen when the fault took effect."""

    def __init__(self, fault: PhysicalFault, physics: Physics) -> None:
        self.fault, self.physics = fault, physics
        model = physics.model
        self.body = physics.bodies.get(fault.thing, -1)
        if self.body >= 0:
            self.spec = next(p.spec for p in physics.placements if p.spec.name == fault.thing)
        self._pinch = model.site("pinch").id
        self._before = self.pinch()
        self.over = False

    def step(self, now: float, state: str) -> str:
        """`state`: the brain's. Nothing is left to do once `over`."""
        raise NotImplementedError

    # --- what the world shows
    def pinch(self) -> Any:
        """Where the fingers meet (3,) [m]."""
        return self.physics.data.site_xpos[self._pinch].copy()

    def thing(self) -> Any:
        """The object's centre (3,) [m]."""
        return self.physics.data.xpos[self.body].copy()

    def closing(self) -> bool:
        """The gripper is told to close."""
        model, at = self.physics.model, self.physics.gripper_ctrl
        low, high = model.actuator_ctrlrange[at]
        return bool((self.physics.data.ctrl[at] - low) / (high - low) > CLOSED)

    def touched(self) -> int:
        """How many of the two fingers' pads touch the object."""
        robot, _ = touching(self.physics)
        return sum(bool(robot[self.spec.name] & side) for side in self.physics.pads)

    def in_hand(self) -> Any:
        """The object's centre in the hand's frame (3,) [m]."""
        turn = self.physics.data.site_xmat[self._pinch].reshape(3, 3)
        return turn.T @ (self.thing() - self.pinch())

    def arrived(self) -> bool:
        """The open hand has come to rest with the object between its fingers."""
        at, before = self.pinch(), self._before
        self._before = at
        slow = float(np.linalg.norm(at - before)) < ARRIVED * DT
        return slow and not self.closing() and self._between()

    def _between(self) -> bool:
        """A line from one pad to the other goes through the object."""
        model, data = self.physics.model, self.physics.data
        one, two = (np.mean([data.geom_xpos[g] for g in side], axis=0) for side in self.physics.pads)
        gap = float(np.linalg.norm(two - one))
        if np.linalg.norm(self.thing() - self.pinch()) > max(self.spec.size):
            return False
        hit, objects = np.array([-1], dtype=np.int32), np.zeros(mujoco.mjNGROUP, dtype=np.uint8)
        objects[GROUP] = 1
        far = mujoco.mj_ray(model, data, one, (two - one) / gap, objects, 1, -1, hit)
        return bool(0 <= far < gap and model.geom_bodyid[hit[0]] == self.body)


class Shove(Injector):
    """Pushes the object, upright, out from between the fingers just before they close."""

    def __init__(self, fault: PhysicalFault, physics: Physics) -> None:
        super().__init__(fault, physics)
        joint = physics.model.body_jntadr[self.body]
        self._dof = int(physics.model.jnt_dofadr[joint])
        self._from: Any = None
        self._way: Any = None
        self._beyond = 0.0
        self._closed_at: float | None = None
        self._pushing = 0

    def step(self, now: float, state: str) -> str:
        if self._from is None:
            if self.arrived():
                self._begin()
            return ""
        gone = float(np.linalg.norm((self.thing() - self._from)[:2]))
        if self._pushing:
            self._push(gone)
        return self._seen(now, gone)

    def _begin(self) -> None:
        pinch, thing = self.pinch(), self.thing()
        turn = self.physics.data.site_xmat[self._pinch].reshape(3, 3)
        half = max(self.spec.size[:2]) / 2
        ways = [v[:2] / np.linalg.norm(v[:2]) for v in (turn[:, 2], turn[:, 0], -turn[:, 0]) if abs(v[2]) < 0.9]
        for way in ways:
            far = max(SHOVE, half + BEYOND - float((thing - pinch)[:2] @ way))
            if self._free(thing[:2] + far * way, half):
                self._from, self._way, self._beyond = thing, way, half + BEYOND
                self._in_hand = self.in_hand()
                self._pushing = round(SHOVING / DT)
                return

    def _free(self, at: Any, half: float) -> bool:
        """On the same surface, with nobody else there."""
        physics = self.physics
        x, y = (float(v) for v in self.thing()[:2])
        on = [r for r in physics.scene.receptacles if r.contains(x, y, MARGIN)]
        stays = all(
            r.contains(float(at[0] + dx), float(at[1] + dy), MARGIN)
            for r in on
            for dx in (-half, half)
            for dy in (-half, half)
        )
        others = [
            (physics.data.xpos[physics.bodies[p.spec.name]][:2], max(p.spec.size[:2]) / 2)
            for p in physics.placements
            if p.spec.name != self.spec.name
        ]
        return stays and all(np.linalg.norm(where - at) > half + size + 0.01 for where, size in others)

    def _push(self, gone: float) -> None:
        """On until it is clear of the hand, which may still be coming."""
        self._pushing -= 1
        ahead = float((self.thing() - self.pinch())[:2] @ self._way)
        on = self._pushing > 0 and (gone < SHOVE or ahead < self._beyond)
        speed = SHOVE_SPEED if on else 0.0
        self._pushing = self._pushing if on else 0
        dof = self._dof
        self.physics.data.qvel[dof : dof + 2] = speed * self._way
        self.physics.data.qvel[dof + 3 : dof + 6] = 0.0

    def _seen(self, now: float, gone: float) -> str:
        """Once the fingers have closed; another try where they did not come, or still found the object."""
        if self._closed_at is None:
            self._closed_at = now if self.closing() else None
        elif now - self._closed_at > HELD_UP:
            off = float(np.linalg.norm(self.in_hand() - self._in_hand))
            self.over = min(gone, off) >= 0.9 * SHOVE
            self._from, self._closed_at = None, None
        width, pads = self.physics.width(), self.touched()
        told = f"shoved {1000 * gone:.0f} mm as the fingers came: closed to {1000 * width:.0f} mm, {pads} pads touch it"
        return told if self.over else ""


class Slip(Injector):
    """Takes the pads' friction away for a while as the object is carried; again if it has not slid by then."""

    def __init__(self, fault: PhysicalFault, physics: Physics) -> None:
        super().__init__(fault, physics)
        self._pads = [g for side in physics.pads for g in side]
        self._friction = physics.model.geom_friction[self._pads].copy()
        self._driven = 0.0
        self._last: Any = None
        self._lowered: float | None = None
        self._held_at: Any = None

    def step(self, now: float, state: str) -> str:
        if self._lowered is not None:
            return self._watch(now)
        if not self.closing() or self.touched() < 2:
            self._last = None
            return ""
        base = self.physics.joints[:2].copy()
        self._driven += 0.0 if self._last is None else float(np.linalg.norm(base - self._last))
        self._last = base
        if self._driven >= self.fault.after:
            self._lower(now)
        return ""

    def _lower(self, now: float) -> None:
        physics = self.physics
        weight = float(physics.model.body_mass[self.body]) * 9.81
        force = max(abs(physics.finger_force()), 1.0)
        # Two pads; torsional and rolling friction in proportion.
        share = SHARE * weight / (2 * force) / self._friction[:, :1]
        physics.model.geom_friction[self._pads] = self._friction * share
        self._lowered, self._held_at = now, self.in_hand()

    def _watch(self, now: float) -> str:
        assert self._lowered is not None
        slid = float(np.linalg.norm(self.in_hand() - self._held_at))
        # Pads bounce on what slides between them: it is lost once it has left the hand.
        lost = self.touched() == 0 and not self._between()
        if not lost and now - self._lowered < self.fault.seconds:
            return ""
        self.physics.model.geom_friction[self._pads] = self._friction
        self.over = lost or slid >= SLID
        # Nothing slid: once more after the next stretch of the way.
        self._lowered, self._driven = None, 0.0
        if not self.over:
            return ""
        return f"friction lowered in transit; {'lost' if lost else 'still held'} after sliding {1000 * slid:.0f} mm"


class Jam(Injector):
    """Holds one finger where it is, just before it should close."""

    def __init__(self, fault: PhysicalFault, physics: Physics) -> None:
        super().__init__(fault, physics)
        model = physics.model
        hand, finger = subtree(model, "gripper"), int(model.geom_bodyid[min(physics.pads[SIDES.index("right")])])
        self._dofs: list[int] = []
        while finger in hand and model.body_dofnum[finger]:
            self._dofs += range(
                int(model.body_dofadr[finger]), int(model.body_dofadr[finger] + model.body_dofnum[finger])
            )
            finger = int(model.body_parentid[finger])
        self._free = self._friction()
        self._until: float | None = None
        self._open = self._told = 0.0
        self._struck = False

    def step(self, now: float, state: str) -> str:
        physics = self.physics
        if self._until is None:
            if self.arrived():
                self._brake((JAM, STIFF_REF, STIFF_IMP))
                self._until, self._open, self._told = float("inf"), physics.width(), 0.0
            return ""
        if now >= self._until:
            self._brake(self._free)
            self._until, self.over = None, self._struck
            return ""
        self._told = self._told + DT if self.closing() else 0.0
        if self._struck or self._told < HELD_UP:
            return ""
        width = physics.width()
        self._struck = self._open - width < STAYS and self.touched() < 2
        # One that came too late is let go at once, for the next grasp.
        self._until = now + self.fault.seconds if self._struck else now
        told = f"told to close for {self._told:.1f} s, a finger stays: {1000 * width:.0f} mm open"
        return told if self._struck else ""

    def _friction(self) -> tuple[Any, Any, Any]:
        model = self.physics.model
        return tuple(a[self._dofs].copy() for a in (model.dof_frictionloss, model.dof_solref, model.dof_solimp))

    def _brake(self, values: tuple[Any, Any, Any]) -> None:
        model = self.physics.model
        for array, value in zip((model.dof_frictionloss, model.dof_solref, model.dof_solimp), values, strict=True):
            array[self._dofs] = value


class Heavy(Injector):
    """Watches for the hand to close on the object and to pull it up."""

    _grasped: Any = None

    def step(self, now: float, state: str) -> str:
        if not self.closing():
            self._grasped = None
            return ""
        if self._grasped is None:
            self._grasped = self.thing() if self.touched() == 2 else None
            return ""
        pull = self._pull()
        if pull < PULLED:
            return ""
        self.over = True
        mass, rise = float(self.physics.model.body_mass[self.body]), float(self.thing()[2] - self._grasped[2])
        return f"{mass:.1f} kg grasped and pulled up with {pull:.0f} N: it rose {1000 * rise:.0f} mm"

    def _pull(self) -> float:
        """Upward force [N] of the pads on the object."""
        model, data = self.physics.model, self.physics.data
        pads, force, up = set().union(*self.physics.pads), np.zeros(6), 0.0
        for number in range(data.ncon):
            contact = data.contact[number]
            one, two = (int(g) for g in contact.geom)
            if not (pads & {one, two} and self.body in model.geom_bodyid[[one, two]]):
                continue
            # A contact's force is that on its second geom.
            mujoco.mj_contactForce(model, data, number, force)
            on_thing = 1.0 if model.geom_bodyid[two] == self.body else -1.0
            up += on_thing * float(contact.frame.reshape(3, 3)[:, 2] @ force[:3])
        return up


class Wide(Injector):
    """Watches for the robot to stand before the object, about to grab it."""

    def step(self, now: float, state: str) -> str:
        gap = float(np.linalg.norm(self.thing()[:2] - self.physics.joints[:2]))
        narrowest, opening = min(self.spec.size), Hand(self.physics.model).open
        self.over = state == "GRABBING" and gap < NEAR and narrowest > opening
        return f"{1000 * narrowest:.0f} mm wide before a hand of {1000 * opening:.0f} mm" if self.over else ""


class InTheWay(Injector):
    """Watches for the robot to come upon the obstacle while it drives, or to drive another way because of it.

    A robot that sees an obstacle from afar goes round in time: then it lay on the shortest path of a drive.
    """

    def __init__(self, fault: PhysicalFault, physics: Physics) -> None:
        super().__init__(fault, physics)
        self._since: tuple[float, float] | None = None
        self._resting = 0.0

    def step(self, now: float, state: str) -> str:
        if state not in ("NAVIGATING", "RETURNING", "GROUNDING"):
            self._since = None
            return ""
        found = self.physics.obstacles.report(self.physics.data)[self.fault.thing]
        x, y = found["position"][:2]
        here = (float(self.physics.joints[0]), float(self.physics.joints[1]))
        gap = math.dist((x, y), here)
        if gap < NEAR:
            self.over = True
            return f"the {self.fault.thing} {gap:.2f} m from the robot's middle"
        moving = float(np.hypot(*self.physics.rates[:2])) > AT_REST
        self._resting = 0.0 if moving else self._resting + DT
        if moving and self._since is None:
            self._since = here
        if self._since is None or self._resting < DROVE:
            return ""
        start, self._since = self._since, None
        path = FloorPlan(self.physics.scene).path(start, [here])
        self.over = any(_from_line((x, y), a, b) < max(found["size"][:2]) / 2 for a, b in pairwise(path))
        return f"the {self.fault.thing} on the shortest path of a drive, which went round it" if self.over else ""


def _from_line(point: tuple[float, float], a: tuple[float, float], b: tuple[float, float]) -> float:
    """Distance [m] of a point from the line from `a` to `b`."""
    along = np.subtract(b, a)
    share = float(np.clip(np.dot(np.subtract(point, a), along) / max(float(along @ along), 1e-9), 0.0, 1.0))
    return float(np.linalg.norm(np.subtract(point, a) - share * along))


INJECTORS: dict[Kind, type[Injector]] = {
    "shove": Shove, "slip": Slip, "jam": Jam, "heavy": Heavy, "wide": Wide, "obstacle": InTheWay,
}  # fmt: skip


def afflicted(kind: Any, faults: tuple[PhysicalFault, ...], report: Report) -> Any:
    """The simulation's class with the faults in its world; the class itself when there are none."""
    if not faults:
        return kind

    told = topics.BRAIN_STATE

    class Afflicted(kind):  # type: ignore[misc]
        READS = (*kind.READS, told)

        def __init__(self, config: Any, io: Any) -> None:
            for fault in faults:
                io.scene = fault.world(io.scene)
            super().__init__(config, io)
            self._afflictions = [INJECTORS[f.kind](f, self.physics) for f in faults]
            self._told_io = io

        def step(self, now: float) -> None:
            super().step(now)
            state = self._told_io.latest(told)
            for injector in [i for i in self._afflictions if not i.over]:
                if what := injector.step(now, state.state if state is not None else ""):
                    fault = injector.fault.kind
                    self._told_io.log.warning("fault injected", fault=fault, what=what)
                    report(Struck(round(now, 2), fault, what))

    Afflicted.__name__ = Afflicted.__qualname__ = f"Afflicted{kind.__name__}"
    return Afflicted
