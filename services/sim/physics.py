"""The MuJoCo world of a scene: model, state, actuation. Names are resolved once."""

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from common.robot import ARM, BASE, arm_limits, pads, subtree
from common.scene import Obstacle, Scene, body_name
from common.time.lockstep import DT
from services.sim.contacts import Contacts
from services.sim.fingers import Fingers, view
from services.sim.layout import Placement, place_objects
from services.sim.model import Robot, own
from services.sim.obstacles import Obstacles, body_xml
from services.sim.world import world_files, world_mjcf

FINE, COARSE = 5, 2
"""Steps of a tick. 2 ms is half the time constant of the pads' contacts, the longest that MuJoCo takes for them; while
the base drives or stands, touches nothing, and every object sleeps, 5 ms do: the loops of the linkage give way a little
more then, with nothing between the pads."""
AT_REST = 1e-3
"""Slower than this the pads stand still [m/s]."""
SETTLE_TICKS = 50
_STATE = mujoco.mjtState.mjSTATE_INTEGRATION


class Physics:
    """One world; `advance` runs 10 ms of it, at 500 Hz or, while nothing but the base moves, at 200 Hz."""

    def __init__(
        self, scene: Scene, seed: int, obstacles: tuple[Obstacle, ...] = (), robot: Robot | None = None
    ) -> None:
        self.scene, self.seed, self.robot = scene, seed, robot or own()
        self.placements: list[Placement] = place_objects(scene, seed)
        self.mjcf = world_mjcf(scene, self.placements, "".join(map(body_xml, obstacles)), self.robot)
        self.files = world_files(scene, self.placements)
        self.model: Any = mujoco.MjModel.from_xml_string(self.mjcf, self.files)
        self.model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_SLEEP
        self.data: Any = mujoco.MjData(self.model)
        model = self.model
        joints = (*BASE, *ARM)
        self.qpos_at = np.array([model.joint(j).qposadr[0] for j in joints])
        self.qvel_at = np.array([model.joint(j).dofadr[0] for j in joints])
        self.ctrl_at = np.array([model.actuator(j).id for j in joints])
        self.gripper_ctrl = model.actuator("gripper").id
        # Live views: looking an array up on MjData and indexing it by a list cost more than a physics step.
        self.joints = view(self.data.qpos, self.qpos_at)
        self.rates = view(self.data.qvel, self.qvel_at)
        self.forces = view(self.data.actuator_force, np.append(self.ctrl_at, self.gripper_ctrl))
        self._ctrl = view(self.data.ctrl, self.ctrl_at)
        self._lead = servo_lead(model, self.ctrl_at, self.qvel_at) / DT
        self._grip_limit = 0.99 * float(model.actuator_forcerange[self.ctrl_at[0], 1])
        self.lidar_site = model.site("lidar").id
        self.pads = pads(model)
        self.fingers = Fingers(model, self.data)
        self.home_arm = self.robot.home
        self.arm_limits = arm_limits(model)
        self.bodies = {p.spec.name: model.body(body_name(p.spec)).id for p in self.placements}
        self.gripper_bodies = subtree(model, "gripper")
        self.robot_bodies = {b for b in range(model.nbody) if model.body_rootid[b] == model.body("base").id}
        self.contacts = Contacts(self.model, self.robot_bodies, self.pads, self.bodies)
        self.obstacles = Obstacles(obstacles, self.model, [w.footprint for w in scene.walls] + scene.footprints)
        self._steps = FINE
        self.reset()

    def reset(self) -> None:
        """The layout of the seed, the robot at home, everything at rest."""
        mujoco.mj_resetData(self.model, self.data)
        self._steps, self.model.opt.timestep = FINE, DT / FINE
        home = (self.scene.home.x, self.scene.home.y, self.scene.home.theta, *self.home_arm)
        self.data.qpos[self.qpos_at] = home
        self.data.ctrl[self.ctrl_at] = home
        for p in self.placements:
            at = self.model.joint(body_name(p.spec)).qposadr[0]
            self.data.qpos[at : at + 3] = p.position
            self.data.qpos[at + 3 : at + 7] = p.quat
        mujoco.mj_step(self.model, self.data, SETTLE_TICKS * FINE)
        self.fingers.hold()
        self.contacts.forget()
        self.obstacles.reset()

    def reseed(self, seed: int) -> None:
        """Another layout in the same world."""
        self.seed, self.placements = seed, place_objects(self.scene, seed)
        self.reset()

    def advance(self, start: NDArray[np.float64], end: NDArray[np.float64], now: float = 0.0) -> None:
        """Run the 10 ms from `now` [s] while the set-points (10,) of base and arm move from `start` to `end`."""
        model, data, ctrl, contacts = self.model, self.data, self._ctrl, self.contacts
        change = end - start
        self.fingers.advance()
        steps = COARSE if self._alone(change) else FINE
        if steps != self._steps:
            self._steps, model.opt.timestep = steps, DT / steps
        ctrl[:] = start + self._lead * change
        moving = bool(change.any())
        change /= steps
        for number in range(1, steps + 1):
            if moving:
                ctrl += change
            mujoco.mj_step(model, data)
            if data.ncon:
                contacts.step(data, now + number * DT / steps)

    def _alone(self, change: NDArray[np.float64]) -> bool:
        """True while the robot touches nothing, nothing but it is awake, and arm and fingers rest."""
        data = self.data
        if data.ntree_awake > 1 or data.ncon:
            return False
        return not change[3:].any() and abs(self.fingers.rate()) < AT_REST

    def grip(self, closed: float, effort: float) -> None:
        """Drive the fingers to `closed` (0..1) with at most `effort` newtons each."""
        self.fingers.close(closed)
        self.limit_effort(effort)

    def limit_effort(self, effort: float) -> None:
        """The most that each finger presses [N]; not part of MuJoCo's state."""
        most = effort * self.fingers.per_newton
        self.model.actuator_forcerange[self.gripper_ctrl] = (-most, most)

    def sliding(self) -> bool:
        """True while the base's wheels push or brake with all that their tyres hold."""
        fx, fy, *_ = self.forces.tolist()
        return bool(max(abs(fx), abs(fy)) >= self._grip_limit)

    def width(self) -> float:
        """Distance between the pads [m]."""
        return self.fingers.width()

    def width_rate(self) -> float:
        """How fast the pads move apart [m/s]."""
        return self.fingers.rate()

    def finger_force(self) -> float:
        """Closing force of one finger [N]."""
        return float(self.forces[-1] / self.fingers.per_newton)

    def snapshot(self) -> NDArray[np.float64]:
        """The full integration state."""
        state = np.empty(mujoco.mj_stateSize(self.model, _STATE))
        mujoco.mj_getState(self.model, self.data, state, _STATE)
        return state

    def restore(self, state: NDArray[np.float64]) -> None:
        """Back to a snapshot of the same model."""
        mujoco.mj_setState(self.model, self.data, state, _STATE)
        self.fingers.hold()
        mujoco.mj_forward(self.model, self.data)


def servo_lead(model: Any, actuators: NDArray[np.int64], dofs: NDArray[np.int64]) -> NDArray[np.float64]:
    """Seconds (n,) by which a position servo trails a set-point that moves evenly: (kv + damping) / kp.

    A set-point that leads by as much, as the arm's own controller does by feeding the velocity forward, leaves no
    error but that of inertia.
    """
    gain, rate_gain = model.actuator_gainprm[actuators, 0], -model.actuator_biasprm[actuators, 2]
    return np.asarray((rate_gain + model.dof_damping[dofs]) / gain)
