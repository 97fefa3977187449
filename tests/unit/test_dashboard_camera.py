"""Every visitor's camera: it opens on the robot and its room, and follows the robot unless told not to."""

from contextlib import nullcontext
from math import radians, tan
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from common.household import load_household
from services.dashboard.scene.follow_camera import FollowCamera, opening_view

APARTMENT = load_household("apartment")


def on_screen(point: tuple[float, float, float], eye: Any, target: Any, aspect: float) -> tuple[float, float]:
    """Where a point is in the view, from -1 to 1 to either side of its middle."""
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    way = np.array(point) - eye
    half = tan(radians(75.0) / 2) * (way @ forward)
    return float(way @ right / (half * aspect)), float(way @ np.cross(right, forward) / half)


@pytest.mark.parametrize("aspect", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("base", [(0.0, 0.0, 0.0), (5.0, -2.5, 1.0), (6.5, 4.0, 0.0), (-2.5, -3.0, 0.0)])
def test_the_robot_and_the_middle_of_its_room_are_in_the_view(base: Any, aspect: float) -> None:
    eye, target = opening_view(base, APARTMENT, radians(75.0), aspect)
    room = APARTMENT.room_at(base[0], base[1])
    assert room is not None
    middle = ((room.low[0] + room.high[0]) / 2, (room.low[1] + room.high[1]) / 2, 0.0)
    for point in ((base[0], base[1], 0.4), middle):
        assert max(map(abs, on_screen(point, eye, target, aspect))) < 0.8, point


def test_the_room_fills_the_view() -> None:
    eye, target = opening_view((0.0, 0.0, 0.0), APARTMENT)
    corners = [(x, y, 0.0) for x in (-3.0, 2.5) for y in (-3.5, 2.0)]
    across = [on_screen(corner, eye, target, 1.0)[0] for corner in corners]
    assert max(across) - min(across) > 1.6, "four fifths of the view's width or more"


class Visitor:
    """A visitor's camera as viser has it."""

    def __init__(self) -> None:
        self.camera = SimpleNamespace(
            update_timestamp=1.0, fov=radians(75.0), aspect=1.0, position=np.zeros(3), look_at=np.zeros(3)
        )

    def atomic(self) -> Any:
        return nullcontext()


def test_visitors_are_led_to_the_robot_and_along_with_it() -> None:
    clients: dict[int, Any] = {1: Visitor(), 2: Visitor()}
    clients[2].camera.update_timestamp = 0.0
    reset = SimpleNamespace(position=None, look_at=None)
    camera = FollowCamera(SimpleNamespace(get_clients=lambda: clients, initial_camera=reset), APARTMENT)  # type: ignore[arg-type]
    camera.step((0.0, 0.0, 0.0), follow=True)
    opened = clients[1].camera.position.copy()
    assert opened == pytest.approx(opening_view((0.0, 0.0, 0.0), APARTMENT)[0])
    assert not clients[2].camera.position.any(), "whose browser has not said where it looks from is left alone"
    camera.step((4.0, -1.0, 0.0), follow=True)
    assert clients[1].camera.position - opened == pytest.approx((4.0, -1.0, 0.0))
    assert reset.position == pytest.approx(opening_view((4.0, -1.0, 0.0), APARTMENT)[0])
    camera.step((1.0, 1.0, 0.0), follow=False)
    camera.step((1.0, 2.0, 0.0), follow=True)
    assert clients[1].camera.position - opened == pytest.approx((4.0, 0.0, 0.0)), "not what was missed meanwhile"
    del clients[1]
    camera.step((1.0, 2.0, 0.0), follow=True)
    clients[1] = Visitor()
    camera.step((1.0, 2.0, 0.0), follow=True)
    assert clients[1].camera.position == pytest.approx(opening_view((1.0, 2.0, 0.0), APARTMENT)[0])
