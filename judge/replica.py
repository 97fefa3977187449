"""A second copy of the simulated world that is fed with `sim/state`: where things are and what holds them."""

import math
from typing import Any

import mujoco
import numpy as np

from common import messages as m
from common.body_extent import lowest
from common.robot.model import Hand, pads, subtree
from common.scene import ObjectSpec, Scene, body_name
from common.support import support
from judge.evidence import Sample
from judge.track import Thing


class Replica:
    """Built from the MJCF that the simulation publishes."""

    def __init__(self, mjcf: str, scene: Scene, files: dict[str, bytes] | None = None) -> None:
        self.scene = scene
        self._model: Any = mujoco.MjModel.from_xml_string(mjcf, files or {})
        self._data: Any = mujoco.MjData(self._model)
        model = self._model
        self._specs: list[ObjectSpec] = list(scene.objects)
        self._body = {o.name: model.body(body_name(o)).id for o in self._specs}
        self._is_robot = model.body_rootid[model.geom_bodyid] == model.body("base").id
        self._owner = np.full(model.ngeom, -1)
        for number, body in enumerate(self._body.values()):
            self._owner[model.geom_bodyid == body] = number
        self._gripper = subtree(model, "gripper")
        self._pads = pads(model)
        hand = Hand(model)
        self._fingers_at = [model.joint(j).qposadr[0] for j in hand.joints]
        self._widths = np.linspace(0.0, hand.open, round(1000 * hand.open) + 1)
        self._postures = np.array([hand.posture(float(w)) for w in self._widths])
        self._base_at = [model.joint(j).qposadr[0] for j in ("base_x", "base_y", "base_yaw")]
        starts = [model.joint(body_name(o)).qposadr[0] for o in self._specs]
        self._poses_at = np.array(starts, dtype=int).reshape(-1, 1) + np.arange(7)
        self._poses = np.full(self._poses_at.shape, np.nan)
        self._things: dict[str, Thing] = {}

    def sample(self, state: m.SimState) -> Sample:
        """Poses and contacts of a published state.

        Raises:
            ValueError: the state is of another model.
        """
        model, data = self._model, self._data
        qpos, mocap = np.frombuffer(state.qpos), np.frombuffer(state.mocap)
        if len(qpos) != model.nq or len(mocap) != 3 * model.nmocap:
            raise ValueError("sim/state does not fit sim/model")
        data.qpos[:] = qpos
        if model.nmocap:
            data.mocap_pos[:] = mocap.reshape(-1, 3)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        robot, other = self._contacts()
        poses = qpos[self._poses_at]
        moved = (poses != self._poses).any(axis=1).tolist()
        self._poses = poses
        things = {}
        for spec, elsewhere in zip(self._specs, moved, strict=True):
            name = spec.name
            before = self._things.get(name)
            if not (elsewhere or before is None or before.touched or robot[name]):
                things[name] = before  # most things lie still most of the time
                continue
            body = self._body[name]
            x, y, z = (float(v) for v in data.xpos[body])
            up = data.xmat[body].reshape(3, 3)[2]
            held = all(robot[name] & side for side in self._pads) and name not in other
            things[name] = Thing(
                position=(x, y, z),
                tilt=math.acos(max(-1.0, min(1.0, float(up[2])))),
                on="" if held else support(self.scene, x, y, lowest(model, data, body)),
                held=held,
                touched=any(int(model.geom_bodyid[g]) in self._gripper for g in robot[name]),
            )
        self._things = things
        base = tuple(float(v) for v in data.qpos[self._base_at])
        apart = np.square(self._postures - qpos[self._fingers_at]).sum(axis=1)
        opening = float(self._widths[int(np.argmin(apart))])
        return Sample(state.t, (base[0], base[1], base[2]), things, opening)

    def _contacts(self) -> tuple[dict[str, set[int]], set[str]]:
        """Per object the robot's geoms that touch it; the objects that anything else touches."""
        data, owner, mine = self._data, self._owner, self._is_robot
        pairs = data.contact.geom[: data.ncon]
        by_robot = mine[pairs[:, 0]] | mine[pairs[:, 1]]
        supported = {self._specs[k].name for k in set(owner[pairs[~by_robot]].ravel().tolist()) - {-1}}
        robot: dict[str, set[int]] = {o.name: set() for o in self._specs}
        for a, b in pairs[by_robot].tolist():
            part, thing = (a, b) if mine[a] else (b, a)
            if owner[thing] >= 0:
                robot[self._specs[owner[thing]].name].add(part)
        return robot, supported
