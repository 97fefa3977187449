"""What an exact pose rests on: receptacles, the floor, and the tops of furniture."""

import msgspec
import pytest

from common.floor_plan import Box
from common.scene import load_scene
from common.support import support

BATH = Box(name="bath", center=(0.0, -1.2, 0.29), size=(1.6, 0.7, 0.58), yaw=0.3)
RUG = Box(name="rug", center=(0.0, -1.2, 0.005), size=(2.0, 1.5, 0.01))
HOME = msgspec.structs.replace(load_scene("apartment"), furniture=(BATH, RUG), receptacles=(), walls=())


@pytest.mark.parametrize(
    ("bottom", "x", "name"),
    [(0.581, 0.0, "bath"), (0.60, 0.0, "bath"), (0.70, 0.0, ""), (0.581, 1.5, ""), (0.01, 0.9, "floor")],
)
def test_the_top_of_furniture_carries_things_and_a_rug_is_floor(bottom: float, x: float, name: str) -> None:
    assert support(HOME, x, -1.2, bottom) == name


def test_a_receptacle_comes_before_the_furniture_that_it_is_made_of() -> None:
    scene = load_scene("apartment")
    table = next(r for r in scene.receptacles if r.kind == "table")
    x, y, z = table.center
    board = Box(name="board", center=(x, y, z - 0.01), size=(*table.size, 0.02), yaw=table.yaw)
    assert support(msgspec.structs.replace(scene, furniture=(board,)), x, y, z) == table.name
