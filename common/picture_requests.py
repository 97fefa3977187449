"""Requests of camera pictures for viewers, while somebody subscribes to them."""

from typing import Any

from common import messages as m
from common import topics
from common.bus.port import Io
from common.gateway import due
from common.topic import Topic


class PictureRequests:
    """Requests pictures of `width` x `height` pixels at `rate` [Hz]; none at 0."""

    def __init__(self, io: Io, rate: float, width: int, height: int) -> None:
        self._io, self.rate, self._width, self._height = io, rate, width, height
        self._asked: dict[str, float] = {}

    def step(self, now: float, watched: set[Topic[Any]]) -> None:
        """Request a picture of each camera whose topic is in `watched`, when it is due."""
        for name, topic in topics.PICTURES.items():
            if topic not in watched or not due(self.rate, now - self._asked.get(name, float("-inf"))):
                continue
            self._asked[name] = now
            own = self._io.new_id(self._io.name)
            request = m.CameraRequest(id=own, camera=name, width=self._width, height=self._height)
            self._io.publish(topics.CAMERA_REQUEST, request)
