"""What hangs in the air is a part of what carries it, whatever its colour."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
from numpy.typing import NDArray

from common.geometry import Array
from services.perception.segments import separate
from services.perception.segments.air import hangs
from services.perception.segments.segment import Segment, Surface
from services.perception.segments.separate import pieces
from services.perception.shapes.measurement import Measurement
from services.perception.unlisted import measured
from services.perception.views.view import View

FLOOR, FOCAL, SIDE = 0.72, 400.0, 240
EYE = np.array([0.0, 0.0, 1.35])
Block = tuple[tuple[float, float, float], tuple[float, float, float], tuple[int, int, int]]
"""Lowest and highest corner [m], the height over the floor, and the colour of a block."""
Ball = tuple[tuple[float, float, float], float, tuple[int, int, int]]
"""Where a ball touches the table, its radius [m], and its colour."""
RED, GREEN = (190, 30, 30), (30, 150, 50)


def picture(blocks: list[Block], balls: Sequence[Ball] = ()) -> tuple[View, list[Array]]:
    """Blocks and balls on a table, cast by rays with the noise of a bought camera, and the pixels of each as a mask."""
    pitch = 0.6
    ahead, right = np.array([math.cos(pitch), 0.0, -math.sin(pitch)]), np.array([0.0, -1.0, 0.0])
    rotation = np.stack([right, np.cross(ahead, right), ahead], axis=1)
    u, v = np.meshgrid(np.arange(SIDE) + 0.5 - SIDE / 2, np.arange(SIDE) + 0.5 - SIDE / 2)
    rays = np.stack([u / FOCAL, v / FOCAL, np.ones_like(u)], -1) @ rotation.T
    depth, rgb = (FLOOR - EYE[2]) / rays[..., 2], np.full((SIDE, SIDE, 3), 120, np.uint8)
    owner = np.full((SIDE, SIDE), -1)
    for n, (low, high, colour) in enumerate(blocks):
        up = np.array([0.0, 0.0, FLOOR])
        first, second = ((np.array(corner) + up - EYE) / rays for corner in (low, high))
        enters, leaves = np.minimum(first, second).max(axis=-1), np.maximum(first, second).min(axis=-1)
        hit = (enters < leaves) & (enters < depth)
        depth[hit], rgb[hit], owner[hit] = enters[hit], colour, n
    for n, (at, radius, colour) in enumerate(balls, start=len(blocks)):
        to = np.add(at, (0.0, 0.0, FLOOR + radius)) - EYE
        square, along = (rays**2).sum(axis=-1), rays @ to
        with np.errstate(invalid="ignore"):
            near = (along - np.sqrt(along**2 - square * (to @ to - radius**2))) / square
        hit = near < depth
        depth[hit], rgb[hit], owner[hit] = near[hit], colour, n
    depth *= 1 + np.random.default_rng(1).normal(0.0, 0.0015, depth.shape)
    view = View(rgb, depth.astype(np.float32), (FOCAL, FOCAL), (SIDE / 2, SIDE / 2), EYE, rotation)
    return view, [owner == n for n in range(len(blocks) + len(balls))]


BODY: Block = ((0.95, -0.03, 0.0), (1.01, 0.03, 0.09), RED)
SPOUT: Block = ((0.97, 0.03, 0.04), (0.99, 0.10, 0.055), GREEN)
BESIDE: Block = ((0.96, 0.032, 0.0), (1.0, 0.09, 0.06), GREEN)
BEHIND: Block = ((1.02, -0.03, 0.0), (1.08, 0.03, 0.16), GREEN)


@pytest.mark.parametrize(
    ("other", "expected"), [(SPOUT, True), (BESIDE, False), (BEHIND, False)], ids=["spout", "beside", "half hidden"]
)
def test_only_what_one_looks_through_under_hangs(other: Block, expected: bool) -> None:
    view, (body, part) = picture([BODY, other])
    assert hangs(view, view.points[part].astype(np.float64), FLOOR) is expected
    assert not hangs(view, view.points[body].astype(np.float64), FLOOR)


@pytest.mark.parametrize(("other", "count"), [(SPOUT, 1), (BESIDE, 2)], ids=["spout", "beside"])
def test_a_spout_of_another_colour_is_no_object(other: Block, count: int) -> None:
    view, masks = picture([BODY, other])
    rows, columns = np.nonzero(np.logical_or(*masks))
    points = view.points[rows, columns].astype(np.float64)
    assert len(pieces(view, Segment(Surface("table", FLOOR), rows, columns, points, False, (True, True)))) == count


def test_what_a_handle_makes_wider_than_any_object_is_one_with_it() -> None:
    pan: Block = ((0.9, -0.16, 0.0), (1.06, 0.02, 0.05), RED)
    handle: Block = ((0.965, 0.02, 0.028), (0.985, 0.2, 0.046), GREEN)
    beside: Block = ((0.94, 0.022, 0.0), (0.985, 0.2, 0.046), GREEN)
    for other, count in ((handle, 1), (beside, 2)):
        view, masks = picture([pan, other])
        rows, columns = np.nonzero(np.logical_or(*masks))
        points = view.points[rows, columns].astype(np.float64)
        found = pieces(view, Segment(Surface("table", FLOOR), rows, columns, points, False, (True, True)))
        assert len(found) == count


def test_a_ball_behind_a_block_is_told_apart_though_one_looks_under_it() -> None:
    view, (block, ball) = picture([((0.92, -0.03, 0.0), (0.98, 0.03, 0.059), RED)], [((1.02, 0.04, 0.0), 0.035, GREEN)])
    assert hangs(view, view.points[ball].astype(np.float64), FLOOR)
    rows, columns = np.nonzero(block | ball)
    points = view.points[rows, columns].astype(np.float64)
    found = pieces(view, Segment(Surface("table", FLOOR), rows, columns, points, False, (True, True)))
    assert {p.shape.family for p in found} == {"box", "ball"}


def test_what_stands_on_another_part_is_no_object() -> None:
    candle: Block = ((0.97, -0.01, 0.06), (0.99, 0.01, 0.16), GREEN)
    view, masks = picture([((0.94, -0.04, 0.0), (1.02, 0.04, 0.06), RED), candle])
    rows, columns = np.nonzero(np.logical_or(*masks))
    points = view.points[rows, columns].astype(np.float64)
    assert len(pieces(view, Segment(Surface("table", FLOOR), rows, columns, points, False, (True, True)))) == 1


def test_what_is_in_the_corner_of_others_does_not_stand_on_them() -> None:
    corner: list[Block] = [((0.92, -0.09, 0.0), (0.97, 0.005, 0.06), RED), ((0.96, 0.0, 0.0), (1.1, 0.06, 0.07), RED)]
    view, masks = picture([*corner, ((0.99, -0.06, 0.0), (1.035, -0.012, 0.14), GREEN)])
    rows, columns = np.nonzero(np.logical_or.reduce(masks))
    points = view.points[rows, columns].astype(np.float64)
    found = pieces(view, Segment(Surface("table", FLOOR), rows, columns, points, False, (True, True)))
    assert [p.shape.family for p in found if view.rgb[p.segment.rows[0], p.segment.columns[0]][1] == GREEN[1]] == [
        "box"
    ]


def test_a_spout_is_told_apart_from_the_body_where_the_shape_is_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    view, (body, spout) = picture([BODY, SPOUT])
    rows, columns = np.nonzero(body | spout)
    told: list[NDArray[np.bool_]] = []

    def recorded(view: View, segment: Segment, hanging: NDArray[np.bool_] | None = None) -> Measurement:
        told.extend([] if hanging is None else [hanging])
        return measured(view, segment, hanging)

    monkeypatch.setattr(separate, "measured", recorded)
    points = view.points[rows, columns].astype(np.float64)
    separate.pieces(view, Segment(Surface("table", FLOOR), rows, columns, points, False, (True, True)))
    assert any(np.mean(hanging == spout[rows, columns]) > 0.95 for hanging in told)
