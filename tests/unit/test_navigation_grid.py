"""The costmap and the path planner on flats of a few cells, against what can be worked out by hand."""

import itertools
import math
import zlib

import numpy as np
import pytest

from common.floor_plan import Box, Place, Receptacle, Wall
from common.geometry import Point
from common.household import Household, load_household
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import SPACING, PathPlanner

CELL = 0.125
ORIGIN = -0.3  # of either axis: the flat begins at 0, the map 0.3 m before
FAR_AWAY = 20.0
EAST = np.radians(np.arange(360.0))


def flat(width: float = 2.0, height: float = 1.0, **more: object) -> Household:
    return Household(name="x", low=(0.0, 0.0), high=(width, height), home=Place(name="home", x=0, y=0), **more)  # type: ignore[arg-type]


def costmap(scene: Household | None = None, memory: float = 30.0) -> Costmap:
    return Costmap(scene or flat(), CELL, memory)


def centre(row: int, column: int) -> Point:
    return ORIGIN + (column + 0.5) * CELL, ORIGIN + (row + 0.5) * CELL


def inside(scene: Household, rectangle: tuple[float, float, float, float, float]) -> set[tuple[int, int]]:
    """Cells of the flat whose centre is in a rectangle (x, y, length, width, yaw)."""
    x, y, length, width, yaw = rectangle
    found = set()
    for cell in itertools.product(range(40), range(60)):
        px, py = centre(*cell)
        if not (0 <= px <= scene.high[0] and 0 <= py <= scene.high[1]):
            continue
        away, bearing = math.hypot(px - x, py - y), math.atan2(py - y, px - x) - yaw
        if abs(away * math.cos(bearing)) <= length / 2 and abs(away * math.sin(bearing)) <= width / 2:
            found.add(cell)
    return found


def occupied(scene: Household) -> set[tuple[int, int]]:
    """Cells of the flat that its static map counts as occupied."""
    grid = costmap(scene).static_distance <= 0
    cells = zip(*(axis.tolist() for axis in np.nonzero(grid)), strict=True)
    return {c for c in cells if 0 <= centre(*c)[0] <= scene.high[0] and 0 <= centre(*c)[1] <= scene.high[1]}


# --- the static map
def test_the_map_is_larger_than_the_flat_and_what_is_outside_is_occupied() -> None:
    made = costmap()
    assert made.shape == (13, 21) and made.origin == (ORIGIN, ORIGIN) and made.resolution == CELL
    assert (made.static_distance <= 0).dtype == bool
    for cell in itertools.product(range(13), range(21)):
        x, y = centre(*cell)
        assert (made.static_distance <= 0)[cell] == (not (0 <= x <= 2 and 0 <= y <= 1)), (x, y)
        assert made.point(*cell) == pytest.approx((x, y))
    shifted = Costmap(Household(name="x", low=(1, -2), high=(2, 1), home=Place(name="home", x=1, y=0)), 0.25, 1.0)
    assert shifted.shape == (15, 7) and shifted.origin == pytest.approx((0.7, -2.3))


def test_furniture_tables_bins_and_walls_are_where_the_scene_puts_them() -> None:
    box = Box(name="b", center=(0.8, 0.4, 0.2), size=(0.7, 0.3, 0.4), yaw=0.4)
    scene = flat(furniture=(box,))
    assert occupied(scene) == inside(scene, (0.8, 0.4, 0.7, 0.3, 0.4)) != set()
    table = Receptacle(name="t", kind="table", center=(1.2, 0.5, 0.7), size=(0.8, 0.35), yaw=-0.3)
    scene = flat(receptacles=(table,))
    assert occupied(scene) == inside(scene, (1.2, 0.5, 0.8, 0.35, -0.3)) != set()
    wall = Wall(start=(0.3, 0.2), end=(1.5, 0.8), thickness=0.2)
    scene = flat(walls=(wall,))
    length = math.hypot(1.2, 0.6) + 0.2
    assert occupied(scene) == inside(scene, (0.9, 0.5, length, 0.2, math.atan2(0.6, 1.2))) != set()


def test_a_rug_and_what_hangs_above_the_robot_are_in_nobodys_way() -> None:
    rug, lamp = (
        Box(name="b", center=(0.8, 0.4, middle), size=(0.7, 0.3, height))
        for middle, height in ((0.01, 0.02), (1.7, 0.4))
    )
    assert occupied(flat(furniture=(rug, lamp))) == set()
    step, cupboard = (
        Box(name="b", center=(0.8, 0.4, middle), size=(0.7, 0.3, height))
        for middle, height in ((0.02, 0.04), (1.5, 0.4))
    )
    for box in (step, cupboard):
        assert occupied(flat(furniture=(box,))) == inside(flat(), (0.8, 0.4, 0.7, 0.3, 0.0)) != set()


def test_a_bin_counts_with_its_rim() -> None:
    x, y = centre(6, 8)
    sides = (2 * CELL - 0.03, 2 * CELL - 0.03)  # half of it ends 15 mm before the next cell's centre
    for depth, size in ((0.0, sides), (0.4, (sides[0] + 0.04, sides[1] + 0.04))):
        one = Receptacle(name="r", kind="bin", center=(x, y, 0.0), size=sides, depth=depth)
        scene = flat(receptacles=(one,))
        assert occupied(scene) == inside(scene, (x, y, *size, 0.0))
        assert len(occupied(scene)) == (9 if depth else 1)


def test_the_distance_is_exact_and_not_counted_in_cells() -> None:
    box = Box(name="b", center=(1.13, 0.52, 0.2), size=(0.31, 0.17, 0.4), yaw=0.4)
    made = costmap(flat(furniture=(box,)))
    for x, y in (centre(*c) for c in zip(*np.nonzero(~(made.static_distance <= 0)), strict=True)):
        to_the_edge = min(x, 2 - x, y, 1 - y)
        assert made.clearance(x, y) == pytest.approx(min(to_the_edge, box.outline.distance(x, y)))
    assert made.clearance(-0.2, -0.2) == 0.0


@pytest.mark.parametrize(
    ("point", "cell"),
    [
        ((-0.3, -0.3), (0, 0)), ((-0.18, -0.18), (0, 0)), ((-0.17, -0.3), (0, 1)), ((-0.3, -0.17), (1, 0)),
        ((-9.0, 0.5), (6, 0)), ((9.0, 0.5), (6, 20)), ((0.5, -9.0), (0, 6)), ((0.5, 9.0), (12, 6)),
        ((2.2, 1.2), (12, 20)),
    ],
)  # fmt: skip
def test_a_point_is_in_its_cell_or_in_the_nearest_one_of_the_map(point: Point, cell: tuple[int, int]) -> None:
    made = costmap()
    assert made.cell(*point) == cell
    assert made.seen_within(np.array([point]), 1.0).shape == (1,)


def test_the_clearance_of_a_line_is_the_least_on_it_with_both_ends() -> None:
    pillar = Box(name="p", center=(*centre(6, 10), 0.5), size=(0.05, 0.05, 1.0))
    made = costmap(flat(furniture=(pillar,)))
    west, east = centre(6, 5), centre(6, 15)
    assert made.line_clearance(west, east) == 0.0
    assert made.line_clearance(west, centre(6, 10)) == made.line_clearance(centre(6, 10), east) == 0.0
    above = made.line_clearance(centre(8, 5), centre(8, 15))
    assert above == pytest.approx(2 * CELL - 0.025)
    assert made.line_clearance(centre(4, 10), centre(9, 10)) == 0.0
    assert made.line_clearance(west, west) == made.clearance(*west)
    ahead = made.line_clearance(centre(6, 12), centre(6, 14))
    assert ahead == pytest.approx(2 * CELL - 0.025), "the line, not what lies behind it"


def test_the_picture_is_the_clearance_up_to_a_metre() -> None:
    made = costmap(flat(4.0, 4.0))
    shown = made.picture(7.5)
    cells = np.frombuffer(zlib.decompress(shown.cells), np.uint8).reshape(made.shape)
    assert (shown.t, shown.x, shown.y, shown.resolution, shown.far) == (7.5, ORIGIN, ORIGIN, CELL, 1.0)
    assert (shown.height, shown.width) == made.shape
    assert (cells == np.minimum(made.distance * 255, 255).astype(np.uint8)).all()
    assert cells.max() == 255 and cells.min() == 0


# --- what the lidar sees
ROOM = flat(6.0, 6.0)
HERE = (3.0125, 3.0125, 0.0)  # the centre of a cell


def scan(**hits: float) -> np.ndarray:
    """Ranges (360,): nothing but at the degrees given, as `d90=1.0`."""
    ranges = np.full(360, FAR_AWAY)
    for name, distance in hits.items():
        ranges[int(name[1:])] = distance
    return ranges


def see(made: Costmap, now: float, pose: tuple[float, float, float] = HERE, limit: float = 10.0, **hits: float) -> None:
    made.obstacles.see(pose, EAST, scan(**hits), limit, now)


def test_what_the_map_lacks_is_marked_where_the_ray_ends() -> None:
    made = costmap(ROOM)
    before = made.distance
    assert made.version == 0 and made.obstacles.empty
    see(made, 1.0, d0=1.0)
    assert not made.obstacles.empty and made.version == 1
    spot = made.cell(4.0, 3.0)
    grid = made.distance
    assert grid is not before and before[spot] > 1.0, "the static distances are left alone"
    rows, columns = np.indices(made.shape)
    away = np.hypot(rows - spot[0], columns - spot[1]) * CELL
    reach = math.ceil(0.8 / CELL)
    near = (abs(rows - spot[0]) <= reach) & (abs(columns - spot[1]) <= reach)
    assert np.allclose(grid, np.where(near, np.minimum(away, made.static_distance), made.static_distance))
    see(made, 1.1, d0=1.0)
    assert made.version == 1 and made.distance is grid, "nothing new"


def test_a_turned_robot_sees_turned() -> None:
    made = costmap(ROOM)
    see(made, 1.0, (2.0, 4.0, math.pi / 2), d0=1.0, d90=0.5)
    assert made.clearance(2.0, 5.0) == made.clearance(1.5, 4.0) == 0.0
    assert made.clearance(2.5, 4.0) > 0.4


def test_something_in_the_corner_of_the_map_is_marked_too() -> None:
    made = Costmap(flat(0.5, 0.5), CELL, 30.0)
    made.confine(np.full(made.shape, 5.0))
    see(made, 1.0, (0.23, 0.23, 0.0), d180=0.48, d0=0.47, d90=0.47, d270=0.48)
    for x, y in ((-0.25, 0.23), (0.7, 0.23), (0.23, 0.7), (0.23, -0.25)):
        assert made.clearance(x, y) == 0.0


def test_a_range_beyond_the_limit_is_nothing_and_one_at_it_is_something() -> None:
    made = costmap(ROOM)
    see(made, 1.0, limit=1.0, d0=1.01)
    assert made.obstacles.empty
    see(made, 1.0, limit=1.0, d0=1.0)
    assert not made.obstacles.empty


def test_what_the_map_explains_or_does_not_reach_is_not_marked() -> None:
    made = costmap(ROOM)
    see(made, 1.0, d0=3.0, d90=2.97, d180=3.9, d270=9.0)
    see(made, 1.0, (0.5, 0.5, 0.0), d180=0.85, d270=9.0)
    assert made.obstacles.empty and made.version == 0
    see(made, 1.0, d0=2.7)
    assert not made.obstacles.empty


def test_a_ray_that_passes_clears_and_one_that_ends_before_does_not() -> None:
    made = costmap(ROOM)
    see(made, 1.0, d90=1.0)
    see(made, 1.1, d90=0.5)
    assert made.clearance(3.0125, 4.0125) == 0.0 and made.clearance(3.0125, 3.5125) == 0.0
    see(made, 1.2, d90=1.1)
    assert made.clearance(3.0125, 4.0125) == 0.0, "not 15 cm beyond it"
    version = made.version
    see(made, 1.3, d0=0.9)
    assert made.clearance(3.0125, 4.0125) > 0.4 and made.version == version + 1
    see(made, 1.4)
    assert made.obstacles.empty and made.distance is made.static_distance


def test_only_the_ray_at_its_bearing_clears() -> None:
    made = costmap(ROOM)
    see(made, 1.0, (3.0, 3.0, 1.0), d300=1.0)
    spot = made.point(*made.cell(3.0 + math.cos(math.radians(300) + 1.0), 3.0 + math.sin(math.radians(300) + 1.0)))
    ray = round(math.degrees(math.atan2(spot[1] - 3.0, spot[0] - 3.0) - 1.0)) % 360
    behind = np.full(360, 0.3)
    behind[ray] = FAR_AWAY
    made.obstacles.see((3.0, 3.0, 1.0), EAST, behind, 10.0, 1.1)
    assert made.clearance(*spot) > 0.0
    see(made, 1.2, (3.0, 3.0, 1.0), d300=1.0)
    before = np.full(360, FAR_AWAY)
    before[ray] = 0.5
    made.obstacles.see((3.0, 3.0, 1.0), EAST, before, 10.0, 1.3)
    assert made.clearance(*spot) == 0.0


def shadow(made: Costmap, now: float) -> None:
    """Look away: nothing is seen, and no ray passes what was seen in the east."""
    made.obstacles.see(HERE, EAST, np.full(360, 0.05), 0.01, now)


@pytest.mark.parametrize(("memory", "brief"), [(30.0, 4.0), (3.0, 3.0)])
def test_what_was_there_for_a_moment_is_forgotten_soon(memory: float, brief: float) -> None:
    made = costmap(ROOM, memory)
    see(made, 1.0, d0=1.0)
    see(made, 3.0, d0=1.0)
    shadow(made, 3.0 + brief)
    assert not made.obstacles.empty
    shadow(made, 3.1 + brief)
    assert made.obstacles.empty


def test_what_stood_there_for_longer_is_remembered() -> None:
    made = costmap(ROOM, 30.0)
    see(made, 1.0, d0=1.0)
    see(made, 3.1, d0=1.0)
    shadow(made, 33.0)
    assert not made.obstacles.empty
    shadow(made, 33.2)
    assert made.obstacles.empty
    see(made, 40.0, d0=1.0)
    shadow(made, 44.1)
    assert made.obstacles.empty, "it was forgotten when it came first"


def test_doubt_forgets_what_is_out_of_sight() -> None:
    made = costmap(ROOM)
    made.obstacles.doubt(5.0, 1.0, (0.0, 0.0))
    assert made.version == 0
    see(made, 1.0, d0=1.0)
    made.obstacles.doubt(3.0, 2.0, (0.0, 0.0))
    assert not made.obstacles.empty and made.version == 1
    made.obstacles.doubt(3.1, 2.0, (0.0, 0.0))
    assert made.obstacles.empty and made.version == 2
    assert made.clearance(4.0, 3.0) > 0.9, "the distances follow"


def test_points_near_something_unmapped_are_told_from_those_near_a_wall() -> None:
    made = costmap(ROOM)
    see(made, 1.0, d0=1.0)
    points = np.array([[4.0, 3.0], [4.3, 3.0], [4.0, 3.6], [0.1, 3.0], [3.0, 4.0]])
    assert made.seen_within(points, 0.5).tolist() == [True, True, False, False, False]
    assert made.seen_within(points, made.clearance(4.3, 3.0)).tolist() == [True, False, False, False, False]


# --- paths
RADIUS, INFLATION = 0.3, 0.6


def planner(scene: Household = ROOM) -> tuple[Costmap, PathPlanner]:
    made = costmap(scene)
    return made, PathPlanner(made, RADIUS, INFLATION)


def cost(a: Point, b: Point, scene: Household = ROOM) -> float:
    paths = planner(scene)[1]
    return paths.cost_to(paths.field(*a), b)


def test_the_disc_fits_where_the_clearance_is_its_radius() -> None:
    made = costmap(ROOM)
    cell = centre(30, 5)
    exact = made.clearance(*cell)
    assert PathPlanner(made, exact, 2 * exact).free(*cell)
    assert not PathPlanner(made, exact + 1e-6, 2 * exact).free(*cell)


def test_the_cost_in_the_open_is_the_length() -> None:
    assert cost(centre(20, 20), centre(20, 30)) == pytest.approx(10 * CELL)
    assert cost(centre(20, 20), centre(30, 20)) == pytest.approx(10 * CELL)
    assert cost(centre(20, 20), centre(30, 30)) == pytest.approx(10 * CELL * math.sqrt(2))
    assert cost(centre(20, 30), centre(30, 20)) == pytest.approx(10 * CELL * math.sqrt(2))


def test_near_a_wall_the_cost_grows_with_the_square_of_what_is_lacking() -> None:
    made, paths = planner()
    column = 2
    while not paths.free(*centre(20, column)):
        column += 1
    clearance = made.clearance(*centre(20, column))
    assert RADIUS < clearance < INFLATION
    lack = (INFLATION - clearance) / (INFLATION - RADIUS)
    step = paths.cost_to(paths.field(*centre(20, column)), centre(21, column))
    assert step == pytest.approx(CELL * (1 + 4 * lack**2))
    aside = made.clearance(*centre(20, column + 1))
    other = 1 + 4 * max(0.0, (INFLATION - aside) / (INFLATION - RADIUS)) ** 2
    step = paths.cost_to(paths.field(*centre(20, column)), centre(20, column + 1))
    assert step == pytest.approx(CELL * (1 + 4 * lack**2 + other) / 2)


HALVES = flat(6.0, 6.0, walls=(Wall(start=(3.0, 0.0), end=(3.0, 6.0)),))
DOOR = flat(6.0, 6.0, walls=(Wall(start=(3.0, 0.0), end=(3.0, 4.2)), Wall(start=(3.0, 5.2), end=(3.0, 6.0))))
WEST, EASTERN = (1.5, 1.5), (4.5, 1.5)


def test_there_is_no_way_through_a_wall() -> None:
    paths = planner(HALVES)[1]
    field = paths.field(*WEST)
    assert paths.path(field, WEST, EASTERN) is None and paths.cost_to(field, EASTERN) == math.inf
    assert not paths.possible(WEST, [EASTERN])
    assert paths.possible(WEST, [EASTERN, (1.0, 5.0)])
    assert not paths.possible(WEST, [(3.0, 3.0), (0.0, 0.0)]) and not paths.possible(WEST, [])


def test_a_way_round_keeps_clear_of_the_wall_and_is_no_longer_than_it_must_be() -> None:
    made, paths = planner(DOOR)
    field = paths.field(*WEST)
    assert paths.possible(WEST, [EASTERN])
    path = paths.path(field, WEST, EASTERN)
    assert path is not None and path[0] == WEST and path[-1] == EASTERN
    steps = [math.dist(a, b) for a, b in itertools.pairwise(path)]
    assert max(steps) <= SPACING + 1e-9 and max(steps) - min(steps) < 0.01
    assert min(made.clearance(*p) for p in path) >= RADIUS - CELL
    through = min(path, key=lambda p: abs(p[0] - 3.0))
    assert 4.5 < through[1] < 4.95
    shortest = math.dist(WEST, (3.0, 4.5)) + math.dist((3.0, 4.5), EASTERN)
    assert shortest < sum(steps) < 1.15 * shortest


def test_in_the_open_the_path_is_a_straight_line() -> None:
    paths = planner()[1]
    start, goal = (1.0, 1.2), (4.9, 3.1)
    path = paths.path(paths.field(*start), start, goal)
    assert path is not None
    length = math.dist(start, goal)
    assert len(path) == math.ceil(length / SPACING) + 1
    for n, (x, y) in enumerate(path):
        share = n / (len(path) - 1)
        assert (x, y) == pytest.approx((1.0 + 3.9 * share, 1.2 + 1.9 * share))


def test_a_path_to_where_one_stands_is_two_points() -> None:
    paths = planner()[1]
    assert paths.path(paths.field(2.0, 2.0), (2.0, 2.0), (2.0, 2.0)) == [(2.0, 2.0), (2.0, 2.0)]


def test_a_start_too_close_to_something_is_moved_to_the_nearest_free_cell() -> None:
    made, paths = planner()
    field = paths.field(0.05, 3.0)
    row, column = made.cell(0.05, 3.0)
    assert field.start[0] == row and field.start[1] > column
    assert made.distance[field.start] >= RADIUS > made.distance[row, field.start[1] - 1]
    assert field.cost[field.start] == 0.0
    path = paths.path(field, (0.05, 3.0), (2.0, 3.0))
    assert path is not None and path[0] == (0.05, 3.0)
    assert paths.possible((0.05, 3.0), [(2.0, 3.0)])
    corner = paths.field(0.05, 0.1)
    assert corner.start[0] > made.cell(0.05, 0.1)[0] and corner.start[1] > made.cell(0.05, 0.1)[1]


def test_where_nothing_is_free_there_is_no_way() -> None:
    made, paths = planner(flat(0.3, 0.3))
    assert paths.field(0.2, 0.2).start == made.cell(0.2, 0.2)
    assert paths.path(paths.field(0.2, 0.2), (0.2, 0.2), (0.1, 0.1)) is None
    assert not paths.possible((0.2, 0.2), [(0.2, 0.2)])


def test_what_the_lidar_sees_is_planned_around_but_is_no_wall_for_ever() -> None:
    made, paths = planner(DOOR)
    assert math.isfinite(paths.cost_to(paths.field(*WEST), EASTERN))
    made.obstacles.see((3.0, 4.0, math.pi / 2), EAST, scan(d0=0.7), 10.0, 1.0)
    assert paths.cost_to(paths.field(*WEST), EASTERN) == math.inf
    assert paths.possible(WEST, [EASTERN]), "the static map has a way"
    made.obstacles.doubt(10.0, 1.0, (0.0, 0.0))
    assert math.isfinite(paths.cost_to(paths.field(*WEST), EASTERN))


def test_corners_are_cut_only_as_far_as_the_path_kept_clear() -> None:
    box = Box(name="b", center=(3.0, 2.0, 0.5), size=(1.0, 4.0, 1.0))
    made, paths = planner(flat(6.0, 6.0, furniture=(box,)))
    start, goal = (1.5, 0.8), (4.5, 0.8)
    field = paths.field(*start)
    path = paths.path(field, start, goal)
    assert path is not None
    assert min(made.clearance(*p) for p in path) >= INFLATION - 0.03 - CELL
    length = sum(math.dist(a, b) for a, b in itertools.pairwise(path))
    # Over both corners of the box at the distance that the planner prefers.
    by_hand = 2 * math.dist(start, (2.5 - INFLATION / 2, 4.0 + INFLATION / 2)) + 1.0 + INFLATION
    assert 0.9 * by_hand < length < 1.1 * by_hand


def test_a_way_out_of_a_narrow_place_comes_no_closer_to_anything_than_the_base_stands() -> None:
    made = Costmap(load_household("apartment"), 0.05, 30.0)
    planner, rng, tried = PathPlanner(made, 0.31, 0.65), np.random.default_rng(1), 0
    while tried < 60:
        x, y = rng.uniform(-2.5, 5.5), rng.uniform(-3.0, 4.5)
        room = made.clearance(x, y)
        if not 0.24 < room < 0.31 or (path := planner.path(planner.field(x, y), (x, y), (0.0, 0.0))) is None:
            continue
        tried += 1
        points = np.array(path)
        assert made.distance[made.cells(points[:, 0], points[:, 1])].min() > room - 0.02
