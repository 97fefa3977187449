"""A simulation that was killed goes on with the same world."""

from pathlib import Path

import numpy as np
import pytest

from common import messages as m
from common import topics
from common.bus import codec
from common.scene import load_scene
from common.time.lockstep import DT
from services.sim import checkpoint
from tests.simulation import Simulation

SCENE = load_scene("minimal")


class Sim(Simulation):
    """A simulation process."""

    def __init__(self, directory: Path, run: str = "a") -> None:
        super().__init__(SCENE, seed=1, state_dir=directory, run=run)

    @property
    def world(self) -> np.ndarray:  # type: ignore[type-arg]
        return np.array(self.service.physics.data.qpos)


def driven(directory: Path) -> Sim:
    sim = Sim(directory)
    sim.bus.send(topics.BASE_TARGET, m.BaseTarget(x=0.2, y=0.1, theta=0.3, id="t"))
    sim.bus.send(topics.GRIPPER_COMMAND, m.GripperCommand(position=1.0, max_effort=20.0))
    sim.step(1.49)
    return sim


def test_it_goes_on_at_most_half_a_second_back_at_rest(tmp_path: Path) -> None:
    first = driven(tmp_path)
    second = Sim(tmp_path)
    assert 0 <= first.tick - second.tick <= 50
    assert second.service.start_time == (second.tick + 1) * DT
    before = second.world
    assert abs(before[0]) > 0.02
    second.step(1.0)
    # Nobody has commanded it since: base and arm hold, the fingers stay shut.
    assert np.abs(second.world[:10] - before[:10]).max() < 0.01
    assert second.service.physics.width() < 0.003


def test_the_world_keeps_its_name_and_odometry_and_the_process_does_not(tmp_path: Path) -> None:
    first, second = driven(tmp_path), Sim(tmp_path)
    old, new = (s.io.epoch for s in (first, second))
    assert old != new
    statuses = [codec.decode(topics.SIM_STATUS, s.bus.last[topics.SIM_STATUS.key]) for s in (first, second)]
    assert statuses[0].world == statuses[1].world
    sensors = second.service.sensors
    believed = sensors.odometry.believed
    sensors.publish_state(0.0)
    assert np.allclose(believed, sensors.odometry.believed)


def test_a_stop_outlives_the_process(tmp_path: Path) -> None:
    first = driven(tmp_path)
    first.bus.send(topics.ROBOT_STOP, m.RobotStop(reason="test"))
    first.step(0.6)
    second = Sim(tmp_path)
    second.bus.send(topics.BASE_TARGET, m.BaseTarget(x=1.0, y=0.0, theta=0.0, id="u"))
    before = second.world[:3]
    second.step(0.5)
    assert np.abs(second.world[:3] - before).max() < 0.01


@pytest.mark.parametrize("torn", [b"", b"\x00garbage", None])
def test_without_a_whole_file_of_this_run_it_begins_anew(torn: bytes | None, tmp_path: Path) -> None:
    driven(tmp_path)
    path = tmp_path / checkpoint.NAME
    if torn is not None:
        path.write_bytes(torn or path.read_bytes()[:100])
    second = Sim(tmp_path, run="a" if torn is not None else "b")
    assert second.service.start_time == 0
    assert abs(second.world[0]) < 0.01


def test_a_full_disk_is_logged_and_the_world_goes_on(tmp_path: Path) -> None:
    sim = Sim(tmp_path / "missing")
    sim.step(1.2)
    assert sim.tick + 1 == 120
