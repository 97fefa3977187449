"""The cameras' pictures, asked for only while somebody looks, with what the robot believes drawn in."""

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Pose2
from services.dashboard.config import DashboardConfig
from services.dashboard.panels.widgets import CAMERAS, Panels
from services.dashboard.scene.overlay import marked

PICTURES = {"head": topics.HEAD_RGBD, "wrist": topics.WRIST_RGBD}


class Cameras:
    """One request at a time for each camera."""

    def __init__(self, config: DashboardConfig, io: Io, panels: Panels) -> None:
        self._config, self._io, self._panels = config, io, panels
        self._asked: dict[str, float] = {}
        self._shown: dict[str, float] = {}

    def look(self, now: float, base: Pose2) -> None:
        """Show what came, and ask again; not before a camera has answered."""
        config, world = self._config, self._io.latest(topics.WORLD_OBJECTS)
        for name in CAMERAS:
            # Others ask for pictures, too, and more often than a person needs to see one.
            due = now - self._shown.get(name, float("-inf")) >= 0.9 / config.camera_rate
            for image in self._io.take_all(PICTURES[name]) if due and self._panels.wanted(name) else ():
                self._shown[name] = now
                pixels = marked(image, base, world.objects if world is not None else [])
                if pixels is None:
                    self._io.count_drop(PICTURES[name].key, "not as many pixels as it says")
                    continue
                self._panels.picture(name, pixels)
                self._asked[name] = min(self._asked.get(name, now), now - 1.0 / config.camera_rate + 0.05)
            waiting = self._asked.get(name, float("-inf"))
            if self._panels.wanted(name) and now - waiting >= (1.0 / config.camera_rate):
                request = m.CameraRequest(
                    id=self._io.new_id("page"), camera=name, width=config.camera_width, height=config.camera_height
                )
                self._asked[name] = now
                self._io.publish(topics.CAMERA_REQUEST, request)
