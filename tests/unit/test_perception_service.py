"""What the perception makes of pictures that are none, or not its own."""

import pytest

from common import messages as m
from common import topics
from common.household import load_household
from services.perception.config import PerceptionConfig
from services.perception.service import PerceptionService
from tests.node import Node


class Eyes(Node):
    """The service, where it knows its pose and has asked for a picture."""

    def __init__(self) -> None:
        super().__init__(PerceptionService, PerceptionConfig(), load_household("minimal"))
        self.until(lambda: self.count(topics.CAMERA_REQUEST))
        self.asked = self.sent(topics.CAMERA_REQUEST)[-1]

    def feed(self) -> None:
        self.send(topics.POSE, m.PoseEstimate(t=self.now, x=0.0, y=0.0, theta=0.0))

    def show(self, picture_id: str, camera: str, pixels: int) -> None:
        image = m.Rgbd(
            t=self.now, id=picture_id, camera=camera, width=4, height=3, fx=4.0, fy=4.0, cx=2.0, cy=1.5,
            position=(0.0, 0.0, 1.0), orientation=(1.0, 0.0, 0.0, 0.0), rgb=bytes(3 * pixels), depth=bytes(2 * pixels),
        )  # fmt: skip
        self.bus.send(topics.HEAD_RGBD, image)
        self.step()


@pytest.mark.parametrize("camera", ["head", "../../etc/passwd"])
def test_a_picture_without_its_pixels_is_counted_whoever_it_says_took_it(camera: str) -> None:
    node = Eyes()
    node.show(node.asked.id, camera, pixels=7)
    assert node.io.drops[topics.HEAD_RGBD.key] == 1


def test_a_picture_that_nobody_asked_for_is_not_looked_at() -> None:
    node = Eyes()
    node.show(node.asked.id, "head", pixels=7)
    node.show("", "head", pixels=7)
    assert node.io.drops[topics.HEAD_RGBD.key] == 1
