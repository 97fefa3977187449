"""What is turned about an axis is told from its outline, whatever circle was fitted to it."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from common.geometry import Array
from common.messages.perception import ShapeFamily
from services.manipulation.grasps.evidence import believed
from services.manipulation.grasps.revolved import revolved
from services.manipulation.grasps.surface import surface
from services.manipulation.grasps.target import Target

HEIGHT, AT = 0.11, np.array([0.6, 0.1, 0.8])


def funnel(height: Array) -> Array:
    """Its mouth is below."""
    found: Array = np.where(height < 0.06, 0.056 - 0.75 * height, 0.011 - 0.06 * (height - 0.06))
    return found


def seen(radius: Callable[[Array], Array], shape: ShapeFamily, off: float, deep: float = 1.0) -> Target:
    """A standing body's front, `deep` times as deep as wide, whose axis is believed `off` [m] farther than it is."""
    rng = np.random.default_rng(3)
    height, turn = (a.ravel() for a in np.meshgrid(np.arange(0.002, HEIGHT, 0.005), np.radians(np.arange(92, 270, 8))))
    away = AT[:2] / np.linalg.norm(AT[:2])
    local = radius(height)[:, None] * np.stack([deep * np.cos(turn), np.sin(turn)], axis=1)
    plan = local @ np.array([away, (-away[1], away[0])]) - off * away
    points = np.column_stack([plan, height - HEIGHT / 2]) + rng.normal(0.0, 0.0007, (len(height), 3))
    x, y = AT[:2] + off * away
    wide = 2 * float(radius(height).max())
    return Target(
        "thing", "", (float(x), float(y), float(AT[2])), 0.4, (wide, wide, HEIGHT), shape=shape, points=points,
        measured=True, spread=0.002,
    )  # fmt: skip


@pytest.mark.parametrize("shape", ["round", "irregular"])
@pytest.mark.parametrize("off", [-0.012, 0.012])
def test_the_axis_of_a_funnel_is_that_of_its_spout_and_of_its_cone(shape: ShapeFamily, off: float) -> None:
    found = believed(seen(funnel, shape, off))
    assert found.shape == "round"
    assert np.hypot(*(np.array(found.position) - AT)[:2]) < 0.003
    spout = surface(found)[np.abs(surface(found)[:, 2] - AT[2] - 0.035) < 0.004]
    assert float(np.ptp(spout[:, 0])) == pytest.approx(0.02, abs=0.005), "it goes between the pads there"


def test_a_can_whose_axis_is_known_stays_as_it_was_measured() -> None:
    can = seen(lambda height: np.full(height.shape, 0.033), "round", 0.0)
    assert believed(can) is can


def test_what_has_an_arm_is_not_turned() -> None:
    arm = math.pi / 2 * np.ones(40)
    figure = seen(funnel, "irregular", 0.012)
    assert figure.points is not None
    away = AT[:2] / np.linalg.norm(AT[:2])
    out, up = np.linspace(0.02, 0.06, 40), np.linspace(-0.02, 0.05, 40)
    more = np.column_stack([np.outer(out * np.sin(arm), (-away[1], away[0])), up])
    assert revolved(replace(figure, points=np.concatenate([figure.points, more]))) is None


def test_a_flat_front_is_no_circle() -> None:
    board = seen(lambda height: 0.02 + 0.1 * height, "irregular", 0.0, deep=0.05)
    assert believed(board).shape != "round"
