"""Clicks in the 3-D view."""

import numpy as np
import pytest

from common import messages as m
from services.dashboard.scene.drawing import Mesh, draw
from services.dashboard.scene.picking import first_hit, pick

ROOM = (
    "<mujoco><worldbody><geom type='plane' size='6 5 .1'/>"
    "<geom type='box' size='.5 .5 .35' pos='2 0 .35'/></worldbody></mujoco>"
)
MUG = m.WorldObject(label="red mug", kind="mug", colour="red", position=(2.0, 0.0, 0.75), size=(0.08, 0.08, 0.1))
EYE = np.array([0.0, -3.0, 3.0])


@pytest.fixture(scope="module")
def flat() -> Mesh | None:
    return draw(ROOM).flat


def towards(x: float, y: float, z: float) -> np.ndarray:
    return np.array([x, y, z]) - EYE


def test_the_floor_is_a_place(flat: Mesh | None) -> None:
    picked = pick(EYE, towards(-1.0, 0.5, 0.0), flat, [MUG])
    assert picked.point == pytest.approx((-1.0, 0.5))
    assert not picked.label


def test_an_object_is_itself(flat: Mesh | None) -> None:
    assert pick(EYE, towards(2.0, 0.0, 0.75), flat, [MUG]).label == "red mug"


def test_furniture_is_nothing(flat: Mesh | None) -> None:
    picked = pick(EYE, towards(1.7, -0.4, 0.7), flat, [MUG])
    assert not picked.label
    assert picked.point is None


def test_an_object_behind_furniture_is_not_meant(flat: Mesh | None) -> None:
    hidden = m.WorldObject(label="hidden", kind="can", colour="red", position=(2.0, 0.8, 0.05), size=(0.05, 0.05, 0.1))
    assert pick(EYE, towards(2.0, 0.8, 0.05), flat, [hidden]).label == ""


def test_the_nearer_of_two_is_meant() -> None:
    toward = towards(2.0, 0.0, 0.75)
    behind = m.WorldObject(
        label="behind", kind="can", colour="red", position=tuple(EYE + 1.2 * toward), size=(0.1, 0.1, 0.1)
    )
    for order in ([MUG, behind], [behind, MUG]):
        assert pick(EYE, toward, None, order).label == "red mug"


def test_the_sky_is_nothing(flat: Mesh | None) -> None:
    picked = pick(EYE, np.array([0.0, 1.0, 0.5]), flat, [MUG])
    assert (picked.label, picked.point) == ("", None)


def test_without_a_model_the_ground_is_at_zero() -> None:
    assert pick(EYE, towards(1.0, 1.0, 0.0), None, []).point == pytest.approx((1.0, 1.0))


def test_first_hit_agrees_with_a_triangle_by_hand() -> None:
    mesh = Mesh(np.array([[0.0, 0, 1], [1, 0, 1], [0, 1, 1]]), np.array([[0, 1, 2]]), np.zeros((3, 3)))
    up = np.array([0.0, 0.0, 1.0])
    assert first_hit(np.array([0.2, 0.2, 0.0]), up, mesh) == pytest.approx(1.0)
    assert first_hit(np.array([0.8, 0.8, 0.0]), up, mesh) == np.inf
    assert first_hit(np.array([0.2, 0.2, 2.0]), up, mesh) == np.inf
