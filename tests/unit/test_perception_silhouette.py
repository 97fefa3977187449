"""An object without any depth is found and measured by its outline and by where that touches the surface."""

import math
from collections.abc import Callable
from dataclasses import replace

import msgspec
import numpy as np
import pytest
from numpy.typing import NDArray

from common.floor_plan import Box, Receptacle
from common.geometry import Array
from common.scene import load_scene
from services.perception.segments import dark, segmentation
from services.perception.segments.outlined import on_surface, with_parts
from services.perception.segments.segment import Segment, Surface
from services.perception.shapes import silhouette
from services.perception.shapes.measurement import LEVEL, Measurement
from services.perception.unlisted import measured
from services.perception.views.view import View
from services.perception.views.visible_plan import Cloud

FLOOR, FOCAL, WIDTH, HEIGHT = 0.7, 450.0, 200, 140
EYE = np.array([0.0, 0.0, 1.3])
AT = (0.85, 0.03)
Solid = Callable[[Array], NDArray[np.bool_]]


def cylinder(r: float, h: float, lean: float = 0.0) -> Solid:
    """A turned body whose radius grows by `lean` over its height, its foot `r`."""

    def inside(p: Array) -> NDArray[np.bool_]:
        z = p[..., 2] - FLOOR
        return (np.hypot(p[..., 0] - AT[0], p[..., 1] - AT[1]) < r + lean * z / h) & (z > 0) & (z < h)

    return inside


def box(length: float, width: float, h: float, yaw: float) -> Solid:
    def inside(p: Array) -> NDArray[np.bool_]:
        dx, dy, z = p[..., 0] - AT[0], p[..., 1] - AT[1], p[..., 2] - FLOOR
        u, v = math.cos(yaw) * dx + math.sin(yaw) * dy, math.cos(yaw) * dy - math.sin(yaw) * dx
        return (np.abs(u) < length / 2) & (np.abs(v) < width / 2) & (z > 0) & (z < h)

    return inside


def laid(r: float, length: float, yaw: float) -> Solid:
    def inside(p: Array) -> NDArray[np.bool_]:
        dx, dy, z = p[..., 0] - AT[0], p[..., 1] - AT[1], p[..., 2] - FLOOR
        u, v = math.cos(yaw) * dx + math.sin(yaw) * dy, math.cos(yaw) * dy - math.sin(yaw) * dx
        return (np.abs(u) < length / 2) & (np.hypot(v, z - r) < r)

    return inside


def handled(body: Solid, r: float, h: float) -> Solid:
    """The body and a ring of 9 mm beside it, towards +y."""

    def inside(p: Array) -> NDArray[np.bool_]:
        y, z = p[..., 1] - AT[1] - r, p[..., 2] - FLOOR - h / 2
        ring = np.abs(np.hypot(y, z) - 0.024) < 0.0045
        return body(p) | (ring & (y > 0) & (np.abs(p[..., 0] - AT[0]) < 0.0045))

    return inside


def seen(solid: Solid, beside: bool = False, lit: float = math.inf, colour: int = 8) -> View:
    """A black thing on a table of which only the table has depth; `beside`: something nearer stands before it; `lit`:
    height [m] from which it has depth itself, and this `colour`."""
    ahead = np.array([AT[0], AT[1], FLOOR + 0.05]) - EYE
    ahead /= np.linalg.norm(ahead)
    right = np.cross(ahead, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    rotation = np.stack([right, np.cross(ahead, right), ahead], axis=1)
    v, u = np.mgrid[:HEIGHT, :WIDTH]
    local = np.stack([(u + 0.5 - WIDTH / 2) / FOCAL, (v + 0.5 - HEIGHT / 2) / FOCAL, np.ones(u.shape)], axis=-1)
    rays = local @ rotation.T
    depth = (FLOOR - EYE[2]) / np.minimum(rays[..., 2], -1e-3)
    black = np.zeros(u.shape, bool)
    for far in np.arange(0.85, 1.2, 0.004):
        hit = solid(EYE + rays * far) & (far < depth) & ~black
        black |= hit
        depth[hit] = np.where(EYE[2] + rays[hit, 2] * far > FLOOR + lit, far, 0.0)
    if beside:
        column = int(np.nonzero(black.any(axis=0))[0].mean())
        depth[:, column:] = 0.5
    rgb = np.where((black & (depth != 0.5))[..., None], np.uint8(8), np.uint8(150)).repeat(3, axis=-1)
    rgb[black & (depth > 0) & (depth != 0.5)] = colour
    return View(rgb, depth.astype(np.float32), (FOCAL, FOCAL), (WIDTH / 2, HEIGHT / 2), EYE, rotation)


def found(view: View, level: float = FLOOR) -> list[Measurement]:
    blobs = dark.blobs(view)
    assert blobs is not None
    known = np.flatnonzero(view.depth > 0)
    x, y, z = view.points.reshape(-1, 3)[known].T
    plane = np.array([0.0, 0.0, level])
    segments = on_surface(view, "table", plane, Cloud(known, x, y, z), np.zeros(view.shape, bool), blobs)
    return [s.shape for s in segments if s.shape is not None]


@pytest.mark.parametrize(
    ("solid", "families", "size"),
    [
        (cylinder(0.036, 0.12), ("round",), (0.072, 0.072, 0.12)),
        (cylinder(0.035, 0.06, 0.04), ("bowl",), (0.15, 0.15, 0.06)),
        (box(0.13, 0.06, 0.17, 0.6), ("box",), (0.13, 0.06, 0.17)),
        (box(0.13, 0.06, 0.17, 2.2), ("box",), (0.13, 0.06, 0.17)),
        (laid(0.033, 0.14, 1.2), ("round",), (0.14, 0.066, 0.066)),
    ],
)
def test_its_outline_tells_shape_size_and_place(
    solid: Solid, families: tuple[str, ...], size: tuple[float, float, float]
) -> None:
    (shape,) = found(seen(solid))
    assert shape.family in families
    assert shape.size == pytest.approx(size, abs=0.006)
    assert (shape.x, shape.y) == pytest.approx(AT, abs=0.006)
    assert shape.tilt == (LEVEL if size[0] == 0.14 else 0.0)


@pytest.mark.parametrize(("side", "high", "yaw"), [(0.055, 0.055, 0.0), (0.05, 0.08, 0.12)])
def test_a_lit_upper_face_tells_a_block_from_what_is_lower_and_deeper(side: float, high: float, yaw: float) -> None:
    (shape,) = found(seen(box(side, side, high, yaw), lit=high - 0.005))
    assert shape.family == "box"
    assert shape.size == pytest.approx((side, side, high), abs=0.009)


def test_what_is_wider_than_its_dark_foot_stands_where_its_lit_part_is() -> None:
    foot, stem, cup, handles = (
        cylinder(0.034, 0.035), cylinder(0.012, 0.18), cylinder(0.046, 0.18), box(0.016, 0.2, 0.14, 0.0),
    )  # fmt: skip
    view = seen(lambda p: foot(p) | stem(p) | (cup(p) | handles(p)) & (p[..., 2] > FLOOR + 0.09), lit=0.035, colour=220)
    blobs, known = dark.blobs(view), np.flatnonzero(view.depth > 0)
    x, y, z = view.points.reshape(-1, 3)[known].T
    plane, nobody = np.array([0.0, 0.0, FLOOR]), np.zeros(view.shape, bool)
    assert blobs is not None
    (one,) = on_surface(view, "table", plane, Cloud(known, x, y, z), nobody, blobs)
    rows, columns = np.nonzero(view.rgb[..., 0] == 220)
    lit = Segment(one.surface, rows, columns, view.points[rows, columns].astype(np.float64), False, (True, True))
    whole = with_parts(view, replace(one, points=np.array([[*AT, FLOOR + 0.02]])), [lit])
    assert whole.shape is None and len(whole.dark) and len(whole.points) == len(whole.rows)
    shape = measured(view, whole)
    assert (shape.x, shape.y) == pytest.approx(AT, abs=0.015) and shape.size[2] == pytest.approx(0.18, abs=0.01)


def test_a_handle_is_beside_the_body_and_no_part_of_it() -> None:
    (shape,) = found(seen(handled(cylinder(0.038, 0.1), 0.038, 0.1)))
    assert shape.size == pytest.approx((0.076, 0.076, 0.1), abs=0.006)
    assert shape.handle == pytest.approx(math.pi / 2, abs=0.4)


def test_a_glass_on_a_stem_stands_where_its_foot_is() -> None:
    cup, stem, foot = cylinder(0.038, 0.17), cylinder(0.006, 0.17), cylinder(0.034, 0.006)
    (shape,) = found(seen(lambda p: cup(p) & (p[..., 2] > FLOOR + 0.09) | stem(p) | foot(p)))
    assert (shape.x, shape.y) == pytest.approx(AT, abs=0.012)
    assert shape.size == pytest.approx((0.076, 0.076, 0.17), abs=0.012)


@pytest.mark.parametrize("wide", [0.4, 1.1], ids=["a part of its foot", "its whole foot"])
def test_what_hides_a_part_of_an_outline_leaves_the_rest_of_it(wide: float) -> None:
    view = seen(cylinder(0.036, 0.12))
    rows, columns = np.nonzero(view.depth == 0)
    top, left = int(np.quantile(rows, 0.8)), int(columns.max() - wide * np.ptp(columns))
    depth, rgb = view.depth.copy(), view.rgb.copy()
    depth[top:, left:], rgb[top:, left:] = 0.6, 150
    shapes = found(replace(view, depth=depth, rgb=rgb))
    assert len(shapes) == (wide < 1.0)
    for shape in shapes:
        assert (shape.x, shape.y) == pytest.approx(AT, abs=0.012)
        assert shape.size == pytest.approx((0.072, 0.072, 0.12), abs=0.012)


def test_what_is_no_whole_object_on_the_surface_is_left_alone() -> None:
    assert not found(seen(cylinder(0.036, 0.12), beside=True)), "half of it is hidden"
    assert not found(seen(cylinder(0.036, 0.12)), level=FLOOR + 0.05), "it stands on something lower"
    assert not found(seen(box(0.4, 0.05, 0.1, 1.5))), "it is as wide as furniture"


def test_an_outline_of_no_simple_shape_is_not_explained() -> None:
    post, arm = box(0.03, 0.03, 0.16, 0.0), box(0.03, 0.13, 0.03, 0.0)
    view = seen(lambda p: post(p) | arm(p))
    pixels = np.nonzero(view.depth == 0)
    at = silhouette.foot(view, pixels, FLOOR)
    assert at is not None
    assert silhouette.shape(view, silhouette.outline(view, pixels, at), at, FLOOR, np.empty((0, 3))) is None


@pytest.mark.parametrize("front", [0.6, 0.95])
def test_what_has_no_depth_at_all_is_of_the_surface_that_it_stands_on(front: float) -> None:
    depth = 0.6
    table = Receptacle("table", "table", (front + depth / 2, 0.0, FLOOR), (depth, 1.4), approach=((-1.0, 0.0),))
    plan = msgspec.structs.replace(load_scene("apartment"), receptacles=(table,), furniture=(), walls=())
    on_it = [s for s in segmentation.segments(seen(box(0.13, 0.06, 0.17, 0.6)), plan, 3.5) if s.surface.name]
    assert [s.surface.name for s in on_it] == (["table"] if front < AT[0] else [])
    assert all(not len(s.points) for s in on_it)


@pytest.mark.parametrize("chair", [False, True])
def test_what_has_no_depth_at_all_is_found_on_the_floor_and_is_no_part_of_furniture(chair: bool) -> None:
    view = seen(box(0.13, 0.06, 0.17, 0.6))
    low = View(view.rgb, view.depth, view.focal, view.middle, EYE - (0.0, 0.0, FLOOR), view.rotation)
    furniture = (Box("chair", (AT[0], AT[1], 0.4), (0.4, 0.4, 0.8)),) if chair else ()
    plan = msgspec.structs.replace(load_scene("apartment"), receptacles=(), furniture=furniture, walls=())
    found = segmentation.segments(low, plan, 3.5)
    assert [s.surface for s in found] == ([] if chair else [Surface("", 0.0)])
