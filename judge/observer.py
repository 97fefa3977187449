"""Collects evidence and claims of a running robot from the simulation's state and the robot's messages.

Whoever judges feeds it: the examiner of an evaluation, a benchmark, the demonstration.
"""

import math
from typing import Any

import mujoco
import numpy as np

from common import messages as m
from common.body_extent import lowest
from common.robot.joints import BASE, BASE_BODY
from common.robot.model import Hand, pads, subtree
from common.scene import ObjectSpec, Scene, body_name
from common.support import support
from judge.claims import Claim, ClaimListener, Statement
from judge.effects import Shown, Watcher
from judge.evidence import Evidence, EvidenceRecorder, Sample
from judge.goal import Goal, shortfall
from judge.track import ThingState

WATCH = 10.0
"""Robot time [s] that physics is watched on after a mission: what was put down badly falls meanwhile."""


class Observer:
    """Watches one robot; `claims` are those made so far, each with physics' verdict at that moment.

    `saying`: the sentence that the robot is saying aloud, "" for none.
    """

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        bins = frozenset(r.name for r in scene.receptacles if r.depth)
        self._recorder = EvidenceRecorder({o.name: o.kind for o in scene.objects}, bins)
        self._watcher = Watcher(scene)
        self._replica: Replica | None = None
        self._listener = ClaimListener()
        self._goal = Goal()
        self._goals: dict[str, Goal] = {}
        self._may_move: frozenset[str] = frozenset()
        self.saying = ""
        self.claims: list[Claim] = []

    @property
    def ready(self) -> bool:
        """True once a state of the world was taken."""
        return self._recorder.ready

    # --- physics
    def model(self, model: m.SimModel) -> None:
        """Take the world's model; only the first one counts."""
        self._replica = self._replica or Replica(model.mjcf, self._scene, model.files)

    def world(self, state: m.SimState) -> Sample | None:
        """Take a state of the world and return its sample; None before the model is known."""
        if self._replica is None:
            return None
        sample = self._replica.sample(state)
        self._recorder.add(sample)
        self._watcher.add(sample)
        return sample

    def contacts(self, report: m.SimContacts) -> None:
        """Take a part of the simulation's log of contacts."""
        self._recorder.note_contacts(report)

    # --- what is wanted
    def begin(self) -> None:
        """Begin the case, before its first command: what has moved until now was the world settling."""
        self._recorder.restart()

    def expect(self, goal: Goal) -> None:
        """Set what the next mission should bring about."""
        self._goal = goal
        self._may_move |= goal.things

    # --- what the robot says
    def brain(self, now: float, state: m.BrainState) -> None:
        """Take a message of `brain/state` at robot time `now`."""
        if state.mission_id:
            self._goals.setdefault(state.mission_id, self._goal)
        self._hold(now, self._listener.state(state))

    def status(self, now: float, status: m.SystemStatus) -> None:
        """Take a message of `system_status`."""
        self._hold(now, self._listener.status(status))

    def speech(self, now: float, status: m.SpeechStatus) -> str:
        """Take a message of `speech/status`; returns the sentence being said, "" for none. It counts as it begins."""
        saying = status.detail if status.state == "speaking" else ""
        if saying and saying != self.saying:
            self.sentence(now, saying)
        self.saying = saying
        return saying

    def sentence(self, now: float, text: str) -> None:
        """Take a sentence that the robot says aloud."""
        self._watcher.hear(text)
        self._hold(now, self._listener.sentence(text))

    def _hold(self, now: float, statements: list[Statement]) -> None:
        """Add statements as claims, with physics' verdict on them now."""
        for said in statements:
            why = self.shortfall(self._goals.get(said.mission, self._goal))
            self.claims.append(Claim(round(now, 2), said.source, said.text, said.mission, said.command, why))

    # --- the end
    def shortfall(self, goal: Goal) -> str:
        """What is missing of `goal` now, in words; "" for nothing."""
        return shortfall(self._recorder.things(goal.wants), self.shown(goal))

    def shown(self, goal: Goal) -> list[Shown]:
        """For each effect of the goal whether it has been shown until now."""
        return self._watcher.conclude(goal.effects)

    def wrong(self) -> list[str]:
        """Names of objects that were in the hand though nobody asked for them."""
        return sorted(self._watcher.lifted - self._may_move)

    def conclude(self, goal: Goal) -> Evidence:
        """The evidence of the whole case, with the things that `goal` wants."""
        return self._recorder.conclude(goal.wants, self._may_move | goal.things)


class Replica:
    """A copy of the simulated world, built from the MJCF that the simulation publishes and fed with `sim/state`."""

    def __init__(self, mjcf: str, scene: Scene, files: dict[str, bytes] | None = None) -> None:
        self.scene = scene
        self._model: Any = mujoco.MjModel.from_xml_string(mjcf, files or {})
        self._data: Any = mujoco.MjData(self._model)
        model = self._model
        self._specs: list[ObjectSpec] = list(scene.objects)
        self._body = {o.name: model.body(body_name(o)).id for o in self._specs}
        self._is_robot = model.body_rootid[model.geom_bodyid] == model.body(BASE_BODY).id
        self._owner = np.full(model.ngeom, -1)
        for number, body in enumerate(self._body.values()):
            self._owner[model.geom_bodyid == body] = number
        self._gripper = subtree(model, "gripper")
        self._pads = pads(model)
        hand = Hand(model)
        self._fingers_at = [model.joint(j).qposadr[0] for j in hand.joints]
        self._widths = np.linspace(0.0, hand.open, round(1000 * hand.open) + 1)
        self._postures = np.array([hand.posture(float(w)) for w in self._widths])
        self._base_at = [model.joint(j).qposadr[0] for j in BASE]
        starts = [model.joint(body_name(o)).qposadr[0] for o in self._specs]
        self._poses_at = np.array(starts, dtype=int).reshape(-1, 1) + np.arange(7)
        self._poses = np.full(self._poses_at.shape, np.nan)
        self._things: dict[str, ThingState] = {}

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
            things[name] = ThingState(
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
