"""Believed objects framed in a camera's picture."""

import numpy as np
import pytest

from common import messages as m
from common.geometry import matrix_quat
from common.robot.pictures import PictureError
from services.dashboard.panels.cameras import boxes, marked

# A camera 1 m above the base's origin that looks along its x axis.
AHEAD = matrix_quat(np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]))


def image(depth: float) -> m.Rgbd:
    return m.Rgbd(
        t=1.0, id="a", camera="head", width=80, height=60, fx=60.0, fy=60.0, cx=40.0, cy=30.0,
        position=(0.0, 0.0, 1.0), orientation=AHEAD, rgb=bytes(80 * 60 * 3),
        depth=np.full((60, 80), round(depth * 1000), "<u2").tobytes(),
    )  # fmt: skip


def thing(x: float, y: float, z: float = 1.0) -> m.WorldObject:
    return m.WorldObject(label="cube", kind="block", colour="red", position=(x, y, z), size=(0.2, 0.2, 0.2))


def test_a_box_ahead_is_framed_where_the_lens_puts_it() -> None:
    ((label, (left, top, right, bottom)),) = boxes(image(2.0), (0.0, 0.0, 0.0), [thing(2.0, 0.0)])
    assert label == "cube"
    # Its near face is 1.9 m away: 0.1 / 1.9 * 60 pixels to each side.
    assert (left, right) == pytest.approx((40 - 3.158, 40 + 3.158), abs=0.01)
    assert (top, bottom) == pytest.approx((30 - 3.158, 30 + 3.158), abs=0.01)


def test_left_in_the_world_is_left_in_the_picture() -> None:
    ((_, left),) = boxes(image(2.0), (0.0, 0.0, 0.0), [thing(2.0, 0.5)])
    assert left[2] < 40


def test_the_base_may_stand_and_face_anywhere() -> None:
    base = (3.0, -1.0, np.pi / 2)
    ((_, frame),) = boxes(image(2.0), base, [thing(3.0, 1.0)])
    assert (frame[0] + frame[2]) / 2 == pytest.approx(40.0, abs=0.1)


@pytest.mark.parametrize(
    ("where", "depth"), [((-2.0, 0.0), 2.0), ((2.0, 5.0), 2.0), ((2.0, 0.0), 1.0), ((2.0, 0.0), 3.0)]
)
def test_behind_beside_hidden_or_gone_is_not_framed(where: tuple[float, float], depth: float) -> None:
    assert boxes(image(depth), (0.0, 0.0, 0.0), [thing(*where)]) == []


def test_a_frame_is_drawn() -> None:
    plain = marked(image(2.0), (0.0, 0.0, 0.0), [])
    framed = marked(image(2.0), (0.0, 0.0, 0.0), [thing(2.0, 0.0)])
    assert plain is not None and framed is not None
    assert not plain.any()
    assert framed[30, 36:38].any() and not framed[30, 40].any()


def test_a_picture_of_another_size_than_it_says_is_refused() -> None:
    broken = image(2.0)
    broken.rgb = broken.rgb[:-1]
    with pytest.raises(PictureError):
        marked(broken, (0.0, 0.0, 0.0), [])
