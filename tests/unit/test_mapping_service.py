"""The mapping service on a memory bus: what it publishes and asks for, and that nonsense harms nothing."""

from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

pytest.importorskip("gtsam", reason="the extra mapping is not installed")
pytest.importorskip("small_gicp", reason="the extra mapping is not installed")

from common import messages as m
from common import topics
from common.household import load_household
from common.runtime import StartError
from services.mapping.config import MappingConfig
from services.mapping.service import MappingService
from tests.node import Node
from tests.unit.mapping_flat import BOXES
from tests.unit.navigation_flat import cast
from tests.unit.test_mapping_surfaces import image

RANGES = cast((0.0, 0.0, 0.0), BOXES).astype("<f4").tobytes()


class Still(Node):
    """A robot that stands in the shipped flat; `camera` False: nobody takes pictures."""

    def __init__(self, camera: bool = True, **parameters: object) -> None:
        config: Any = MappingConfig(**parameters)  # type: ignore[arg-type]
        super().__init__(MappingService, config, load_household("unmapped"))
        self.camera = camera
        self.requests = self.bus.tap(topics.CAMERA_REQUEST)
        self.goals = self.bus.tap(topics.NAV_GOAL)

    def feed(self) -> None:
        self.bus.send(topics.ODOMETRY, m.Odometry(t=self.now, x=0.0, y=0.0, theta=0.0))
        self.bus.send(topics.SCAN, m.LaserScan(t=self.now, ranges=RANGES))
        if self.camera and self.requests:
            picture = image()
            picture.id, picture.t = msgspec.json.decode(self.requests[-1])["id"], self.now
            self.requests.clear()
            self.bus.send(topics.HEAD_RGBD, picture)


def test_it_publishes_a_map_takes_pictures_and_turns(tmp_path: Path) -> None:
    robot = Still(out=str(tmp_path))
    robot.step(5.0)
    grid = robot.last(topics.MAP_GRID)
    assert grid.odom == (0.0, 0.0, 0.0) and grid.width * grid.resolution > 3.0
    assert robot.goals, "the first look around has begun"
    assert robot.last(topics.MAPPING_STATUS).phase == "exploring"


def test_without_a_camera_it_goes_on_after_a_while(tmp_path: Path) -> None:
    robot = Still(camera=False, out=str(tmp_path))
    robot.step(5.0)
    assert robot.requests and robot.goals


def test_saved_on_demand(tmp_path: Path) -> None:
    robot = Still(out=str(tmp_path / "home"))
    robot.step(1.0)
    robot.bus.send(topics.MAPPING_GOAL, m.MappingGoal(goal="save", id="1"))
    robot.step(3.0)
    status = robot.last(topics.MAPPING_STATUS)
    assert status.saves == 1 and status.saved == str(tmp_path / "home")
    assert load_household(str(tmp_path / "home" / "household.toml")).walls


def test_where_nothing_can_be_written_it_says_so(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    robot = Still(out=str(tmp_path / "file" / "home"))
    robot.step(1.0)
    robot.bus.send(topics.MAPPING_GOAL, m.MappingGoal(goal="save", id="1"))
    robot.step(3.0)
    status = robot.last(topics.MAPPING_STATUS)
    assert status.phase == "failed" and "file" in status.detail


def test_nothing_to_go_on_with_ends_the_start(tmp_path: Path) -> None:
    with pytest.raises(StartError, match=r"mapping\.resume"):
        Still(resume=str(tmp_path))


def test_nonsense_is_dropped(tmp_path: Path) -> None:
    robot = Still(camera=False, out=str(tmp_path))
    for field, value in (("depth", b"12"), ("fx", 0.0), ("fx", float("nan")), ("position", (float("inf"), 0.0, 0.0))):
        robot.requests.clear()
        robot.step(3.0)
        bad = image()
        setattr(bad, field, value)
        bad.id, bad.t = msgspec.json.decode(robot.requests[-1])["id"], robot.now
        robot.bus.send(topics.HEAD_RGBD, bad)
        robot.step(0.3)
    assert robot.io.drops[topics.HEAD_RGBD.key]
    for t in (float("nan"), float("inf"), -5.0):
        robot.bus.send(topics.ODOMETRY, m.Odometry(t=t, x=float("nan"), y=1e30, theta=0.0))
        robot.bus.send(topics.SCAN, m.LaserScan(t=t, ranges=np.full(3, np.nan, "<f4").tobytes()))
        robot.step()
    robot.bus.send(topics.MAPPING_GOAL, m.MappingGoal(goal="fly", id="2"))
    robot.step(3.0)
    assert robot.last(topics.MAPPING_STATUS).phase == "exploring"
