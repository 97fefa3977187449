"""The arm for planning: kinematics and collision checks in the base frame, with solids for what stands around."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import mujoco
import numpy as np
from numpy.typing import NDArray

from common.geometry import Array
from common.robot.joints import ARM
from common.robot.model import Hand, arm_forward, arm_limits, home_arm

BOXES = 24
"""Obstacles that the model has places for [count], the nearest first; chosen."""
FAR = 50.0
"""Where places for obstacles wait that are not needed [m]: farther than any home is large."""
FINGER_ROOM = 0.009
"""What the open fingers leave free beside the thing they go around [m]."""
Solid = Literal["box", "cylinder", "ellipsoid"]
"""What stands for an object or a piece of furniture where distances and collisions are computed."""


@dataclass(frozen=True)
class Obstacle:
    """A solid in the base frame: centre, full extents, yaw. The axis of a cylinder is vertical; if it `lies`, it is
    along its own x. `label` names the object that it stands for, "" furniture and walls. Only the arm, and what it
    holds, meets the `floor`: the base stands on it.
    """

    center: tuple[float, float, float]
    size: tuple[float, float, float]
    yaw: float = 0.0
    solid: Solid = "box"
    lies: bool = False
    label: str = ""
    floor: bool = False

    def geom(self) -> tuple[int, Array, Array, tuple[float, float, float, float]]:
        """MuJoCo's geom type and size (3,), half extents (3,) of the box around it [m], quaternion of its pose."""
        half = np.array(self.size) / 2
        c, s = math.cos(self.yaw / 2), math.sin(self.yaw / 2)
        upright = (c, 0.0, 0.0, s)
        if self.solid == "ellipsoid":
            return int(mujoco.mjtGeom.mjGEOM_ELLIPSOID), half, half, upright
        if self.solid == "box":
            return int(mujoco.mjtGeom.mjGEOM_BOX), half, half, upright
        radius, length = (max(half[1], half[2]), half[0]) if self.lies else (max(half[0], half[1]), half[2])
        # The yaw after a quarter turn about y, which takes z to x.
        w, x, y, z = (v / math.sqrt(2) for v in (c, -s, c, s)) if self.lies else upright
        return (
            int(mujoco.mjtGeom.mjGEOM_CYLINDER), np.array([radius, length, 0.0]), np.array([radius, radius, length]),
            (w, x, y, z),
        )  # fmt: skip


@dataclass(frozen=True)
class Pose:
    """A pose of the pinch point in the base frame: `rotation` (3, 3) has z along the approach, y along the closing."""

    position: Array
    rotation: Array

    def moved(self, offset: Array) -> "Pose":
        return Pose(self.position + offset, self.rotation)


HELD = 0.4
"""Half extents [m] the held box is compiled with, around the pinch point. Chosen: bounds of the broad phase that no
carried object exceeds; a bottle taken at its neck reaches 0.25 m below it, and what is beyond collides with nothing."""
STAND_IN = "stand_in"
"""The geom that takes an object's shape when the hand's distance to it is asked for; it collides with nothing."""
OWN_GAP = 0.005
"""Distance [m] that the arm keeps from the robot in straight motions: it lags by up to .03 rad, 5 mm at the elbow."""
WIDEST_GAP = 0.02
"""Distance [m] from which the robot is looked at where the arm has to keep away from it. Chosen: links that are not
neighbours are farther from each other however the arm bends, a wrist 25 mm from its forearm."""
SOLID, FLOOR, HOLDS = (1, 2), (4, 0), (2, 1 | 4)
"""Bits of `contype` and `conaffinity` of what is around, of the floor, and of what the hand holds."""
TRUNK = 4
"""Joints from the base on whose links the rest of the arm, and what the hand holds, keep away from: those up to the
elbow and the forearm. The links after that are as near to each other in any configuration as they are built."""


def planning_model(robot_mjcf: str) -> Any:
    """The robot's compiled model plus movable boxes and, at the pinch point, a box that stands for a held object."""
    spec: Any = mujoco.MjSpec.from_string(robot_mjcf)
    links = [spec.joint(name).parent for name in ARM[:TRUNK]]
    for link in (spec.body("base"), links[0].parent, *links):
        for geom in link.geoms:
            geom.margin = WIDEST_GAP
    for geom in links[0].find_all("geom"):
        geom.conaffinity |= FLOOR[0] if geom.conaffinity else 0
    kind = mujoco.mjtGeom.mjGEOM_BOX
    for i in range(BOXES):
        box = spec.worldbody.add_body(name=f"box_{i}", mocap=True, pos=[FAR, FAR, i])
        box.add_geom(name=f"box_{i}", type=kind, size=[0.01] * 3, contype=SOLID[0], conaffinity=SOLID[1])
    spec.worldbody.add_geom(name=STAND_IN, type=kind, size=[0.01] * 3, pos=[0, FAR, 0], contype=0, conaffinity=0)
    pos, quat = _pinch_in_gripper(spec.compile())
    spec.body("gripper").add_geom(
        name="held", type=kind, size=[HELD] * 3, pos=pos, quat=quat, mass=0.0,
        contype=HOLDS[0], conaffinity=HOLDS[1],
    )  # fmt: skip
    # The fingers touch what they hold.
    known = {(e.bodyname1, e.bodyname2) for e in spec.excludes}
    for finger in spec.body("gripper").find_all("body"):
        if ("gripper", finger.name) not in known:
            spec.add_exclude(bodyname1="gripper", bodyname2=finger.name)
    return spec.compile()


def _pinch_in_gripper(model: Any) -> tuple[Array, Array]:
    """Position (3,) and quaternion (4,) of the pinch site in the frame of the body `gripper`."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    gripper, site = data.body("gripper"), data.site("pinch")
    turn, quat = gripper.xmat.reshape(3, 3).T, np.empty(4)
    mujoco.mju_mat2Quat(quat, (turn @ site.xmat.reshape(3, 3)).reshape(-1))
    return turn @ (site.xpos - gripper.xpos), quat


class ArmModel:
    """One MuJoCo model of the robot at the origin, arm configurations as arrays (7,)."""

    def __init__(self, robot_mjcf: str) -> None:
        self.model: Any = planning_model(robot_mjcf)
        self.data: Any = mujoco.MjData(self.model)
        self.qpos_at = np.array([self.model.joint(j).qposadr[0] for j in ARM])
        self.dof_at = np.array([self.model.joint(j).dofadr[0] for j in ARM])
        self.low, self.high = arm_limits(self.model)
        self.unlimited = np.isinf(self.low)
        self.home = home_arm(self.model)
        mujoco.mj_kinematics(self.model, self.data)
        self.forward = arm_forward(self.model, self.data)
        self.hand = Hand(self.model)
        self.widest = self.hand.open - FINGER_ROOM
        self._fingers = [self.model.joint(name).qposadr[0] for name in self.hand.joints]
        self.pinch = self.model.site("pinch").id
        # The first joint's anchor, and the farthest that the pinch point gets from it in any configuration [m].
        joints = np.array([self.data.xanchor[self.model.joint(j).id] for j in ARM])
        self.shoulder = joints[0]
        chain = np.vstack([joints, self.data.site_xpos[self.pinch]])
        self.span = float(np.linalg.norm(np.diff(chain, axis=0), axis=1).sum())
        self._held = self.model.geom("held").id
        self._held_at = self.model.geom_pos[self._held].copy()
        self.model.geom_sameframe[self._held] = 0  # its rotation is not that of its body for good
        turn = np.empty(9)
        mujoco.mju_quat2Mat(turn, self.model.geom_quat[self._held])
        self._held_turn = turn.reshape(3, 3)
        self._boxes = [self.model.geom(f"box_{i}").id for i in range(BOXES)]
        self._own = np.ones(self.model.ngeom, bool)
        self._own[self._boxes] = False
        self._mocap = [self.model.body(f"box_{i}").mocapid[0] for i in range(BOXES)]
        self._around: Sequence[Obstacle] = ()
        self.set_obstacles(())
        self.hold(None)

    def set_obstacles(self, obstacles: Sequence[Obstacle], gap: float = OWN_GAP) -> None:
        """Put solids around the robot, the most important first; those over the limit are left out.

        `gap`: how far the arm keeps from the robot itself [m], WIDEST_GAP at most.
        """
        self._gap = gap
        nearest = self._around = obstacles[:BOXES]
        for i, (geom, mocap) in enumerate(zip(self._boxes, self._mocap, strict=True)):
            if i < len(nearest):
                kind, size, half, turn = nearest[i].geom()
                self.model.geom_type[geom] = kind
                meets = FLOOR if nearest[i].floor else SOLID
                self.model.geom_contype[geom], self.model.geom_conaffinity[geom] = meets
                self._resize(geom, half)
                self.model.geom_size[geom] = size
                self.data.mocap_pos[mocap] = nearest[i].center
                self.data.mocap_quat[mocap] = turn
            else:
                self.data.mocap_pos[mocap] = (FAR, FAR, i)

    def hold(self, half: Array | None, offset: Array | None = None, turned: Array | None = None) -> None:
        """Carry a box of these half extents, `offset` and `turned` (3, 3) in the pinch point's frame; None: nothing."""
        flags = (0, 0) if half is None else HOLDS
        self.model.geom_contype[self._held], self.model.geom_conaffinity[self._held] = flags
        if half is not None and offset is not None:
            self._resize(self._held, half)
            self.model.geom_pos[self._held] = self._held_at + self._held_turn @ offset
            turn = self._held_turn if turned is None else self._held_turn @ turned
            mujoco.mju_mat2Quat(self.model.geom_quat[self._held], turn.reshape(-1))

    def _resize(self, geom: int, half: Array) -> None:
        self.model.geom_size[geom] = half
        self.model.geom_rbound[geom] = float(np.linalg.norm(half))
        self.model.geom_aabb[geom] = (0, 0, 0, *half)
        if geom != self._held:
            # The broad phase looks at the body's bounding volume, which the compiler sized.
            self.model.bvh_aabb[self.model.body_bvhadr[self.model.geom_bodyid[geom]]] = (0, 0, 0, *half)

    def open_fingers(self, width: float | None = None) -> None:
        """Every following configuration has the fingers this far apart [m], as far as they go unless told."""
        self.data.qpos[self._fingers] = 0.0 if width is None else self.hand.posture(width)

    def hand_geoms(self) -> list[str | int]:
        """What of the arm must keep away from things: the palm and the last links, without the fingers."""
        model = self.model
        bodies = [model.body("gripper").id, *(int(model.jnt_bodyid[model.joint(ARM[j]).id]) for j in (6, 5, 3))]
        return [g for b in bodies for g in range(model.ngeom) if model.geom_bodyid[g] == b and g != self._held]

    def deck_geoms(self) -> list[str | int]:
        """The upper side of the base."""
        model = self.model
        return [g for g in range(model.ngeom) if model.geom(g).name.startswith("deck")]

    def place(self, q: Array) -> None:
        """Set the arm and compute kinematics."""
        self.data.qpos[self.qpos_at] = q
        mujoco.mj_kinematics(self.model, self.data)

    def pose(self, q: Array) -> Pose:
        """Forward kinematics of the pinch point."""
        self.place(q)
        rotation = self.data.site_xmat[self.pinch].reshape(3, 3)
        return Pose(self.data.site_xpos[self.pinch].copy(), rotation.copy())

    def collides(self, q: Array) -> bool:
        """True when the robot touches a box, or the arm comes nearer to the robot itself than it is to keep."""
        self.place(q)
        mujoco.mj_collision(self.model, self.data)
        return bool(self.data.ncon and len(self._pairs()))

    def meets_itself(self, path: Iterable[Array]) -> bool:
        """True when the robot, on a path of (7,), comes nearer to itself than it is to keep, wherever the boxes are."""
        for q in path:
            self.collides(q)
            if self._own[self._pairs()].all(axis=1).any():
                return True
        return False

    def _pairs(self) -> NDArray[np.int32]:
        """The geoms (n, 2) that touch in the configuration that was looked at last."""
        count = self.data.ncon
        pairs, distance = self.data.contact.geom[:count], self.data.contact.dist[:count]
        touching: NDArray[np.int32] = pairs[distance <= np.where(self._own[pairs].all(axis=1), self._gap, 0.0)]
        return touching

    def met(self) -> set[str]:
        """Labels of the obstacles that the configuration asked about last touches; "" for furniture."""
        touched = {int(g) for pair in self._pairs() for g in pair}
        return {o.label for o, geom in zip(self._around, self._boxes, strict=False) if geom in touched}

    def nearest_turn(self, q: Array, near: Array) -> Array:
        """The same configuration with every unlimited joint at the turn closest to `near`."""
        turns = np.round((near - q) / (2 * math.pi))
        return np.where(self.unlimited, q + 2 * math.pi * turns, q)
