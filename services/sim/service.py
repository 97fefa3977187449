"""The simulation: owns MuJoCo and robot time, plays the robot's drivers and sensors."""

import math
import os
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
import mujoco
import numpy as np

from common import topics
from common.bus.port import Io
from common.config import ConfigError
from common.geometry import Pose2
from common.runtime import StartError
from common.time.lockstep import DT
from services.sim import checkpoint, truth
from services.sim.battery import Battery
from services.sim.config import SimConfig
from services.sim.drivers import Drivers
from services.sim.menagerie import RobotError
from services.sim.model import Robot, load_robot
from services.sim.objects import made
from services.sim.obstacles import chosen
from services.sim.physics import Physics
from services.sim.sensors import Sensors
from services.sim.unit import Unit

CHECKPOINT_TICKS = 50
"""Ticks [10 ms] between two saves of the world: a restart loses half a second."""


class Pause(msgspec.Struct):
    paused: bool


class Reset(msgspec.Struct):
    seed: int | None = None


class SimService:
    """The simulation as a service: steps the world and its robots, saves checkpoints, answers queries."""

    NAME = "sim"
    HZ = 100
    CONFIG = SimConfig
    KNOWS_WORLD = True
    READS, WRITES = topics.subscribed(NAME), topics.published(NAME)

    def __init__(self, config: SimConfig, io: Io) -> None:
        self._config, self._io = config, io
        self._speed = _speed(config.speed)
        self.paused = False
        self.start_time = 0.0
        guests = [(guest.name, guest.pose) for guest in config.guests]
        self.physics = Physics(io.world, io.seed, chosen(io.world, config.obstacles), _robot(config.robot), guests)
        for warning in filter(None, (made(p.spec).warning for p in self.physics.placements)):
            io.log.warning("object", what=warning)
        self._viewer = Viewer(self.physics) if config.viewer else None
        self._tick = 0
        self._model = checkpoint.fingerprint(self.physics.mjcf)
        self._saved = io.state_dir / checkpoint.NAME if io.state_dir and config.run and not guests else None
        self._unsaved = ""
        ios = [io, *(io.beside(name) for name, _ in guests)]
        self._units = [Unit(config, one, self.physics, n, io.epoch) for n, one in enumerate(ios)]
        self._begin()
        if self._saved is not None and (state := checkpoint.load(self._saved, config.run, self._model)):
            self._resume(state)
        for unit in self._units:
            unit.io.serve(topics.SIM_TRUTH, partial(self._answer_truth, unit))
            unit.io.serve(topics.SIM_RESET, self._answer_reset)
            unit.io.serve(topics.SIM_PAUSE, self._answer_pause)
            unit.io.serve(topics.SIM_SNAPSHOT, self._answer_snapshot)

    @property
    def drivers(self) -> Drivers:
        """Those of the simulation's own robot."""
        return self._units[0].drivers

    @property
    def sensors(self) -> Sensors:
        """Those of the simulation's own robot."""
        return self._units[0].sensors

    def pace(self) -> tuple[float | None, tuple[str, ...]]:
        """Speed as a factor of real time (None: as fast as possible) and the participants to wait for."""
        return self._speed, self._config.wait_for

    def _begin(self) -> None:
        """Begin with a world that has just been laid out."""
        home, world = self._io.world.home, self._io.new_id(self._io.epoch)
        poses = [(home.x, home.y, home.theta), *(guest.pose for guest in self._config.guests)]
        for unit, pose in zip(self._units, poses, strict=True):
            unit.begin(pose, world)

    def _resume(self, state: checkpoint.Checkpoint) -> None:
        """Go on with a world that another process of this simulation has left: at rest, nothing commanded."""
        physics = self.physics
        physics.restore(np.frombuffer(state.physics))
        own = self._units[0]
        self._tick, own.world, physics.seed = state.tick, state.world, state.seed
        self.start_time = state.tick * DT
        self.drivers.resume(state)
        self.sensors.odometry.resume(self.drivers.base.pose, state.odometry)
        physics.contacts.restore(state.touches)
        own.battery = Battery(state.charge)
        self._io.log.warning("the world goes on where it was", t=round(self.start_time, 2))
        own.publish_status("stopped" if state.stopped else "running", "resumed")

    def _save(self) -> None:
        """Save the world, twice a second."""
        if self._saved is None or self._tick % CHECKPOINT_TICKS:
            return
        state = checkpoint.Checkpoint(
            run=self._config.run,
            model=self._model,
            seed=self.physics.seed,
            tick=self._tick,
            world=self._units[0].world,
            physics=self.physics.snapshot().tobytes(),
            setpoint=self.drivers.setpoint.tolist(),
            odometry=self.sensors.odometry.believed,
            effort=self.drivers.effort,
            stopped=self.drivers.base.stopped,
            touches=self.physics.contacts.touches,
            charge=self._units[0].battery.charge,
        )
        why = checkpoint.save(self._saved, state)
        if why and why != self._unsaved:
            self._io.log.error("the world could not be saved; a restart would begin anew", reason=why)
        self._unsaved = why

    # --- one tick
    def step(self, now: float) -> None:
        (before, after), *guests = [unit.take_commands(now) for unit in self._units]
        physics = self.physics
        x, y, *_ = physics.joints.tolist()
        physics.obstacles.advance(physics.data, (x, y), DT)
        physics.advance(before, after, now, guests)
        self._tick += 1
        for unit in self._units:
            unit.publish(self._tick, now + DT)
        self._save()
        if self._viewer:
            self._viewer.sync()

    def carry(self, pose: Pose2) -> None:
        """Move the robot to `pose` [map], at rest, as if carried: odometry does not change."""
        physics, believed = self.physics, self.sensors.odometry.believed
        physics.data.qpos[physics.qpos_at[:3]] = pose
        physics.data.qvel[physics.qvel_at[:3]] = 0.0
        mujoco.mj_forward(physics.model, physics.data)
        self.drivers.put(pose, stopped=self.drivers.base.stopped)
        self.sensors.odometry.resume(pose, believed)

    # --- queries
    def _answer_truth(self, unit: Unit, payload: bytes) -> bytes:
        now = self._tick * DT
        return msgspec.json.encode(truth.report(self.physics, now, self._io.epoch, unit.body))

    def _answer_pause(self, payload: bytes) -> bytes:
        self.paused = msgspec.json.decode(payload or b'{"paused": true}', type=Pause).paused
        for unit in self._units:
            unit.publish_status("paused" if self.paused else "running")
        return msgspec.json.encode({"paused": self.paused})

    def _answer_reset(self, payload: bytes) -> bytes:
        wanted = msgspec.json.decode(payload or b"{}", type=Reset)
        self.physics.reseed(self.physics.seed if wanted.seed is None else wanted.seed)
        self._begin()
        return msgspec.json.encode({"seed": self.physics.seed, "scene": self._io.world.name})

    def _answer_snapshot(self, payload: bytes) -> bytes:
        state = self.physics.snapshot()
        directory = Path(self._config.snapshot_dir or "out")
        directory.mkdir(parents=True, exist_ok=True)
        path = directory / f"snapshot-{self.physics.seed}-{self._tick}.npy"
        np.save(path, state)
        return msgspec.json.encode({"path": str(path), "t": self._tick * DT, "bytes": path.stat().st_size})

    def close(self) -> None:
        if self._viewer:
            self._viewer.close()


def _robot(name: str) -> Robot:
    try:
        return load_robot(name)
    except RobotError as error:
        raise ConfigError(f"sim.robot: {error}") from None


def _speed(text: str) -> float | None:
    if text in ("realtime", "max"):
        return 1.0 if text == "realtime" else None
    try:
        factor = float(text)
    except ValueError:
        factor = -1.0
    if not 0 < factor < math.inf:
        raise StartError(f"sim.speed = {text!r}: expected realtime, max or a factor such as 4")
    return factor


# --- an optional window on the simulation
class Viewer:
    """MuJoCo's passive viewer; needs a display."""

    def __init__(self, physics: Physics) -> None:
        if not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
            raise StartError("sim.viewer needs a display (DISPLAY is not set); run without --viewer")
        import mujoco.viewer

        self._window: Any = mujoco.viewer.launch_passive(physics.model, physics.data)

    def sync(self) -> None:
        if self._window.is_running():
            self._window.sync()

    def close(self) -> None:
        self._window.close()
