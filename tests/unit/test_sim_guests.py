"""Two robots in one world: each has its own drivers, sensors and names, and sees the other."""

import math

import mujoco
import numpy as np
import pytest

from common import messages as m
from common import topics
from common.bus import codec
from common.bus.memory import MemoryBus, MemoryIo
from common.household import told
from common.scene import load_scene
from common.time.lockstep import DT
from services.sim.config import Guest, SimConfig
from services.sim.service import SimService

SCENE = load_scene("minimal")
AT = (-0.8, 0.0, 0.0)


class World:
    """A simulation with one guest, on a bus for each robot."""

    def __init__(self) -> None:
        self.own, self.other = MemoryBus(), MemoryBus()
        self.own.neighbours = {"bert": self.other}
        io = MemoryIo(
            self.own, "sim", SimService.READS, SimService.WRITES, household=told(SCENE), world=SCENE, seed=3
        )  # fmt: skip
        self.sim = SimService(SimConfig(sensors="ideal", guests=(Guest("bert", *AT),)), io)
        self.io, self.tick = io, 0

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds / DT)):
            self.io.begin(self.tick, self.tick * DT)
            self.sim.step(self.tick * DT)
            self.tick += 1


@pytest.fixture(scope="module")
def driven() -> World:
    world = World()
    world.run(0.1)
    world.other.send(topics.BASE_TARGET, m.BaseTarget(x=AT[0] - 0.2, y=0.1, theta=0.0, id="t"))
    world.run(1.5)
    return world


def test_a_target_moves_the_robot_that_it_was_sent_to(driven: World) -> None:
    own, guest = (robot.joints[:2].tolist() for robot in driven.sim.physics.robots)
    assert own == pytest.approx([0.0, 0.0], abs=0.01)
    assert guest == pytest.approx([AT[0] - 0.2, 0.1], abs=0.04)
    odometry = [codec.decode(topics.ODOMETRY, bus.last[topics.ODOMETRY.key]) for bus in (driven.own, driven.other)]
    assert odometry[0].x == pytest.approx(0.0, abs=0.01)
    assert odometry[1].x == pytest.approx(AT[0] - 0.2, abs=0.05)


def test_each_sees_the_other_in_its_lidar(driven: World) -> None:
    scans = [codec.decode(topics.SCAN, bus.last[topics.SCAN.key]) for bus in (driven.own, driven.other)]
    ahead = [np.frombuffer(scan.ranges, np.float32) for scan in scans]
    apart = math.dist(*(robot.joints[:2] for robot in driven.sim.physics.robots))
    # From the own one the guest is behind, from the guest the own one is ahead.
    assert apart - 0.35 < ahead[0][np.r_[-12:12]].min() < apart - 0.15
    assert apart - 0.35 < ahead[1][168:192].min() < apart - 0.15


def test_to_each_the_world_is_described_with_its_own_names(driven: World) -> None:
    data = driven.sim.physics.data
    for bus, at in ((driven.own, 0), (driven.other, 1)):
        told_model = codec.decode(topics.SIM_MODEL, bus.last[topics.SIM_MODEL.key])
        model = mujoco.MjModel.from_xml_string(told_model.mjcf, told_model.files)
        assert model.nq == data.qpos.size
        place = data.qpos[model.joint("base_x").qposadr[0]]
        assert place == pytest.approx(driven.sim.physics.robots[at].joints[0])
        assert {"head", "wrist"} <= {model.camera(c).name for c in range(model.ncam)}


def test_a_stop_brakes_one_robot_alone() -> None:
    world = World()
    world.other.send(topics.ROBOT_STOP, m.RobotStop(reason="test"))
    world.run(0.1)
    states = [codec.decode(topics.SIM_STATUS, bus.last[topics.SIM_STATUS.key]) for bus in (world.own, world.other)]
    assert [s.state for s in states] == ["running", "stopped"]
    assert states[0].epoch == states[1].epoch


def test_they_touch_where_they_meet() -> None:
    world = World()
    world.run(0.1)
    for _ in range(40):
        world.other.send(topics.BASE_TARGET, m.BaseTarget(x=0.0, y=0.0, theta=0.0, id="t"))
        world.run(0.05)
    contacts = world.sim.physics.guests[0].contacts.touches
    assert any(touch.thing.startswith("host/") or "bumper" in touch.thing for touch in contacts), contacts
