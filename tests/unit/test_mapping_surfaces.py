"""Grid, frontiers, depth and surfaces of mapping on synthetic measurements."""

import math
import zlib

import numpy as np
import pytest

from common import messages as m
from common.approach import FOOTPRINT
from common.files.map_file import FREE, OCCUPIED, UNKNOWN
from common.geometry import matrix_quat
from common.robot.pictures import PictureError
from services.mapping.barriers import BEFORE, Met, glass, panes, shut
from services.mapping.depth import CameraModel
from services.mapping.grid import RESOLUTION, Grid
from services.mapping.mapper import Mapper
from services.mapping.scan import Scan
from services.mapping.surfaces import find_surfaces, fit_rectangle
from services.mapping.views import FLOOR_TRIES, SPACING, survey

PITCH, EYE = 0.62, (-0.17, 0.0, 1.30)


def patch(x: float, y: float, length: float, width: float, yaw: float, z: float, seed: int = 0) -> np.ndarray:
    """Points of a level surface, a couple in each square centimetre, with noise of 3 mm."""
    rng = np.random.default_rng(seed)
    count = int(length * width * 8000)
    u, v = rng.uniform(-0.5, 0.5, count) * length, rng.uniform(-0.5, 0.5, count) * width
    c, s = math.cos(yaw), math.sin(yaw)
    return np.column_stack([x + c * u - s * v, y + s * u + c * v, z + rng.normal(0, 0.003, count)])


def test_a_turned_table_has_its_height_and_outline() -> None:
    (found,) = find_surfaces(patch(2.0, 1.0, 1.2, 0.7, 0.5, 0.72))
    assert abs(found.height - 0.72) < 0.002
    r = found.outline
    assert math.dist((r.x, r.y), (2.0, 1.0)) < 0.01
    assert abs(r.length - 1.2) < 0.03 and abs(r.width - 0.7) < 0.03 and abs(r.yaw - 0.5) < 0.03


def test_two_tables_side_by_side_of_different_height_are_two() -> None:
    both = np.concatenate([patch(0, 0, 1.0, 0.6, 0, 0.50), patch(0.81, 0, 0.6, 0.6, 0, 0.72, 1)])
    heights = sorted(s.height for s in find_surfaces(both))
    assert len(heights) == 2 and abs(heights[0] - 0.5) < 0.005 and abs(heights[1] - 0.72) < 0.005


def test_a_tray_that_touches_a_sofa_a_little_lower_is_another_surface() -> None:
    both = np.concatenate([patch(0, 0, 0.8, 1.9, 0, 0.448), patch(-0.58, 0.3, 0.36, 0.5, 0, 0.460, 1)])
    sofa, tray = find_surfaces(both)
    assert abs(sofa.height - 0.448) < 0.002 and abs(tray.height - 0.460) < 0.002
    assert np.allclose(sorted(sofa.outline[2:4]), (0.8, 1.9), atol=0.03)
    assert np.allclose(sorted(tray.outline[2:4]), (0.36, 0.5), atol=0.05)


def test_what_stands_on_a_table_is_no_surface() -> None:
    cup = patch(0.2, 0.0, 0.08, 0.08, 0, 0.82, 2)
    found = find_surfaces(np.concatenate([patch(0, 0, 1.0, 0.6, 0, 0.72), cup]))
    assert [round(s.height, 2) for s in found] == [0.72]
    assert find_surfaces(np.empty((0, 3))) == []


def test_the_rectangle_forgives_a_few_stray_points() -> None:
    points = np.concatenate([patch(0, 0, 1.0, 0.5, 0.2, 0.7)[:, :2], [[3.0, 3.0]]])
    r = fit_rectangle(points)
    assert abs(r.length - 1.0) < 0.03 and abs(r.width - 0.5) < 0.03


def image(tilt: float = 0.0, table: float = 0.0) -> m.Rgbd:
    """A picture of the floor and, with `table`, of a top of that height 1 to 2 m ahead; the camera hangs `tilt` lower
    than its drawing says."""
    h, w, f = 120, 160, 100.0
    u, v = (np.arange(w) + 0.5 - w / 2) / f, (np.arange(h) + 0.5 - h / 2) / f
    ray = np.stack([np.broadcast_to(u, (h, w)), np.broadcast_to(v[:, None], (h, w)), np.ones((h, w))], -1)

    def rotation(pitch: float) -> np.ndarray:
        ahead = np.array([math.cos(pitch), 0, -math.sin(pitch)])
        down = np.array([-math.sin(pitch), 0, -math.cos(pitch)])
        return np.stack([(0, -1, 0), down, ahead], axis=1)

    way = ray @ rotation(PITCH + tilt).T
    depth = np.where(way[..., 2] < -0.05, -EYE[2] / np.minimum(way[..., 2], -0.05), 0.0)
    if table:
        on = (table - EYE[2]) / np.minimum(way[..., 2], -0.05)
        x, y = EYE[0] + on * way[..., 0], on * way[..., 1]
        depth = np.where((way[..., 2] < -0.05) & (x > 1.0) & (x < 2.0) & (np.abs(y) < 0.5), on, depth)
    millimetres = np.round(depth * 1000).astype("<u2")
    return m.Rgbd(
        t=0.0, id="", camera="head", width=w, height=h, fx=f, fy=f, cx=w / 2, cy=h / 2, position=EYE,
        orientation=matrix_quat(rotation(PITCH)), rgb=bytes(3 * h * w), depth=millimetres.tobytes(),
    )  # fmt: skip


def test_the_floor_puts_a_camera_right_that_hangs_askew() -> None:
    picture = CameraModel().read(image(tilt=0.01, table=0.72))
    assert len(picture.level) > 100
    assert abs(float(np.median(picture.level[:, 2])) - 0.72) < 0.005
    assert picture.above[:, 0].min() > 0.9 and len(picture.floor) > 500


def test_the_robots_own_arm_is_left_out_once_it_was_seen_from_all_sides() -> None:
    model, body = CameraModel(), image()
    depth = np.frombuffer(body.depth, "<u2").reshape(120, 160).copy()
    depth[80:, 60:100] = 700
    body.depth = depth.tobytes()
    assert (model.read(body).above[:, 0] < 0.9).any()
    for _ in range(CameraModel.MINIMUM):
        model.learn(body)
    assert model.learned and not (model.read(body).above[:, 0] < 0.9).any()


def test_what_stands_where_the_base_is_is_the_robot() -> None:
    body, pitch = image(), PITCH
    depth = np.frombuffer(body.depth, "<u2").reshape(120, 160).copy()
    along = 0.3 * math.cos(pitch) - 0.3 * (119.5 - 60) / 100.0 * math.sin(pitch)
    assert EYE[0] + along < FOOTPRINT, "the lowest row, 0.3 m before the camera"
    depth[118:, 70:90] = 300
    body.depth = depth.tobytes()
    picture = CameraModel().read(body)
    for layer in (picture.above, picture.level, picture.low):
        assert not len(layer) or np.hypot(layer[:, 0], layer[:, 1]).min() > FOOTPRINT - 0.02


def room(grid: Grid, half: float = 2.0) -> None:
    """A square room with a door of 1 m in its east wall, seen by lidar and camera from its middle."""
    angles = np.radians(np.arange(0, 360, 0.5))
    reach = half / np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles)))
    ends = np.stack([np.cos(angles), np.sin(angles)], 1) * reach[:, None]
    door = (ends[:, 0] > half - 0.01) & (np.abs(ends[:, 1]) < 0.5)
    scan = Scan(0.0, ends[~door], ends[door] * 2, (0.0, 0.0))
    floor = np.stack(np.meshgrid(np.arange(-1.95, 1.97, 0.025), np.arange(-1.95, 1.97, 0.025)), -1).reshape(-1, 2)
    for _ in range(3):
        grid.add_scan(scan, (0.0, 0.0, 0.0))
        grid.add_picture(floor, np.empty((0, 3)))


@pytest.mark.parametrize(("field", "value"), [("fx", 0.0), ("fy", float("nan")), ("depth", b"12")])
def test_a_picture_that_cannot_be_read_teaches_nothing_of_the_camera(field: str, value: object) -> None:
    """Kept until the camera is known it would be found bad then, and take those that wait with it."""
    bad = image()
    setattr(bad, field, value)
    model = CameraModel()
    for use in (model.learn, model.read):
        with pytest.raises(PictureError):
            use(bad)


def test_cells_are_free_where_both_sensors_say_so() -> None:
    grid = Grid((-6.0, -6.0), (6.0, 6.0))
    room(grid)
    states = grid.states()

    def state(x: float, y: float) -> int:
        rows, columns = grid.cells(np.array([[x, y]]))
        return int(states[rows[0], columns[0]])

    assert state(0.0, 1.0) == FREE and state(-2.0, 0.0) == OCCUPIED
    assert state(3.0, 0.0) == UNKNOWN, "lidar rays passed, but no camera has seen the floor"
    assert state(-4.0, 0.0) == UNKNOWN


def test_a_table_top_is_an_obstacle_though_the_lidar_looks_under_it() -> None:
    grid = Grid((-6.0, -6.0), (6.0, 6.0))
    room(grid)
    for _ in range(2):
        grid.add_picture(np.empty((0, 2)), patch(1.0, 1.0, 0.6, 0.6, 0, 0.7))
    rows, columns = grid.cells(np.array([[1.0, 1.0]]))
    assert grid.states()[rows[0], columns[0]] == OCCUPIED and not grid.walls[rows[0], columns[0]]
    assert abs(grid.highest[rows[0], columns[0]] - 0.7) < 0.02


def test_the_only_frontier_is_the_door() -> None:
    grid = Grid((-6.0, -6.0), (6.0, 6.0))
    room(grid)
    found = survey(grid, grid.states(), (0.0, 0.0, 0.0), [])
    assert found.frontiers == 1 and abs(found.area - 16.0) < 1.5
    assert found.view is not None
    x, y, theta = found.view.pose
    bearing = math.atan2(0.0 - y, 2.1 - x)
    assert abs(math.remainder(bearing - theta, 2 * math.pi)) < math.radians(34)


@pytest.mark.parametrize("shift", range(SPACING))
def test_a_corridor_is_looked_along_wherever_it_lies_on_the_grid(shift: int) -> None:
    """0.85 m wide as it is seen: the robot's middle has 15 cm to be in."""
    grid = Grid((-6.0, -6.0), (6.0, 6.0))
    states = np.full(grid.shape, UNKNOWN, np.uint8)
    rows = slice(120 + shift, 137 + shift)
    states[rows, 60:120], grid.passed[rows, 60:200] = FREE, 1
    found = survey(grid, states, (*grid.points((np.array([128 + shift]), np.array([70])))[0], 0.0), [])
    assert found.frontiers >= 1 and found.view is not None and found.view.pose[2] == 0.0


def test_what_is_behind_a_barrier_is_not_to_be_reached() -> None:
    """In a corridor that is no wider than the robot needs, with more of it to be seen at one end."""
    grid = Grid((-6.0, -6.0), (6.0, 6.0))
    states = np.full(grid.shape, OCCUPIED, np.uint8)
    states[120:137, 60:200], states[120:137, 200:] = FREE, UNKNOWN
    grid.passed[120:137, 60:] = 1
    here, barrier = grid.points((np.array([128, 128]), np.array([70, 90])))
    free = survey(grid, states, (here[0], here[1], 0.0), [])
    assert free.view is not None and free.view.pose[0] > barrier[0] + 0.5
    states[shut([Met((here[0], here[1]), (barrier[0], barrier[1]))], [], grid)] = OCCUPIED
    assert survey(grid, states, (here[0], here[1], 0.0), []).view is None


def met(y: float, aim: float = 0.0) -> Met:
    """Held up by what is beyond x = 1, on the way to something `aim` [m] to the left of straight ahead."""
    return Met((1.02 - BEFORE, y), (1.02 - BEFORE + 0.3, y + aim))


def test_a_pane_reaches_from_frame_to_frame_through_where_it_was_met() -> None:
    """3 m wide in a wall along y; what is met once, or far apart, or from two sides is a place and no pane."""
    grid = Grid((-6.0, -6.0), (6.0, 6.0))
    states = np.full(grid.shape, FREE, np.uint8)
    wall = grid.cells(np.array([(1.02, y) for y in np.arange(-4.0, 4.0, 0.02) if abs(y) > 1.5]))
    states[wall] = OCCUPIED
    ((start, end),) = lines = panes([met(0.3, 0.4), met(-0.5)], states, grid)
    assert sorted((start[1], end[1])) == pytest.approx([-1.5, 1.5], abs=0.06)
    closed = shut([], lines, grid)
    assert grid.at(np.array([(1.02, y) for y in np.arange(-1.4, 1.4, 0.1)]), closed).all() and closed.sum() < 70
    (pane,) = glass(lines)
    assert pane.glass and pane.start[0] == pane.end[0] == pytest.approx(1.02, abs=0.001)
    assert len(panes([met(y) for y in (-0.6, -0.3, 0.3, 0.7)], states, grid)) == 1, "one pane, however often"
    behind = Met((1.3, -0.5), (1.0, -0.5))
    for places in ([met(0.3)], [met(0.3), met(0.35)], [met(1.3), met(-1.3)], [met(0.3), behind]):
        assert panes(places, states, grid) == []
    assert shut([met(0.3)], [], grid).sum() == 1
    states[wall] = FREE
    ((start, end),) = panes([met(0.0), met(1.0)], states, grid)
    assert (start[1], end[1]) == (0.0, 1.0), "without a frame"


def test_the_map_that_is_driven_by_has_what_nobody_sees() -> None:
    mapper = Mapper((-6.0, -6.0), (6.0, 6.0))
    room(mapper.grid)
    place = np.array([(0.9, 0.2)])
    assert mapper.grid.states()[mapper.grid.cells(place)] == FREE
    mapper.trajectory.add(Scan(0.0, np.empty((0, 2)), np.empty((0, 2)), (0.0, 0.0)), (0.0, 0.0, 0.0))
    states = mapper.meet(Met((0.5, 0.2), (0.9, 0.2)))
    assert states[mapper.grid.cells(place)] == mapper.grid.states()[mapper.grid.cells(place)] == OCCUPIED
    _, states = mapper.survey((0.0, 0.0, 0.0), [])
    assert states[mapper.grid.cells(place)] == OCCUPIED
    ((at, _),) = mapper.met
    mapper.met = [(at, Met((0.5, 1.2), (0.9, 1.2)))]
    assert mapper.states()[mapper.grid.cells(place)] == FREE, "where its keyframe has moved to"


def test_where_nothing_is_left_the_survey_ends() -> None:
    grid = Grid((-6.0, -6.0), (6.0, 6.0))
    room(grid)
    grid.looked[:] = FLOOR_TRIES
    assert survey(grid, grid.states(), (0.0, 0.0, 0.0), []).view is None


def test_the_message_holds_the_known_part() -> None:
    grid = Grid((-6.0, -6.0), (6.0, 6.0))
    room(grid)
    states = grid.states()
    sent = grid.message(1.0, (0.1, 0.0, 0.0), states)
    cells = np.frombuffer(zlib.decompress(sent.cells), np.uint8).reshape(sent.height, sent.width)
    row, column = round((sent.y + 6.0) / RESOLUTION), round((sent.x + 6.0) / RESOLUTION)
    assert (states[row : row + sent.height, column : column + sent.width] == cells).all()
    assert (cells == FREE).sum() == (states == FREE).sum()
