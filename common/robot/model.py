"""What a robot's MJCF says about its arm and gripper: limits, carry pose, mount, and the fingers of a width."""

from typing import Any

import mujoco
import numpy as np

from common.geometry import Array
from common.robot.joints import ARM

HOME = "home"
SIDES = ("left", "right")
# A gripper whose fingers do not simply slide says where its joints stand for a few widths, widest first.
HAND_JOINTS, HAND_WIDTHS, HAND_POSTURES, HAND_LENGTHS = "hand_joints", "hand_widths", "hand_postures", "hand_lengths"
HAND_ADVANCES = "hand_advances"


def arm_limits(model: Any) -> tuple[Array, Array]:
    """Lowest and highest angles (7,) of the arm, infinite where a joint turns freely."""
    ids = [model.joint(j).id for j in ARM]
    low, high = model.jnt_range[ids].T
    free = model.jnt_limited[ids] == 0
    return np.where(free, -np.inf, low), np.where(free, np.inf, high)


def home_arm(model: Any) -> Array:
    """The carry pose (7,): the arm in keyframe `home`.

    Raises:
        KeyError: the model has none.
    """
    at = [model.joint(j).qposadr[0] for j in ARM]
    return np.array(model.key(HOME).qpos[at])


def arm_forward(model: Any, data: Any) -> float:
    """How far in front of the base's middle the arm's first joint stands [m]; `data` with all joints at zero."""
    return float(data.xanchor[model.joint(ARM[0]).id][0])


def subtree(model: Any, name: str) -> set[int]:
    """The bodies of the model that `name` carries, itself included."""
    top = model.body(name).id
    found = {top}
    for body in range(top + 1, model.nbody):
        if int(model.body_parentid[body]) in found:
            found.add(body)
    return found


def pads(model: Any) -> tuple[frozenset[int], frozenset[int]]:
    """The geoms of the left and of the right finger that touch what is gripped."""
    names = [model.geom(g).name for g in range(model.ngeom)]
    left, right = (frozenset(g for g, n in enumerate(names) if n.startswith(f"{side}_pad")) for side in SIDES)
    return left, right


class RobotKinematics:
    """The robot of a description with its base at the origin, in one posture after the other.

    `open`: the gripper's largest width [m].
    """

    def __init__(self, mjcf: str) -> None:
        self.model: Any = mujoco.MjModel.from_xml_string(mjcf)
        self.data: Any = mujoco.MjData(self.model)
        self._hand = Hand(self.model)
        self.open = self._hand.open
        self._arm = [self.model.joint(name).qposadr[0] for name in ARM]
        self._fingers = [self.model.joint(name).qposadr[0] for name in self._hand.joints]

    def pose(self, arm: Array, width: float) -> None:
        """Take the arm's joint angles (7,) [rad] and the gripper's width [m]."""
        self.data.qpos[:] = 0.0
        self.data.qpos[self._arm] = arm
        self.data.qpos[self._fingers] = self._hand.posture(width)
        mujoco.mj_kinematics(self.model, self.data)


class Hand:
    """The gripper's joints as a function of the width between its pads [m]."""

    def __init__(self, model: Any) -> None:
        self.table: tuple[Array, Array, Array] | None = None
        text = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_TEXT, HAND_JOINTS)
        if text >= 0:
            at, size = model.text_adr[text], model.text_size[text]
            self.joints = tuple(bytes(model.text_data[at : at + size]).rstrip(b"\0").decode().split())
            widths, lengths = (np.array(model.numeric(n).data) for n in (HAND_WIDTHS, HAND_LENGTHS))
            postures = np.array(model.numeric(HAND_POSTURES).data).reshape(len(widths), len(self.joints))
            self.table = widths, lengths, postures
            self._advances = np.array(model.numeric(HAND_ADVANCES).data)
            self.open = float(widths[0])
        else:
            self.joints = tuple(f"{side}_finger" for side in SIDES)
            self._top = float(model.joint(self.joints[0]).range[1])
            self.open = 2 * self._top

    def posture(self, width: float) -> Array:
        """Joint positions, in the order of `joints`."""
        if self.table is None:
            return np.full(2, np.clip(self._top - width / 2, 0.0, self._top))
        widths, _, postures = self.table
        return np.array([np.interp(width, widths[::-1], column[::-1]) for column in postures.T])

    def share(self, width: float) -> float:
        """How far the motor is from open (0) to closed (1) at this width [m]."""
        if self.table is None:
            return float(np.clip(1.0 - width / self.open, 0.0, 1.0))
        widths, lengths, _ = self.table
        length = np.interp(width, widths[::-1], lengths[::-1])
        return float((length - lengths[0]) / (lengths[-1] - lengths[0]))

    def advance(self, width: float) -> float:
        """How far along the approach the middle of the pads is beyond the site `pinch` at this width [m].

        Pads on a linkage move on an arc, forward while they close; sliding ones stay.
        """
        if self.table is None:
            return 0.0
        return float(np.interp(width, self.table[0][::-1], self._advances[::-1]))
