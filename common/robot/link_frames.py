"""The frames of the robot's links; the link `base_link` is the body `base` of the description."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from common import messages as m
from common.messages.base import Quat
from common.robot.frames import BASE_LINK, FramePose
from common.robot.joints import ARM, BASE_BODY
from common.robot.model import RobotKinematics


class LinkFrames:
    """The links of a robot's description, each in its parent, by its joints' positions.

    Raises:
        ValueError: not a model.
        KeyError: not of this robot's build.
    """

    def __init__(self, mjcf: str) -> None:
        self._kinematics = RobotKinematics(mjcf)
        model = self._kinematics.model
        base = model.body(BASE_BODY).id
        self._bodies = [b for b in range(model.nbody) if model.body_rootid[b] == base and b != base]
        self._parents = [int(model.body_parentid[b]) for b in self._bodies]
        self._names = [
            (link_name(model, p), link_name(model, b)) for b, p in zip(self._bodies, self._parents, strict=True)
        ]

    def poses(self, joints: m.JointStates) -> list[FramePose]:
        """Every link but the base in the link that carries it; none where an arm joint is not reported."""
        q = dict(zip(joints.name, joints.position, strict=False))
        if not all(name in q for name in ARM):
            return []
        self._kinematics.pose(np.array([q[name] for name in ARM]), q.get("gripper", self._kinematics.open))
        data = self._kinematics.data
        return list(self._relative(data, joints.t))

    def _relative(self, data: Any, t: float) -> Iterator[FramePose]:
        for body, parent, (above, name) in zip(self._bodies, self._parents, self._names, strict=True):
            turn = data.xmat[parent].reshape(3, 3).T
            x, y, z = (float(v) for v in turn @ (data.xpos[body] - data.xpos[parent]))
            yield FramePose(above, name, (x, y, z), _between(data.xquat[parent], data.xquat[body]), t)


def link_name(model: Any, body: int) -> str:
    """The frame of a body."""
    name = str(model.body(body).name)
    return BASE_LINK if name == BASE_BODY else name or f"body_{body}"


def _between(a: Any, b: Any) -> Quat:
    """Rotation b in the frame of rotation a: the product of a's conjugate and b."""
    w, x, y, z = float(a[0]), -float(a[1]), -float(a[2]), -float(a[3])
    bw, bx, by, bz = (float(v) for v in b)
    return (
        w * bw - x * bx - y * by - z * bz,
        w * bx + x * bw + y * bz - z * by,
        w * by - x * bz + y * bw + z * bx,
        w * bz + x * by - y * bx + z * bw,
    )
