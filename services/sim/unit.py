"""One robot of the simulation: its drivers, sensors and battery, connected to its bus."""

import math
from typing import Any

import mujoco
import numpy as np

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Array, Pose2
from common.messages import CameraMount
from common.time.lockstep import DT
from services.sim.battery import Battery
from services.sim.config import SimConfig
from services.sim.drivers import Drivers
from services.sim.physics import Physics
from services.sim.sensors import Sensors

BASE = "base"
SCAN_TICKS, STATE_TICKS, BATTERY_TICKS = 10, 5, 100
"""Periods [ticks of 10 ms] of lidar, `sim/state` and battery."""


class Unit:
    """Robot `number` of the world, 0 being the simulation's own; `epoch` is that of the simulation."""

    def __init__(self, config: SimConfig, io: Io, physics: Physics, number: int, epoch: str) -> None:
        self._config, self._physics, self._number, self._epoch = config, physics, number, epoch
        self.io, self.body = io, physics.robots[number]
        self.world = ""

    def begin(self, pose: Pose2, world: str) -> None:
        """Create drivers and sensors for a world just laid out, the robot at `pose` [map], and publish the model."""
        config, io, physics, self.world = self._config, self.io, self._physics, world
        self.drivers = Drivers(config, io, self.body, pose, self.publish_status)
        self.sensors = Sensors(self.body, physics.seed + self._number, config, io, pose)
        self.battery = Battery(config.battery)
        self._reached: tuple[bool, str] = (False, "")
        description = m.RobotDescription(mjcf=self.body.robot.mjcf, head_camera=head_camera(self.body.names))
        io.publish(topics.ROBOT_DESCRIPTION, description)
        mjcf = physics.mjcfs[self._number]
        model = m.SimModel(scene=io.world.name, seed=physics.seed, epoch=self._epoch, mjcf=mjcf, files=physics.files)
        io.publish(topics.SIM_MODEL, model)
        io.publish(topics.GOAL_REACHED, m.GoalReached(reached=False))
        self.publish_status("running")

    def publish_status(self, state: Any, detail: str = "") -> None:
        """Publish the simulation's status."""
        status = m.SimStatus(
            state=state,
            speed=self._config.speed,
            epoch=self._epoch,
            scene=self.io.world.name,
            seed=self._physics.seed,
            world=self.world,
            detail=detail,
        )
        self.io.publish(topics.SIM_STATUS, status)

    def take_commands(self, now: float) -> tuple[Array, Array]:
        """Take commands; returns the set-points (10,) at the beginning and at the end of this tick."""
        if self.io.fresh:
            self.drivers.take_commands(now)
        return self.drivers.advance(self.sensors.odometry.believed, now)

    def publish(self, tick: int, t: float) -> None:
        """Publish the robot's measurements and the state of the world after the tick that ends at `t` [s]."""
        io, body, data = self.io, self.body, self._physics.data
        self.sensors.publish_state(t)
        base = self.drivers.base
        reached = (base.reached(self.sensors.odometry.believed), base.target_id)
        if reached != self._reached:
            self._reached = reached
            io.publish(topics.GOAL_REACHED, m.GoalReached(reached=reached[0], target_id=reached[1]))
        if tick % SCAN_TICKS == 0:
            self.sensors.publish_scan(t)
        if tick % BATTERY_TICKS == 0:
            vx, vy, omega, *_ = body.rates.tolist()
            self.battery.draw(vx, vy, omega, BATTERY_TICKS * DT)
            io.publish(topics.BATTERY, m.BatteryState(t=t, charge=self.battery.charge, power=self.battery.power))
        if tick % STATE_TICKS == 0:
            state = m.SimState(
                t=t, tick=tick, epoch=self._epoch, qpos=data.qpos.tobytes(), mocap=data.mocap_pos.tobytes()
            )
            io.publish(topics.SIM_STATE, state)
            if touches := body.contacts.take():
                io.publish(topics.SIM_CONTACTS, m.SimContacts(t=t, epoch=self._epoch, touches=touches))


# --- where the robot's cameras sit, for its description
def head_camera(model: Any) -> CameraMount | None:
    """The mount of camera `head`, read from a compiled model; None when the base carries no such camera."""
    number = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_CAMERA, "head")
    if number < 0 or model.body(int(model.cam_bodyid[number])).name != BASE:
        return None
    turn = np.empty(9)
    mujoco.mju_quat2Mat(turn, model.cam_quat[number])
    # A camera of MuJoCo looks along its own -z.
    forward, left, up = (float(v) for v in -turn.reshape(3, 3)[:, 2])
    x, y, z = (float(v) for v in model.cam_pos[number])
    return CameraMount(
        x=x,
        y=y,
        z=z,
        yaw=math.atan2(left, forward),
        pitch=-math.asin(max(-1.0, min(1.0, up))),
        fovy=math.radians(float(model.cam_fovy[number])),
    )
