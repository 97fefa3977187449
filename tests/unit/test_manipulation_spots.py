"""Where on a surface something can be put down."""

import math

import msgspec
import numpy as np
import pytest

from common import messages as m
from common.floor_plan import Wall
from common.geometry import Rectangle
from common.household import load_household
from services.manipulation.planning.planning_scene import ELSEWHERE, GAPS, HAND_ROOM, bin_spots, obstacles, spots

SCENE = load_household("apartment")
TABLE = SCENE.receptacle("kitchen table")
FORWARD = 0.1


def apple(x: float, y: float) -> m.WorldObject:
    assert TABLE is not None
    position = (TABLE.center[0] + x, TABLE.center[1] + y, TABLE.center[2] + 0.04)
    return m.WorldObject(label="apple", kind="apple", colour="red", position=position, size=(0.08, 0.08, 0.08))


@pytest.mark.parametrize("near", [False, True])
def test_spots_lie_on_the_surface_and_clear_of_what_stands_there(near: bool) -> None:
    assert TABLE is not None
    anchor = apple(0.1, 0.1)
    base = (TABLE.center[0] - TABLE.size[0] / 2 - 0.35, TABLE.center[1], 0.0)
    found = spots(TABLE, base, 0.08, [anchor], FORWARD, anchor if near else None)
    assert found
    for x, y in found:
        there = base[0] + x, base[1] + y
        apart = math.dist(there, anchor.position[:2])
        assert TABLE.contains(*there) and apart > 0.08 + 0.03
        assert not near or apart < 0.08 + max(GAPS) + 0.01


def test_between_what_stands_on_a_large_surface_the_spot_with_room_for_the_hand_comes_first() -> None:
    assert TABLE is not None
    desk = msgspec.structs.replace(TABLE, size=(0.8, 1.6), yaw=0.0)
    half = np.array([0.34, 0.74])
    nodes = [(u, v) for u in np.linspace(-half[0], half[0], 5) for v in np.linspace(-half[1], half[1], 7)]
    base = (desk.center[0] - 0.75, desk.center[1], 0.0)
    found = spots(desk, base, 0.08, [apple(u, v) for u, v in nodes], FORWARD)
    assert found, "whatever it is that things stand in rows"
    crowd = [apple(u, v) for u, v in nodes if v > 0]
    x, y = spots(desk, base, 0.08, crowd, FORWARD)[0]
    there = base[0] + x, base[1] + y
    assert min(math.dist(there, o.position[:2]) for o in crowd) > 0.08 + HAND_ROOM - 0.02
    first = spots(desk, base, 0.08, [], FORWARD)[:10]
    assert all(math.dist(a, b) > ELSEWHERE for a in first for b in first if a is not b), (
        "where one fails so do its like"
    )


def test_nothing_is_let_go_above_what_lies_in_the_bin() -> None:
    bin_ = SCENE.receptacle("recycling bin")
    assert bin_ is not None
    base = (bin_.center[0] - 0.7, bin_.center[1], 0.0)
    inside: list[m.WorldObject] = []
    for _ in range(4):
        x, y = bin_spots(bin_, base, inside, FORWARD)[0]
        there = (base[0] + x, base[1] + y, 0.1)
        assert bin_.contains(*there[:2], margin=-0.085 / 2)
        assert all(math.dist(there[:2], o.position[:2]) > 0.07 for o in inside)
        inside.append(msgspec.structs.replace(apple(0.0, 0.0), position=there))
    assert math.dist(inside[0].position[:2], bin_.center[:2]) < 1e-6


def test_the_end_of_a_wall_is_an_obstacle_as_far_as_it_closes_the_corner() -> None:
    wall = Wall(start=(0.5, -1.0), end=(0.5, 0.3), thickness=0.12)
    home = msgspec.structs.replace(SCENE, walls=(wall,), furniture=(), receptacles=())
    _, box = obstacles(home, (0.0, 0.5, -math.pi / 2), [])
    solid = Rectangle(*box.center[:2], *box.size[:2], box.yaw)
    assert solid.contains(0.5 - 0.36 + 0.005, 0.5) and not solid.contains(0.5 - 0.36 - 0.005, 0.5)
    assert solid.contains(0.2, 0.5) and np.isclose(box.size[2], wall.height)
