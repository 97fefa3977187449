"""Noise and a camera that sits a little off make no objects of the floor."""

import math

import msgspec
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from common.floor_plan import Box, Receptacle, Wall
from common.household import Household, load_household
from services.camera.sensor import StereoCamera
from services.perception.segments.segmentation import segments
from services.perception.views.view import View
from services.perception.views.visible_plan import Nearby

SCENE = load_household("minimal")
WIDTH, HEIGHT, FOCAL = 640, 480, 400.0
DOWN = np.array([[0.0, -0.62, 0.785], [-1.0, 0.0, 0.0], [0.0, -0.785, -0.62]])
PLACE = np.array([-0.5, -1.2, 1.3])


RUG = Box(name="rug", center=(PLACE[0] + 0.35, PLACE[1] + 1.1, 0.008), size=(0.5, 0.6, 0.016))


def floor(seed: int, box: float = 0.0, rugs: tuple[Box, ...] = (), ahead: float = 1.2, high: float = 0.0) -> View:
    """The floor, and `ahead` [m] on it a cube of `box` [m], or only so `high`, as a camera sees them that is off by its
    mount's error."""
    camera = StereoCamera(seed)
    turned = DOWN @ Rotation.from_rotvec(camera.turn).as_matrix()
    u, v = np.meshgrid((np.arange(WIDTH) + 0.5 - WIDTH / 2) / FOCAL, (np.arange(HEIGHT) + 0.5 - HEIGHT / 2) / FOCAL)
    rays = np.stack([u, v, np.ones_like(u)], axis=-1) @ turned.T
    depth = np.where(rays[..., 2] < -0.05, -PLACE[2] / np.minimum(rays[..., 2], -0.05), 0.0)
    for rug in rugs:
        top = (rug.top - PLACE[2]) / np.minimum(rays[..., 2], -0.05)
        at = rays[..., :2] * top[..., None] + PLACE[:2] - rug.center[:2]
        on_top = (np.abs(at) < np.array(rug.size[:2]) / 2).all(axis=-1)
        depth[on_top] = top[on_top]
    top = ((high or box) - PLACE[2]) / np.minimum(rays[..., 2], -0.05)
    on_top = np.abs(rays[..., :2] * top[..., None] - np.array([ahead, 0.0])).max(axis=-1) < box / 2
    depth[on_top] = top[on_top]
    taken = camera.expose(np.full((HEIGHT, WIDTH, 3), 120, np.uint8), depth, FOCAL, seed)
    measured = (taken.depth / 1000.0).astype(np.float32)
    return View(taken.rgb, measured, (FOCAL, FOCAL), (WIDTH / 2, HEIGHT / 2), PLACE, DOWN)


@pytest.mark.parametrize("seed", range(6))
def test_an_empty_floor_is_empty(seed: int) -> None:
    assert segments(floor(seed), SCENE, 3.5) == []


@pytest.mark.parametrize("ahead", [1.2, 2.3])
@pytest.mark.parametrize("seed", range(3))
def test_a_block_on_the_floor_is_one_object(seed: int, ahead: float) -> None:
    (found,) = segments(floor(seed, 0.06, ahead=ahead), SCENE, 3.5)
    assert found.surface.name == ""
    assert math.dist(found.points[:, :2].mean(axis=0), (PLACE[0] + ahead, PLACE[1])) < 0.03


@pytest.mark.parametrize("seed", range(3))
def test_what_lies_before_furniture_is_seen_whole(seed: int) -> None:
    front = PLACE[0] + 1.2 + 0.03 + 0.06
    plan = msgspec.structs.replace(SCENE, furniture=(Box("chest", (front + 0.2, PLACE[1], 0.4), (0.4, 1.0, 0.8)),))
    (found,) = segments(floor(seed, 0.06), plan, 3.5)
    assert np.ptp(found.points[:, 0]) > 0.05


@pytest.mark.parametrize("seed", range(3))
def test_a_rug_that_no_map_has_is_floor(seed: int) -> None:
    assert segments(floor(seed, rugs=(RUG,)), SCENE, 3.5) == []


@pytest.mark.parametrize("seed", range(3))
def test_what_stands_beside_a_flat_thing_is_seen(seed: int) -> None:
    """A board as wide as a rug is taken for one, and a part of what stands before it seemed to be on it."""
    board = Box(name="board", center=(PLACE[0] + 1.375, PLACE[1], 0.006), size=(0.26, 0.24, 0.012))
    (found,) = segments(floor(seed, 0.08, (board,)), SCENE, 3.5)
    assert math.dist(found.points[:, :2].mean(axis=0), (PLACE[0] + 1.2, PLACE[1])) < 0.03


@pytest.mark.parametrize("seed", range(3))
def test_what_stands_out_of_the_noise_in_part_does_not_go_on_in_the_rest(seed: int) -> None:
    """The rest of a thin thing, and the noise around it, are the floor's."""
    (found,) = segments(floor(seed, 0.22, ahead=2.35, high=0.023), SCENE, 3.5)
    assert math.dist(found.points[:, :2].mean(axis=0), (PLACE[0] + 2.35, PLACE[1])) < 0.08


@pytest.mark.parametrize("thick", [0.006, 0.012, 0.019])
@pytest.mark.parametrize("seed", range(2))
def test_what_stands_on_a_rug_is_seen_whether_the_map_has_it_or_not(seed: int, thick: float) -> None:
    """Its pixels were those of something as wide as furniture, or went on into the rug."""
    under = Box(name="rug", center=(PLACE[0] + 1.2, PLACE[1], thick / 2), size=(0.8, 0.9, thick))
    for home in (SCENE, msgspec.structs.replace(SCENE, furniture=(under,))):
        (found,) = segments(floor(seed, 0.08, (under,)), home, 3.5)
        assert math.dist(found.points[:, :2].mean(axis=0), (PLACE[0] + 1.2, PLACE[1])) < 0.03
        assert found.surface.height == pytest.approx(thick, abs=0.004) or thick < 0.008


def test_objects_are_looked_for_on_beds_and_seats_and_not_where_a_back_stands_on_them() -> None:
    near = Nearby(load_household("apartment"), 0.0, 1.0, 9.0)
    tops = {f.name: on_it for f, on_it in near.tops(1.1)}
    assert {"sofa seat", "bed"} <= set(tops)
    assert not {"wardrobe", "fridge"} & set(tops)
    assert any(box.contains(-2.84, 0.2) for box in tops["sofa seat"]), "the sofa's back"
    assert not any(box.contains(-2.3, 0.2) for box in tops["sofa seat"])


TOP, BACK = 0.72, 1.1
"""Height [m] of a table below the camera, and how far ahead [m] it ends at a wall."""


def table(
    seed: int, thick: float, level: int = 120, half: tuple[float, float] = (0.02, 0.09), ahead: float = 0.7
) -> View:
    """A table top before a brown wall, and on it a ruler of that thickness and `half` its extents [m], of `level` (of
    255) in brightness."""
    camera = StereoCamera(seed)
    turned = DOWN @ Rotation.from_rotvec(camera.turn).as_matrix()
    u, v = np.meshgrid((np.arange(WIDTH) + 0.5 - WIDTH / 2) / FOCAL, (np.arange(HEIGHT) + 0.5 - HEIGHT / 2) / FOCAL)
    rays = np.stack([u, v, np.ones_like(u)], axis=-1) @ turned.T
    down = np.minimum(rays[..., 2], -0.05)
    depth, rgb = (TOP - PLACE[2]) / down, np.full((HEIGHT, WIDTH, 3), level, np.uint8)
    on_top = (TOP + thick - PLACE[2]) / down
    ruler = (np.abs(rays[..., :2] * on_top[..., None] - (ahead, 0.0)) < half).all(axis=-1)
    depth[ruler], rgb[ruler] = on_top[ruler], (level, level // 3, level // 3)
    wall = np.where(rays[..., 0] > 0.05, BACK / np.maximum(rays[..., 0], 0.05), np.inf)
    rgb[wall < depth], depth = (level, level // 2, level // 4), np.minimum(depth, wall)
    taken = camera.expose(rgb, depth, FOCAL, seed)
    measured = (taken.depth / 1000.0).astype(np.float32)
    return View(taken.rgb, measured, (FOCAL, FOCAL), (WIDTH / 2, HEIGHT / 2), PLACE, DOWN)


def with_a_table() -> Household:
    top = Receptacle(name="table", kind="table", center=(PLACE[0] + 0.75, PLACE[1], TOP), size=(0.7, 1.2))
    x, y = PLACE[0] + BACK + 0.06, PLACE[1]
    wall = Wall(start=(x, y - 2.0), end=(x, y + 2.0))
    return msgspec.structs.replace(SCENE, receptacles=(top,), walls=(wall,))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("level", [120, 25])
def test_a_ruler_on_a_table_is_an_object_and_what_is_printed_there_is_none(seed: int, level: int) -> None:
    assert segments(table(seed, 0.0, level), with_a_table(), 3.5) == []
    if level == 120:
        (found,) = segments(table(seed, 0.005), with_a_table(), 3.5)
        assert np.ptp(found.points[:, 1]) == pytest.approx(0.18, abs=0.02)


@pytest.mark.parametrize("seed", range(3))
def test_a_book_that_touches_the_wall_is_an_object_and_the_foot_of_the_wall_is_none(seed: int) -> None:
    half = (0.08, 0.1)
    (found,) = segments(table(seed, 0.03, 90, half, BACK - half[0]), with_a_table(), 3.5)
    assert np.ptp(found.points[:, 1]) == pytest.approx(0.2, abs=0.02)
