"""What mapping writes, and how it goes on from that; the course of an exploration."""

import json
from itertools import count
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("gtsam", reason="the extra mapping is not installed")
pytest.importorskip("small_gicp", reason="the extra mapping is not installed")

from common import messages as m
from common.files.map_file import FREE, OCCUPIED
from common.household import load_household
from services.mapping.barriers import BEFORE, Met
from services.mapping.config import MappingConfig
from services.mapping.depth import Picture
from services.mapping.exploration import FIRST_LOOKS, Exploration
from services.mapping.mapper import Mapper, Shot
from services.mapping.save import SaveError, resume, save
from services.mapping.scan import Scan, scan_of
from services.mapping.views import Survey, View
from tests.map_server import read_map
from tests.unit.test_mapping_plan import ring
from tests.unit.test_mapping_surfaces import patch

EMPTY = np.empty((0, 3))


def room(door: bool) -> Scan:
    """A scan from the middle of a room of 4 by 4 m, whose east wall has a door of 1 m: open, or shut."""
    angles = np.radians(np.arange(0, 360, 0.5))
    reach = 2.0 / np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles)))
    ends = np.stack([np.cos(angles), np.sin(angles)], 1) * reach[:, None]
    through = (ends[:, 0] > 1.99) & (np.abs(ends[:, 1]) < 0.5) & door
    return Scan(0.0, ends[~through], ends[through] * 2, (0.0, 0.0))


def mapper(door: bool = False) -> Mapper:
    """That room with a table of 0.7 m height in its north-east."""
    made = Mapper((-6.0, -6.0), (6.0, 6.0))
    for k in range(3):
        made.add_scan(room(door), (0.001 * k, 0.0, 0.0))
    axis = np.arange(-1.94, 1.96, 0.025)
    floor = np.stack(np.meshgrid(axis, axis), -1).reshape(-1, 2)
    floor = floor[~((floor[:, 0] > 0.5) & (floor[:, 1] > 0.98))]
    top = patch(1.1, 1.3, 1.0, 0.6, 0.0, 0.7)
    made.shots = [Shot(0, (0.0, 0.0, 0.0), Picture(floor, top, top, EMPTY), True) for _ in range(3)]
    made.draw()
    return made


def test_the_files_tell_the_room(tmp_path: Path) -> None:
    assert save(tmp_path, "my home", mapper()).surfaces == 1
    told = load_household(str(tmp_path / "household.toml"))
    (table,) = told.receptacles
    assert (table.name, table.kind, told.delivery) == ("table", "table", "table")
    assert abs(table.center[2] - 0.7) < 0.003 and len(table.approach) >= 2
    assert sorted(round(v, 1) for v in table.size) == [0.6, 1.0]
    assert len(told.walls) == 4 and not told.fault()
    for wall in told.walls:
        assert min(abs(abs(v) - 2.0) for v in (*wall.start, *wall.end)) < 0.1
    grid = read_map(tmp_path / "map.yaml")
    column, row = (int((v - o) / grid.resolution) for v, o in zip((-1.0, -1.0), grid.origin, strict=True))
    assert grid.cells[row, column] == FREE
    column, row = (int((v - o) / grid.resolution) for v, o in zip((1.1, 1.3), grid.origin, strict=True))
    assert grid.cells[row, column] == OCCUPIED
    graph = json.loads((tmp_path / "pose_graph.json").read_text())
    assert len(graph["nodes"]) == 3 and {e["kind"] for e in graph["edges"]} >= {"odometry", "scan"}
    (row,) = json.loads((tmp_path / "surfaces.json").read_text())
    assert row["reached_from"]


def test_a_bin_that_was_only_seen_in_passing_is_one_all_the_same(tmp_path: Path) -> None:
    made, rim = mapper(), ring(-1.2, -1.2, 0.34, 0.40)
    seen = made.shots[0].picture
    floor = seen.floor[np.abs(seen.floor + 1.2).max(axis=1) > 0.25]
    standing, driving = Picture(floor, seen.above, seen.level, EMPTY), Picture(floor, rim, EMPTY, rim)
    made.shots = [Shot(0, (0.0, 0.0, 0.0), one, one is standing) for one in (standing, driving) for _ in range(3)]
    made.draw()
    save(tmp_path, "my home", made)
    found = [r for r in load_household(str(tmp_path / "household.toml")).receptacles if r.depth]
    assert [(round(r.center[0], 1), round(r.center[1], 1), round(r.depth, 1)) for r in found] == [(-1.2, -1.2, 0.4)]


@pytest.mark.slow
def test_it_goes_on_and_a_door_that_was_shut_is_open(tmp_path: Path) -> None:
    save(tmp_path, "home", mapper(door=False))
    second = Mapper((-6.0, -6.0), (6.0, 6.0))
    resume(tmp_path, second)
    assert len(second.trajectory) == 3 and len(second.shots) == 3
    shut = second.grid.at(np.array([[2.0, 0.0]]), second.grid.walls)
    assert shut.all()
    for k in range(20):
        second.add_scan(room(True), (0.0, 0.0, 0.0) if not k else (0.001 * k, 0.0, 0.0))
    assert not second.grid.at(np.array([[2.0, 0.0]]), second.grid.walls).any()
    save(tmp_path, "home", second)
    told = load_household(str(tmp_path / "household.toml"))
    assert min(w.footprint.distance(2.0, 0.0) for w in told.walls) > 0.3, "no wall closes the door any more"
    third = Mapper((-6.0, -6.0), (6.0, 6.0))
    resume(tmp_path, third)
    assert third.trajectory.runs == [0, 3, 23]
    assert not third.grid.at(np.array([[2.0, 0.0]]), third.grid.walls).any()


def test_a_pane_of_glass_is_in_the_household_and_stays_when_it_goes_on(tmp_path: Path) -> None:
    first = mapper(door=True)
    for y in (-0.2, 0.1, 0.2):
        first.meet(Met((2.0 - BEFORE, y), (2.0, y)))
    save(tmp_path, "home", first)
    second = Mapper((-6.0, -6.0), (6.0, 6.0))
    resume(tmp_path, second)
    save(tmp_path, "home", second)
    (pane,) = [w for w in load_household(str(tmp_path / "household.toml")).walls if w.glass]
    assert sorted((pane.start[1], pane.end[1])) == pytest.approx([-0.5, 0.5], abs=0.1)
    assert pane.start[0] == pytest.approx(2.0, abs=0.01)


@pytest.mark.parametrize("missing", ["pose_graph.json", "keyframes.npz"])
def test_without_its_files_it_does_not_go_on(tmp_path: Path, missing: str) -> None:
    save(tmp_path, "home", mapper())
    (tmp_path / missing).unlink()
    with pytest.raises(SaveError, match="no map to go on with"):
        resume(tmp_path, Mapper((-6.0, -6.0), (6.0, 6.0)))


def test_a_directory_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(SaveError, match="file"):
        save(tmp_path / "file" / "map", "home", mapper())


def test_a_scan_without_the_robots_own_body() -> None:
    ranges = np.full(360, 3.0, "<f4")
    ranges[:10], ranges[20:30] = 0.1, 11.0
    scan = scan_of(m.LaserScan(t=1.0, ranges=ranges.tobytes()))
    assert len(scan.points) == 340 and len(scan.passed) == 10
    for bad in (b"", b"\0" * 5, np.full(8, np.nan, "<f4").tobytes()):
        with pytest.raises(ValueError, match=r"ranges|lidar"):
            scan_of(m.LaserScan(t=1.0, ranges=bad))


class Course:
    """An exploration whose views are reached, or not, at once."""

    def __init__(self, surveys: list[Survey]) -> None:
        numbers = count()
        self.course = Exploration(MappingConfig(), lambda name: f"{name}-{next(numbers)}")
        self.surveys, self.goals, self.barred = list(surveys), [], []
        self.status = "arrived"

    def run(self, seconds: float = 200.0) -> None:
        now, pose = 0.0, (0.0, 0.0, 0.0)
        while now < seconds and self.course.phase != "saving":
            now += 0.05
            wanted = self.course.step(pose, now, busy=False)
            if wanted == "picture":
                self.course.pictures += 1
            elif wanted == "survey":
                self.barred.append([*self.course.barred])
                self.course.take_survey(self.surveys.pop(0) if self.surveys else Survey(0, 1.0, None))
            elif isinstance(wanted, m.NavGoal):
                self.goals.append(wanted)
                status = "arrived" if (wanted.x, wanted.y) == pose[:2] else self.status
                pose = (wanted.x, wanted.y, wanted.theta) if status == "arrived" else pose
                feedback = m.NavigationFeedback(goal_id=wanted.id, status=status)  # type: ignore[arg-type]
                self.course.take_feedback(feedback, now)


def test_it_looks_around_follows_the_surveys_and_drives_home() -> None:
    views = [View((1.0, 0.0, 0.5), 10.0), View((2.0, 1.0, 0.0), 5.0)]
    course = Course([Survey(2, 4.0, views[0]), Survey(1, 8.0, views[1])])
    course.run()
    assert course.course.phase == "saving"
    driven = [(g.x, g.y, g.theta) for g in course.goals]
    assert len(driven) == FIRST_LOOKS - 1 + 3
    assert driven[-3:] == [views[0].pose, views[1].pose, (0.0, 0.0, 0.0)]


def test_a_view_that_is_not_reached_is_barred() -> None:
    course = Course([Survey(1, 4.0, View((1.0, 0.0, 0.5), 10.0))])
    course.status = "failed"
    course.run(60.0)
    view = course.goals[FIRST_LOOKS - 1]
    assert (view.x, view.y) == (1.0, 0.0) and course.barred[:2] == [[], [(1.0, 0.0)]]


def test_a_blocked_view_is_tried_once_more_at_the_most() -> None:
    """Exploring has to end."""
    numbers = count()
    course = Exploration(MappingConfig(), lambda name: f"{name}-{next(numbers)}")
    beyond = Survey(1, 4.0, View((2.0, 0.0, 0.0), 10.0))
    now, goals = 0.0, 0
    while now < 600.0 and course.phase == "exploring":
        now += 0.05
        wanted = course.step((1.0, 0.0, 0.0), now, busy=False)
        if wanted == "survey":
            course.take_survey(Survey(0, 4.0, None) if course.barred else beyond)
        elif isinstance(wanted, m.NavGoal):
            looks = (wanted.x, wanted.y) == (1.0, 0.0)
            goals += not looks
            status, code = ("arrived", "") if looks else ("failed", "BLOCKED")
            course.take_feedback(m.NavigationFeedback(goal_id=wanted.id, status=status, code=code), now)  # type: ignore[arg-type]
    assert course.phase == "returning" and goals == 2


def test_told_to_finish_it_drives_home_at_once() -> None:
    course = Course([Survey(9, 4.0, View((1.0, 0.0, 0.5), 10.0))] * 50)
    course.course.finish()
    course.run(20.0)
    assert course.course.phase == "saving" and len(course.goals) <= 1
