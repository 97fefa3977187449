"""Pictures on request: when perception wants the next one, of which camera and how fine, and what it arrives as."""

import math
from collections.abc import Iterator
from typing import Literal

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Pose2, wrap
from services.perception.config import PerceptionConfig
from services.perception.views.state_buffer import StateBuffer
from services.perception.views.view import View, view_of

MOVING = 0.02
"""Change of the base's pose [m, rad] from which it moves. Chosen: above the noise of localisation at rest."""
AIM = "aim"
"""Phase of manipulation in which the hand is in front of the object and waits for the wrist camera's sighting."""
PICTURES = (topics.HEAD_RGBD, topics.WRIST_RGBD)


class Pictures:
    """Requests pictures from the camera, one at a time, and hands on the one that was requested last."""

    def __init__(self, config: PerceptionConfig, io: Io, state: StateBuffer) -> None:
        self._config, self._io, self._state = config, io, state
        self._id, self._asked_at = "", -1e9
        self._looked_from: tuple[Pose2, str] | None = None
        self.fine = False

    def forget(self) -> None:
        """The picture that is under way is not wanted any more."""
        self._id = ""

    def request(self, now: float, phase: str, wanted: bool, fine: bool, laden: bool) -> None:
        """Request the next picture when one is due.

        `phase` of manipulation; `wanted`: somebody waits for what it shows; `fine`: large enough to read from;
        `laden`: the robot carries something.
        """
        config, here = self._config, self._state.base
        waiting = bool(self._id) and now - self._asked_at < config.picture_timeout
        if waiting or here is None or self._state.turning() > config.max_turn:
            return
        period = config.idle_period if self._shown(here, phase, laden) else config.period
        if not wanted and now - self._asked_at < period and phase != AIM:
            return
        self._looked_from = here, phase
        self._id, self._asked_at, self.fine = self._io.new_id("picture"), now, fine
        camera: Literal["head", "wrist"] = "wrist" if phase == AIM and not wanted else "head"
        width, height = (config.fine_width, config.fine_height) if fine else (config.width, config.height)
        request = m.CameraRequest(id=self._id, camera=camera, width=width, height=height)
        self._io.publish(topics.CAMERA_REQUEST, request)

    def received(self) -> Iterator[tuple[View, Pose2]]:
        """The picture that was requested, once it is there, as a view from where the base was; others are dropped."""
        for key, image in ((t.key, image) for t in PICTURES for image in self._io.take_all(t)):
            base = self._state.base_at(image.t)
            if not self._id or image.id != self._id or base is None:
                continue
            self._id = ""
            try:
                yield view_of(image, base), base
            except ValueError as error:
                self._io.count_drop(key, str(error))

    def _shown(self, here: Pose2, phase: str, laden: bool) -> bool:
        """The last picture shows what one from `here` would: the robot rests, or drives and has not come far yet."""
        if self._looked_from is None or self._looked_from[1] != phase:
            return False
        there, config = self._looked_from[0], self._config
        if not self._state.driving():
            return _within(there, here, MOVING, MOVING)
        # Who carries something looks for nothing.
        return _within(there, here, config.laden_stride if laden else config.stride, config.sweep)


def _within(a: Pose2, b: Pose2, way: float, turn: float) -> bool:
    """Two poses are less than `way` [m] and `turn` [rad] apart."""
    return math.hypot(a[0] - b[0], a[1] - b[1]) < way and abs(wrap(a[2] - b[2])) < turn
