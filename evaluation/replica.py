"""A second copy of the simulated world that is fed with `sim/state`: poses and contacts, never dynamics."""

import math
from collections.abc import Sequence
from typing import Any

import msgspec
import mujoco
import numpy as np

from common import messages as m
from common.scene import ObjectSpec, Scene
from services.sim.objects import body_name
from services.sim.truth import support

GRIPPER = ("gripper", "left_finger", "right_finger")
PENETRATION = 0.0005


class Thing(msgspec.Struct, frozen=True):
    """One object at one moment: `tilt` is the angle of its own z axis to the vertical, `on` what it rests on."""

    position: tuple[float, float, float]
    tilt: float
    on: str
    held: bool
    touched: bool


class Look(msgspec.Struct, frozen=True):
    """The world at robot time `t`. `hits`: (part of the robot, what it touches, depth [m])."""

    t: float
    base: tuple[float, float, float]
    things: dict[str, Thing]
    hits: tuple[tuple[str, str, float], ...]
    pushed: frozenset[str] = frozenset()


class Replica:
    """Built from the MJCF that the simulation publishes."""

    def __init__(self, mjcf: str, scene: Scene) -> None:
        self.scene = scene
        self._model: Any = mujoco.MjModel.from_xml_string(mjcf)
        self._data: Any = mujoco.MjData(self._model)
        model = self._model
        self._specs: list[ObjectSpec] = list(scene.objects)
        self._body = {o.name: model.body(body_name(o)).id for o in self._specs}
        self._object_of = {body: name for name, body in self._body.items()}
        base = model.body("base").id
        self._robot = {b for b in range(model.nbody) if model.body_rootid[b] == base}
        self._gripper = {model.body(n).id for n in GRIPPER}
        self._pads = {model.geom(f"{side}_pad").id for side in ("left", "right")}
        self._base_at = [model.joint(j).qposadr[0] for j in ("base_x", "base_y", "base_yaw")]
        self._floor = model.geom("floor").id

    def look(self, state: m.SimState) -> Look:
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
        robot, other, hits = self._contacts()
        things = {}
        for spec in self._specs:
            name = spec.name
            body = self._body[name]
            x, y, z = (float(v) for v in data.xpos[body])
            up = data.xmat[body].reshape(3, 3)[2]
            reach = sum(abs(float(u)) * s / 2 for u, s in zip(up, spec.size, strict=True))
            held = robot[name] >= self._pads and not other[name]
            things[name] = Thing(
                position=(x, y, z),
                tilt=math.acos(max(-1.0, min(1.0, float(up[2])))),
                on="" if held else support(self.scene, x, y, z - reach),
                held=held,
                touched=any(int(model.geom_bodyid[g]) in self._gripper for g in robot[name]),
            )
        pushed = frozenset(n for n, geoms in robot.items() if geoms)
        base = tuple(float(v) for v in data.qpos[self._base_at])
        return Look(state.t, (base[0], base[1], base[2]), things, tuple(hits), pushed)

    def _contacts(self) -> tuple[dict[str, set[int]], dict[str, bool], list[tuple[str, str, float]]]:
        """Per object the robot's geoms that touch it, and whether anything else does; the robot's other contacts."""
        model, data = self._model, self._data
        robot: dict[str, set[int]] = {name: set() for name in self._body}
        other = dict.fromkeys(self._body, False)
        hits = []
        for contact in range(data.ncon):
            pair = [int(g) for g in data.contact.geom[contact]]
            for one, two in (pair, pair[::-1]):
                body, opposite = int(model.geom_bodyid[one]), int(model.geom_bodyid[two])
                name = self._object_of.get(body)
                if name is not None:
                    if opposite in self._robot:
                        robot[name].add(two)
                    else:
                        other[name] = True
                elif body in self._robot and opposite not in self._robot and opposite not in self._object_of:
                    depth = -float(data.contact.dist[contact])
                    if depth > PENETRATION and not (two == self._floor and body == self._base_body):
                        hits.append((model.body(body).name, self._name(two), depth))
        return robot, other, hits

    @property
    def _base_body(self) -> int:
        return int(self._model.body("base").id)

    def _name(self, geom: int) -> str:
        """What people call the thing a geom belongs to."""
        model = self._model
        words: str = model.geom(geom).name or model.body(int(model.geom_bodyid[geom])).name or "a wall"
        return words.replace("_", " ")


def distance(a: Sequence[float], b: Sequence[float]) -> float:
    """Between two points of any dimension [m]."""
    return math.dist(a, b)
