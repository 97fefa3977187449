"""The costmap's circles, its static map given by others, and what it forgets; distances worked out by hand."""

import itertools
import math
import zlib

import numpy as np
import pytest

from common import messages as m
from common.floor_plan import Place
from common.household import Household
from services.navigation.planning.costmap import Costmap

CELL = 0.25
LOW, HIGH = (1.0, -2.0), (3.5, 2.0)  # not square, and no corner at the origin
HERE = (2.075, 0.075, 0.0)  # the middle of a cell, as are the places below at multiples of a cell from it
EAST = np.radians(np.arange(360.0))


def costmap(lasting_after: float = math.inf) -> Costmap:
    home = Household(name="x", low=LOW, high=HIGH, home=Place(name="home", x=2, y=0))
    return Costmap(home, CELL, memory=30.0, lasting_after=lasting_after)


def occupancy(made: Costmap, taken: np.ndarray, shift: tuple[int, int] = (0, 0), cell: float = CELL) -> m.MapGrid:
    """A grid of `taken` cells that begins `shift` (rows, columns) after the costmap."""
    height, width = taken.shape
    x, y = made.origin[0] + shift[1] * CELL, made.origin[1] + shift[0] * CELL
    cells = zlib.compress(taken.astype(np.uint8).tobytes())
    return m.MapGrid(t=0.0, x=x, y=y, resolution=cell, width=width, height=height, cells=cells, odom=(0.0, 0.0, 0.0))


def see(made: Costmap, now: float, people: object = (), moving: object = (), **hits: float) -> None:
    ranges = np.full(360, 20.0)
    for name, reach in hits.items():
        ranges[int(name[1:])] = reach
    made.obstacles.see(HERE, EAST, ranges, 10.0, now, people, moving)  # type: ignore[arg-type]


def hand_made(grid: np.ndarray) -> np.ndarray:
    """Distance [m] of every cell's middle to the nearest taken one, beyond the grid all is taken."""
    padded = np.pad(grid, 1, constant_values=True)
    taken = np.argwhere(padded) - 1
    found = np.zeros(grid.shape)
    for cell in itertools.product(*map(range, grid.shape)):
        found[cell] = np.hypot(*(taken - cell).T).min() * CELL
    return found


# --- a static map that somebody else made
@pytest.mark.parametrize("shift", [(0, 0), (2, 1), (-2, -3), (-1, 2), (3, -2)])
@pytest.mark.parametrize("extra", [(-4, -3), (0, 0), (5, 6)])
def test_another_map_is_laid_where_it_is_and_all_beyond_it_is_taken(
    shift: tuple[int, int], extra: tuple[int, int]
) -> None:
    made = costmap()
    taken = np.zeros((made.shape[0] + extra[0], made.shape[1] + extra[1]), bool)
    taken[4, 3] = taken[6:8, 5] = True
    version = made.version
    made.replace(occupancy(made, taken, shift))
    whole = np.ones(made.shape, bool)
    expected = np.zeros(made.shape)
    distances = hand_made(part := taken[max(0, -shift[0]) :, max(0, -shift[1]) :][
        : made.shape[0] - max(0, shift[0]), : made.shape[1] - max(0, shift[1])
    ])  # fmt: skip
    at = (
        slice(max(0, shift[0]), max(0, shift[0]) + part.shape[0]),
        slice(max(0, shift[1]), max(0, shift[1]) + part.shape[1]),
    )
    whole[at], expected[at] = part, distances
    assert ((made.static_distance <= 0) == whole).all()
    assert np.allclose(made.static_distance, expected) and np.allclose(made.distance, expected)
    assert made.version == version + 1


def test_a_map_of_other_cells_is_refused() -> None:
    made = costmap()
    with pytest.raises(ValueError, match=r"cells of 0\.3 m, not 0\.25 m"):
        made.replace(occupancy(made, np.zeros(made.shape, bool), cell=0.3))
    made.replace(occupancy(made, np.zeros(made.shape, bool), cell=CELL + 1e-10))


def test_what_another_map_explains_is_no_longer_seen_besides() -> None:
    made = costmap()
    see(made, 1.0, d0=0.5, d90=1.0)
    wall, free = made.cell(2.575, 0.075), made.cell(2.075, 1.075)
    taken = np.zeros(made.shape, bool)
    taken[wall] = True
    made.replace(occupancy(made, taken))
    assert made.distance[wall] == made.distance[free] == 0.0
    made.replace(occupancy(made, np.zeros(made.shape, bool)))
    assert made.distance[wall] > 0.0, "the wall was taken for the map's and has gone with it"
    assert made.distance[free] == 0.0


def test_points_are_explained_to_the_limit_and_no_farther() -> None:
    made = costmap()
    made.static_distance[:] = 5.0
    made.static_distance[made.cell(1.6, 1.4)] = 0.1
    found = made.explains(np.array([(1.6, 1.4), (1.6, 1.6), (1.4, 1.4)]), 0.1)
    assert found.tolist() == [True, False, False]


def test_a_distance_of_ones_own_takes_the_place_of_the_plan_and_forgets() -> None:
    made = costmap()
    see(made, 1.0, d0=0.5)
    own = np.full(made.shape, 0.5)
    own[3, 4] = 0.0
    version = made.version
    made.confine(own)
    assert made.static_distance is own and np.argwhere(own <= 0).tolist() == [[3, 4]]
    assert made.distance is own and made.obstacles.empty and made.version == version + 1


# --- circles
def test_circles_of_different_sources_are_taken_until_others_are_told() -> None:
    made = costmap()
    made.place([(2.3, -0.4, 0.3)], of="bins")
    made.place([(1.6, 1.1, 0.2)], of="robots")
    assert made.version == 2
    for cell in itertools.product(*map(range, made.shape)):
        x, y = made.point(*cell)
        circles = (math.hypot(x - 2.3, y + 0.4) - 0.3, math.hypot(x - 1.6, y - 1.1) - 0.2)
        assert made.distance[cell] == pytest.approx(max(0.0, min(made.static_distance[cell], *circles)))
    made.place([], of="robots")
    assert made.version == 3 and made.clearance(1.6, 1.1) > 0.2


def test_a_circle_that_moves_by_less_than_a_cell_changes_nothing() -> None:
    made = costmap()
    made.place([(2.3, -0.4, 0.3)], of="robots")
    before = made.distance
    made.place([(2.3 + 0.9 * CELL, -0.4, 0.3)], of="robots")
    assert made.distance is before and made.version == 1
    made.place([(2.3 + CELL, -0.4, 0.3)], of="robots")
    assert made.version == 2
    made.place([(2.3 + CELL, -0.4, 0.3), (1.5, 0.0, 0.2)], of="robots")
    assert made.version == 3 and made.clearance(1.5, 0.0) == 0.0


def test_what_was_seen_in_a_circle_is_disowned() -> None:
    made = costmap()
    see(made, 1.0, d0=0.5, d90=1.0)
    version, clear = made.version, costmap()
    made.obstacles.disown([(9.0, 9.0, 0.3)])
    made.obstacles.disown([])
    assert made.version == version and made.clearance(2.575, 0.075) == 0.0
    made.obstacles.disown([(2.575, 0.075, 0.3)])
    assert made.version == version + 1
    assert made.clearance(2.575, 0.075) > 0.0 and made.clearance(2.075, 1.075) == 0.0
    made.obstacles.disown([(2.075, 1.075, 0.3)])
    assert np.allclose(made.distance, clear.distance) and made.obstacles.empty
    version = made.version
    made.obstacles.disown([(2.075, 1.075, 0.3)])
    assert made.version == version, "nothing was left there"


# --- forgetting
def test_after_forgetting_only_circles_and_the_plan_are_left() -> None:
    made = costmap()
    see(made, 1.0, d0=0.5)
    version = made.version
    made.obstacles.forget()
    assert made.distance is made.static_distance and made.version == version + 1
    see(made, 2.0, d0=0.5)
    made.place([(1.5, 0.0, 0.2)], of="robots")
    made.obstacles.forget()
    assert made.clearance(1.5, 0.0) == 0.0 and made.clearance(2.575, 0.075) > 0.0


def test_what_became_a_part_of_the_map_outlives_forgetting() -> None:
    made = costmap(lasting_after=5.0)
    spot = np.array(
        [(2.575, 0.075), (2.575, 0.075 + 2 * CELL), (2.575 + CELL, 0.075), (2.575 - CELL, 0.075 + CELL), (1.2, -1.5)]
    )
    assert not made.obstacles.lasting_at(spot).any()
    for now in np.arange(0.0, 12.0, 0.5):
        see(made, float(now), d0=0.5)
    assert made.obstacles.lasting_at(spot).tolist() == [True, False, True, True, False]
    version = made.version
    made.obstacles.forget()
    assert made.clearance(2.575, 0.075) == 0.0 and made.version == version + 2


@pytest.mark.parametrize("kind", ["people", "moving"])
def test_people_never_become_a_part_of_the_map_but_things_beside_them_do(kind: str) -> None:
    made = costmap(lasting_after=5.0)
    for now in np.arange(0.0, 12.0, 0.5):
        see(made, float(now), **{kind: [(2.575, 0.075, 0.3)]}, d0=0.5, d180=0.75)  # type: ignore[arg-type]
    assert made.obstacles.lasting_at(np.array([(2.575, 0.075), (1.325, 0.075)])).tolist() == [False, True]
    assert made.clearance(2.575, 0.075) == 0.0, "they are in the way all the same"
    assert made.distance_to_things()[made.cell(2.575, 0.075)] > 0.0
    assert made.distance_to_things()[made.cell(1.325, 0.075)] == 0.0


# --- lines
@pytest.mark.parametrize("end", [(1.3, -1.6), (3.2, 1.7), (1.3, 1.7), (3.2, -1.6), (2.2, 1.9)])
def test_a_line_meets_what_stands_anywhere_on_it(end: tuple[float, float]) -> None:
    for share in np.linspace(0.0, 1.0, 23):
        made = costmap()
        spot = tuple(a + share * (b - a) for a, b in zip(HERE[:2], end, strict=True))
        made.static_distance[made.cell(*spot)] = 0.0
        near = made.line_clearance(HERE[:2], end)
        assert near <= CELL * math.sqrt(2.0)
    free = np.full(made.shape, 7.0)
    assert made.line_clearance(HERE[:2], end, free) == 7.0
