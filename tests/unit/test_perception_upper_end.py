"""What the upper end of a vessel is seen to be, whatever shape it was measured as."""

from dataclasses import replace

import numpy as np
import pytest

from common.messages import End
from services.perception.shapes.measurement import Measurement
from services.perception.unlisted import describe, end_above, noise_of
from tests.unit.test_perception_separate import FLOOR, picture
from tests.unit.test_perception_unlisted import MUG, RED, seen, sighting

R, HIGH, X = 0.034, 0.09, 1.0
BLACK = (14, 14, 15)


@pytest.mark.parametrize(("lid", "expected"), [("closed", "closed"), ("deep", "open"), ("dark", "")])
def test_what_is_seen_through_the_end_tells_and_no_depth_tells_nothing(lid: str, expected: End) -> None:
    view, segment = picture([(X, 0.0, R, HIGH, BLACK)])
    inner = (segment.points[:, 2] > FLOOR + HIGH - 0.01) & (
        np.hypot(segment.points[:, 0] - X, segment.points[:, 1]) < R
    )
    if lid == "deep":
        rays = segment.points[inner] - view.position
        segment.points[inner] += rays / rays[:, 2:] * -0.05
    elif lid == "dark":
        segment = replace(segment, points=segment.points[~inner])
    assert end_above(view, segment, (X, 0.0), R, HIGH) == expected
    box = Measurement("box", X, 0.0, 0.0, (2 * R, 2 * R, HIGH), 0.002, 0.004)
    assert describe(view, segment, box).end == expected


def test_the_end_of_what_rests_otherwise_now_is_seen_anew() -> None:
    stands, lies = replace(sighting(4.0, -3.0, MUG, RED), end="open"), sighting(4.0, -3.0, MUG, RED)
    assert [o.top for o in seen([stands])[1]] == ["open"]
    lies = replace(lies, tilt=np.pi / 2, size=(0.1, 0.07, 0.07), end="open")
    assert [o.top for o in seen([stands], [replace(lies, end="", yaw_seen=False)])[1]] == [""]
    assert [o.top for o in seen([lies], [lies])[1]] == ["open"]
    tracker, _ = seen([stands])
    tracker.carry((4.0, -3.0, 0.81), True, 1.0)
    tracker.carry((4.0, -3.0, 0.81), False, 2.0)
    assert [o.top for o in tracker.objects()] == [""]


def test_past_the_ridge_of_a_carton_one_looks_and_it_is_no_opening() -> None:
    ridge = replace(sighting(4.0, -3.0, {"carton": 1.0}, RED), shape="box", end="open")
    tracker, _ = seen(*[[ridge]] * 4)
    assert not tracker._tracks[0].looks.opening


def test_the_depth_of_what_is_dark_is_noisier() -> None:
    dark, bright = (noise_of(*picture([(X, 0.0, R, HIGH, colour)])) for colour in (BLACK, (190, 30, 30)))
    assert dark == pytest.approx(2 * bright, rel=0.1)
