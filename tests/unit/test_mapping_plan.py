"""The floor plan out of a grid: bins, furniture round a corner, rooms."""

import math

import numpy as np
import pytest

from common.files.map_file import FREE, OCCUPIED, UNKNOWN
from common.floor_plan import Receptacle, Room, Wall
from common.free_sides import free_sides
from common.geometry import Rectangle
from services.mapping.bins import find_bins
from services.mapping.grid import Grid
from services.mapping.plan import compact_parts, delivery_place, is_rim, kind_of_surface, reachable, without_nested
from services.mapping.rooms import find_rooms, openings
from services.mapping.surfaces import Surface
from services.mapping.views import interesting
from services.mapping.walls import find_walls


def ring(x: float, y: float, inner: float, height: float) -> np.ndarray:
    """Points of the four sides of an open box, 1.5 cm thick and `height` high, around a hole of `inner`."""
    along, up = np.arange(-inner / 2 - 0.015, inner / 2 + 0.016, 0.01), np.arange(0.06, height + 0.001, 0.01)
    found = []
    for side in (-1, 1):
        for thick in (0.0, 0.015):
            off = side * (inner / 2 + thick)
            a, z = (v.ravel() for v in np.meshgrid(along, up))
            found += [np.column_stack([x + a, y + 0 * a + off, z]), np.column_stack([x + off + 0 * a, y + a, z])]
    return np.concatenate(found)


def grid_of(above: np.ndarray) -> Grid:
    grid = Grid((-3.0, -3.0), (3.0, 3.0))
    for _ in range(2):
        grid.add_picture(np.empty((0, 2)), above)
    return grid


def test_an_open_box_is_a_bin_with_its_measures() -> None:
    points = ring(0.51, -0.27, 0.34, 0.40)
    ((outline, rim),) = find_bins(grid_of(points), points)
    assert abs(rim - 0.40) < 0.01
    assert np.hypot(outline.x - 0.51, outline.y + 0.27) < 0.01
    assert abs(outline.length - 0.34) < 0.02 and abs(outline.width - 0.34) < 0.02


def test_a_bin_whose_rim_was_seen_in_part_is_as_large_as_its_hole() -> None:
    points = ring(0.51, -0.27, 0.34, 0.40)
    ((outline, _),) = find_bins(grid_of(points), points[points[:, 1] > -0.15])
    assert np.hypot(outline.x - 0.51, outline.y + 0.27) < 0.04
    assert abs(outline.length - 0.34) < 0.10 and abs(outline.width - 0.34) < 0.10


def test_a_bin_in_a_corner_has_two_high_sides_and_may_have_a_gap() -> None:
    points = ring(0.51, -0.27, 0.34, 0.40)
    up = np.arange(0.1, 1.2, 0.02)
    walls = [(x, -0.445, z) for x in np.arange(-1.0, 0.7, 0.02) for z in up]
    walls += [(0.695, y, z) for y in np.arange(-0.45, 1.0, 0.02) for z in up]
    walls += [(x, -0.095, z) for x in np.arange(0.62, 0.7, 0.01) for z in up]
    hidden = (np.abs(points[:, 0] - 0.475) < 0.03) & (points[:, 1] > -0.12)
    for seen in (points, points[~hidden]):
        ((outline, rim),) = find_bins(grid_of(np.concatenate([seen, walls])), seen)
        assert abs(rim - 0.40) < 0.01
        assert np.hypot(outline.x - 0.51, outline.y + 0.27) < 0.05


def test_what_covers_the_bottom_of_a_bin_is_no_side_of_it() -> None:
    points = ring(0.51, -0.27, 0.34, 0.40)
    bottom = [(x, y, 0.05) for x in np.arange(0.36, 0.66, 0.02) for y in np.arange(-0.24, -0.1, 0.02)]
    ((outline, _),) = find_bins(grid_of(np.concatenate([points, bottom])), points)
    assert abs(outline.length - 0.34) < 0.02 and abs(outline.width - 0.34) < 0.02


def test_a_place_behind_a_narrow_passage_is_reached() -> None:
    """The robot came through; where it stands it has to have room."""
    states = np.full((60, 120), OCCUPIED, np.uint8)
    states[2:58, 2:58], states[2:58, 62:118] = FREE, FREE
    states[24:36, 58:62] = FREE
    reached = reachable(states)
    assert reached[30, 30] and reached[30, 90] and not reached[30, 60]
    states[24:36, 58:62] = OCCUPIED
    assert not (reachable(states)[30, 30] and reachable(states)[30, 90])


@pytest.mark.parametrize(("width", "free"), [(0.42, (0.08, 0.14)), (2.0, (0.6, 0.8))])
def test_a_side_is_reached_where_any_of_its_length_is(width: float, free: tuple[float, float]) -> None:
    """Of a bedside table the half that is away from the bed; of a bench what the table before it leaves."""
    grid = Grid((-3.0, -3.0), (3.0, 3.0))
    outline = Rectangle(0.0, 0.0, width, 0.4)
    reached = np.zeros(grid.shape, bool)
    assert free_sides(outline, lambda spots: grid.at(spots, reached)) == ()
    x, y = np.meshgrid(np.arange(*free, 0.01), np.arange(-0.62, -0.52, 0.01))
    reached[grid.cells(np.column_stack([x.ravel(), y.ravel()]))] = True
    assert free_sides(outline, lambda spots: grid.at(spots, reached)) == ((0.0, -1.0),)


def test_what_the_robot_stands_before_nowhere_is_reached_round_a_corner() -> None:
    """A bin between a table and a wall; beside what has a side with room it makes no further one."""
    grid = Grid((-3.0, -3.0), (3.0, 3.0))
    outline, reached = Rectangle(0.0, 0.0, 0.3, 0.3), np.zeros((120, 120), bool)
    reached[grid.cells(np.array([(0.27, -0.53)]))] = True
    assert free_sides(outline, lambda spots: grid.at(spots, reached)) == ((0.0, -1.0),)
    reached[grid.cells(np.array([(0.02, 0.58)]))] = True
    assert free_sides(outline, lambda spots: grid.at(spots, reached)) == ((0.0, 1.0),)


def test_a_high_or_a_large_ring_is_no_bin() -> None:
    for points in (ring(0.0, 0.0, 0.34, 1.0), ring(0.0, 0.0, 1.2, 0.40)):
        assert find_bins(grid_of(points), points) == []


def test_what_goes_round_a_corner_is_cut() -> None:
    line = np.arange(0.025, 2.0, 0.05)
    corner = np.concatenate([np.column_stack([line, 0 * line]), np.column_stack([0 * line, line])])
    parts = compact_parts(corner)
    assert len(parts) > 1 and sum(map(len, parts)) == len(corner)
    for part in parts:
        inside = (part > 0.3).all(axis=1)
        assert not inside.any()
        spread = np.sort(np.ptp(part, axis=0))
        assert spread[0] < 0.35, "no part reaches into the room"
    assert len(compact_parts(np.column_stack([line, 0 * line]))) == 1


@pytest.mark.parametrize("turn", [0.0, 0.5, -0.6])
def test_rooms_hang_together_by_doors_and_lie_along_the_walls(turn: float) -> None:
    """Of 4 x 3 m each, side by side, however the home is turned against where the robot looked when it was put down."""
    home = Rectangle(0.5, 0.0, 8.0, 3.0, turn)
    grid = Grid((-6.0, -6.0), (6.0, 6.0))
    cells = grid.points(tuple(np.indices(grid.shape).reshape(2, -1)))  # type: ignore[arg-type]
    inside = home.signed_distances(cells[:, 0], cells[:, 1]).reshape(grid.shape) < 0.0
    states = np.where(inside, FREE, UNKNOWN).astype(np.uint8)

    def parted(*ends: tuple[tuple[float, float], tuple[float, float]]) -> list[Room]:
        return find_rooms(grid, states, [Wall(start=home.to_map(*a), end=home.to_map(*b)) for a, b in ends])

    side, near, far = ((-4.0, -1.5), (4.0, -1.5)), ((0.0, -1.5), (0.0, -0.5)), ((0.0, 0.5), (0.0, 1.5))
    rooms = parted(side, near, far)
    assert [room.name for room in rooms] == ["room 1", "room 2"]
    middles = sorted(home.to_local(*room.middle) for room in rooms)
    assert np.array(middles) == pytest.approx(np.array([(-2.0, 0.0), (2.0, 0.0)]), abs=0.15)
    for room in rooms:
        assert (room.outline.length, room.outline.width) == pytest.approx((4.0, 3.0), abs=0.3)
        assert abs(np.sin(2 * (room.yaw - turn))) < 0.01
    assert len(parted(side)) == len(parted(side, near)) == 1, "what faces no other piece is no jamb"
    assert len(parted(side, near[::-1], far)) == 2, "both begin at the door and run away from it"
    wide = ((0.0, -1.5), (0.0, -1.1)), ((0.0, 1.1), (0.0, 1.5))
    assert len(parted(side, *wide)) == 2, "an open plan with two jambs"
    bin_side = ((-0.2, -1.1), (0.2, -1.1))
    assert len(parted(side, *wide, bin_side)) == 2, "a bin beside a jamb makes no corner of it"
    corners = ((-1.0, -1.1), (1.0, -1.1)), ((-1.0, 1.1), (1.0, 1.1))
    assert len(parted(side, *wide, *corners)) == 1, "walls across end here: what is between is a corridor"


def test_a_wall_that_was_seen_for_long_from_both_sides_is_one_wall() -> None:
    rng = np.random.default_rng(3)
    points, eyes = [], []
    for side in (-1.0, 1.0):
        x = rng.uniform(-2.0, 2.0, 8000)
        points.append(np.stack([x, 0.06 * side + rng.normal(0.0, 0.012, len(x))], axis=1))
        eyes.append(np.stack([x + rng.uniform(-0.5, 0.5, len(x)), np.full(len(x), 1.5 * side)], axis=1))
    (wall,) = find_walls(np.concatenate(points), np.concatenate(eyes), [])
    assert abs(wall.thickness - 0.12) < 0.01
    assert max(abs(wall.start[1]), abs(wall.end[1])) < 0.005
    assert sorted((wall.start[0], wall.end[0])) == pytest.approx([-1.94, 1.94], abs=0.05)


@pytest.mark.parametrize("lean", [6.0, 28.0])
def test_a_wall_askew_is_one_wall_and_no_stair_of_straight_ones(lean: float) -> None:
    """Of a room 4 m wide the fourth wall leans; what is short and askew stays furniture."""
    rng, turn = np.random.default_rng(7), math.radians(lean)
    top = Rectangle(0.0, 2.0, 4.0 / math.cos(turn), 0.0, turn)
    half, slope = top.length / 2, 2.0 * math.tan(turn)
    lines = [((-2.0, -2.0), (2.0, -2.0)), ((2.0, -2.0), (2.0, 2.0 + slope)), ((-2.0, -2.0), (-2.0, 2.0 - slope)),
             (top.to_map(-half, 0.0), top.to_map(half, 0.0)), ((0.3, -0.3), (0.5, -0.1))]  # fmt: skip
    points = np.concatenate([np.linspace(a, b, round(800 * math.dist(a, b))) for a, b in lines])
    points += rng.normal(0.0, 0.01, points.shape)
    eyes = np.tile((-0.8, 0.4), (len(points), 1))
    walls = find_walls(points, eyes, [])
    long = sorted(walls, key=lambda w: -w.outline.length)[:4]
    assert sorted(abs(math.degrees(math.remainder(w.outline.yaw, math.pi))) for w in long) == pytest.approx(
        [0.0, lean, 90.0, 90.0], abs=0.3
    )
    leaning = min(long, key=lambda w: abs(abs(math.remainder(w.outline.yaw, math.pi)) - turn))
    # It is seen from one side: its face is in place, its other side is a guess.
    assert leaning.footprint.length == pytest.approx(top.length, abs=0.1)
    assert abs(top.to_local(*leaning.outline.to_map(0.0, 0.0))[1]) == pytest.approx(leaning.thickness / 2, abs=0.01)
    assert all(w.outline.length < 0.5 for w in walls if w not in long)


def test_what_is_left_of_a_wall_beside_an_opening_is_one_up_to_its_corner() -> None:
    """Of a jamb that reaches 24 cm into the room, some points at either end have no direction of their own."""
    rng = np.random.default_rng(5)
    ends, eyes = [], []
    for eye in ((-1.8, 0.9), (1.6, 1.1)):
        side = math.copysign(1.0, eye[0])
        along = np.tile(np.arange(0.0, 0.24, 0.03), 30)
        back = np.tile(np.arange(0.06, 2.5, 0.02), 30)
        ends += [np.column_stack([0 * along + side * 0.06, along]), np.column_stack([side * back, 0 * back])]
        eyes += [np.tile(eye, (len(along) + len(back), 1))]
    points = np.concatenate(ends)
    walls = find_walls(points + rng.normal(0.0, 0.01, points.shape), np.concatenate(eyes), [])
    (jamb,) = (wall for wall in walls if abs(wall.start[0] - wall.end[0]) < 0.05)
    assert jamb.thickness == pytest.approx(0.12, abs=0.02) and abs(jamb.start[0]) < 0.02
    low, high = (jamb.outline.y - jamb.outline.length / 2, jamb.outline.y + jamb.outline.length / 2)
    assert low < 0.06 and high == pytest.approx(0.22, abs=0.05)


def test_a_thin_wall_whose_sides_are_both_seen_from_along_it_is_one() -> None:
    """The end of a corridor's wall beside a door, which the rest of the corridor and a room show at grazing angles."""
    rng = np.random.default_rng(7)
    long, piece = np.tile(np.arange(0.0, 5.0, 0.05), 12), np.tile(np.arange(6.0, 7.0, 0.02), 20)
    faces = [(long, 0.06, (2.5, 1.0)), (long, -0.06, (2.5, -1.5)), (long, 1.5, (2.5, 1.0)),
             (piece, 0.06, (-2.0, 0.8)), (piece, -0.06, (3.0, -1.7))]  # fmt: skip
    points = np.concatenate([np.column_stack([x, np.full(len(x), y)]) for x, y, _ in faces])
    eyes = np.concatenate([np.tile(eye, (len(x), 1)) for x, _, eye in faces])
    walls = find_walls(points + rng.normal(0.0, 0.015, points.shape), eyes, [])
    (wall,) = (w for w in walls if w.start[0] > 5.5)
    assert wall.thickness == pytest.approx(0.12, abs=0.02)
    assert sorted((wall.start[0], wall.end[0])) == pytest.approx([6.06, 6.86], abs=0.1)


def test_the_rim_of_a_bin_is_no_shelf() -> None:
    rim = Surface(Rectangle(0.51, -0.27, 0.38, 0.37), 0.41, np.empty((0, 2)))
    hole = Rectangle(0.51, -0.27, 0.34, 0.34)
    assert is_rim(rim, [(hole, 0.40)])
    assert not is_rim(rim._replace(height=0.75), [(hole, 0.40)]) and not is_rim(rim, [(hole._replace(x=1.0), 0.40)])


@pytest.mark.parametrize(
    ("length", "width", "name"), [(0.4, 0.4, "cabinet"), (0.9, 0.35, "shelf"), (1.4, 0.6, "counter")]
)
def test_what_has_a_body_is_named_by_its_measures(length: float, width: float, name: str) -> None:
    """What the robot brings things to, a small thing with a body, was a "shelf"."""
    outline = Rectangle(0.0, 0.0, length, width)
    along = [(x, y, 0.4) for x in np.arange(-length / 2, length / 2 + 0.01, 0.02) for y in (-width / 2, width / 2)]
    grid = grid_of(np.array(along))
    grid.hits[grid.cells(np.array(along)[:, :2])] = 3
    assert kind_of_surface(Surface(outline, 0.6, np.empty((0, 2))), grid, ((0.0, 1.0), (0.0, -1.0)))[0] == name


@pytest.mark.parametrize(("length", "width"), [(0.42, 0.42), (0.9, 0.5), (1.6, 0.8)])
def test_what_stands_on_legs_is_a_table_however_short_its_sides(length: float, width: float) -> None:
    """The legs of a bedside table are half of its sides."""
    grid, legs = Grid((-3.0, -3.0), (3.0, 3.0)), []
    for i, j in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
        x, y = i * (length / 2 - 0.04), j * (width / 2 - 0.04)
        legs += [(x - i * a, y - j * b) for a in np.arange(0.0, 0.051, 0.01) for b in np.arange(0.0, 0.051, 0.01)]
    grid.hits[grid.cells(np.array(legs))] = 3
    outline = Rectangle(0.0, 0.0, length, width)
    assert kind_of_surface(Surface(outline, 0.6, np.empty((0, 2))), grid, ((0.0, 1.0), (1.0, 0.0)))[0] == "table"


def test_things_are_brought_to_a_table_and_not_to_the_sofa_before_it() -> None:
    def surface(name: str, x: float, depth: float = 0.0) -> Receptacle:
        return Receptacle(name=name, kind="counter", center=(x, 0.0, 0.4), size=(1.0, 0.6), depth=depth)

    sofa, table, behind, bin_ = (
        surface("sofa", 1.0),
        surface("table", 2.0),
        surface("bench", -1.5),
        surface("bin", 0.5, 0.4),
    )
    assert delivery_place([sofa, bin_, behind, table]) == "table"
    assert delivery_place([sofa, bin_]) == "sofa" and delivery_place([bin_]) == ""


def test_what_is_inside_or_below_a_surface_is_none() -> None:
    def surface(x: float, height: float, length: float) -> Surface:
        return Surface(Rectangle(x, 0.0, length, 0.6 * length), height, np.empty((0, 2)))

    bed, other = surface(0.0, 0.47, 2.0), surface(3.0, 0.4, 1.0)
    book, board = surface(0.2, 0.5, 0.3), surface(-0.3, 0.38, 1.5)
    assert without_nested([bed, board, other, book]) == [bed, other]
    assert without_nested([bed, surface(0.0, 1.2, 0.9)]) != [bed], "a shelf high above it"


def test_a_corner_behind_which_few_rays_have_passed_is_looked_round() -> None:
    grid = Grid((-3.0, -3.0), (3.0, 3.0))
    states = np.full(grid.shape, UNKNOWN, np.uint8)
    states[18:62, 18:60], states[20:60, 20:60] = OCCUPIED, FREE
    grid.passed[20:60, 20:100:2] = 1
    near = np.ones(grid.shape, bool)
    cells, places = interesting(grid, states, near)
    assert places > 0 and not cells[:, :60].any() and cells[20:60, 60].any()
    grid.passed[:] = 0
    assert interesting(grid, states, near)[0][30:50, 60].any(), "no wall is there either, only no ray has come so far"
    states[18:62, 60:62] = OCCUPIED
    assert not interesting(grid, states, near)[0].any(), "behind walls"


def test_a_wall_that_furniture_hides_from_the_lidar_parts_two_rooms() -> None:
    grid = Grid((-4.0, -2.0), (4.0, 2.0))
    states = np.full(grid.shape, FREE, np.uint8)
    walls = [Wall(start=(0.0, -2.0), end=(0.0, -1.2)), Wall(start=(-4.0, 2.0), end=(4.0, 2.0))]
    assert len(find_rooms(grid, states, walls)) == 1
    points = np.array([(x, y, 1.1) for x in (-0.02, 0.03) for y in np.arange(-1.2, 1.1, 0.02)])
    for _ in range(3):
        grid.add_picture(np.empty((0, 2)), points)
    assert len(find_rooms(grid, states, walls)) == 2


def test_a_room_has_the_floor_under_its_furniture() -> None:
    """Of 3 x 3 m, most of it a bed, behind which no floor is seen."""
    grid = Grid((-4.0, -4.0), (4.0, 4.0))
    states = np.full(grid.shape, UNKNOWN, np.uint8)
    for area, state in ((Rectangle(-1.5, 0.0, 3.0, 3.0), FREE), (Rectangle(0.35, 0.0, 0.7, 3.0), FREE),
                        (Rectangle(1.7, 0.0, 2.0, 3.0), OCCUPIED)):  # fmt: skip
        cells = grid.points(tuple(np.indices(grid.shape).reshape(2, -1)))  # type: ignore[arg-type]
        states[area.signed_distances(cells[:, 0], cells[:, 1]).reshape(grid.shape) < 0.0] = state
    ends = [((0.0, -1.5), (0.0, -0.5)), ((0.0, 0.5), (0.0, 1.5)), ((-3.0, 1.5), (3.0, 1.5))]
    rooms = find_rooms(grid, states, [Wall(start=a, end=b) for a, b in ends])
    assert [round(room.middle[0], 1) for room in rooms] == pytest.approx([-1.5, 1.4], abs=0.15)
    assert rooms[1].high[0] == pytest.approx(2.7, abs=0.1), "up to the far side of the bed"


@pytest.mark.parametrize(("width", "rooms"), [(1.4, 2), (2.4, 1)])
def test_a_corridor_that_opens_between_two_corners_is_a_room_and_a_wide_bay_is_none(width: float, rooms: int) -> None:
    """A room 5 m wide and 3 m deep, from whose side something 4 m long leads away."""
    grid, half = Grid((-6.0, -6.0), (6.0, 6.0)), width / 2
    cells = grid.points(tuple(np.indices(grid.shape).reshape(2, -1)))  # type: ignore[arg-type]
    parts = Rectangle(0.0, -1.5, 5.0, 3.0), Rectangle(0.0, 2.0, width, 4.0)
    inside = np.any([p.signed_distances(cells[:, 0], cells[:, 1]) < 0.0 for p in parts], axis=0).reshape(grid.shape)
    states = np.where(inside, FREE, UNKNOWN).astype(np.uint8)
    ends = [((-2.5, 0.0), (-half, 0.0)), ((half, 0.0), (2.5, 0.0)), ((-half, 0.0), (-half, 4.0)),
            ((half, 0.0), (half, 4.0)), ((-half, 4.0), (half, 4.0)), ((-2.5, -3.0), (2.5, -3.0)),
            ((-2.5, -3.0), (-2.5, 0.0)), ((2.5, -3.0), (2.5, 0.0))]  # fmt: skip
    assert len(find_rooms(grid, states, [Wall(start=a, end=b) for a, b in ends])) == rooms


def test_the_walls_of_rooms_on_both_sides_do_not_part_a_corridor() -> None:
    """Nor where beside the corner there is no more wall than the jamb of a door."""
    mouth = [((x, -4.0), (x, 0.0)) for x in (-0.7, 0.7)] + [((-3.0, 0.0), (-0.7, 0.0)), ((0.7, 0.0), (3.0, 0.0))]
    jambs = [((x, 0.0), (x, 0.3)) for x in (-0.7, 0.7)]
    assert {round(o.x, 6) for o in openings([Wall(start=a, end=b) for a, b in mouth])} == {0.0}
    assert openings([Wall(start=a, end=b) for a, b in [*mouth, *jambs]]) == []
