"""What the perception makes of pictures that are none, or not its own."""

import msgspec
import pytest

from common import messages as m
from common import topics
from common.memory import MemoryBus, MemoryIo
from common.scene import load_scene
from services.perception.config import PerceptionConfig
from services.perception.service import PerceptionService


class Node:
    """The service on a memory bus, where it knows its pose and has asked for a picture."""

    def __init__(self) -> None:
        self.bus = MemoryBus()
        reads, writes = PerceptionService.READS, PerceptionService.WRITES
        self.io = MemoryIo(self.bus, "perception", reads, writes, scene=load_scene("minimal"))
        self.service = PerceptionService(PerceptionConfig(), self.io)
        self.tick = 0
        asked = self.bus.tap(topics.CAMERA_REQUEST)
        while not asked:
            self.step()
        self.asked = msgspec.json.decode(asked[-1], type=m.CameraRequest)

    def step(self) -> None:
        self.tick += 10
        now = self.tick * 0.01
        self.bus.send(topics.POSE, m.PoseEstimate(t=now, x=0.0, y=0.0, theta=0.0))
        self.io.clock.advance(now - self.io.clock.now())  # type: ignore[attr-defined]
        self.io.begin(self.tick, now)
        self.service.step(now)

    def show(self, picture_id: str, camera: str, pixels: int) -> None:
        image = m.Rgbd(
            t=self.tick * 0.01, id=picture_id, camera=camera, width=4, height=3, fx=4.0, fy=4.0, cx=2.0, cy=1.5,
            position=(0.0, 0.0, 1.0), orientation=(1.0, 0.0, 0.0, 0.0), rgb=bytes(3 * pixels), depth=bytes(2 * pixels),
        )  # fmt: skip
        self.bus.send(topics.HEAD_RGBD, image)
        self.step()


@pytest.mark.parametrize("camera", ["head", "../../etc/passwd"])
def test_a_picture_without_its_pixels_is_counted_whoever_it_says_took_it(camera: str) -> None:
    node = Node()
    node.show(node.asked.id, camera, pixels=7)
    assert node.io.drops[topics.HEAD_RGBD.key] == 1


def test_a_picture_that_nobody_asked_for_is_not_looked_at() -> None:
    node = Node()
    node.show(node.asked.id, "head", pixels=7)
    node.show("", "head", pixels=7)
    assert node.io.drops[topics.HEAD_RGBD.key] == 1
