"""The cameras' pictures, asked for only while somebody looks, with what the robot believes drawn in."""

from common import topics
from common.bus.port import Io
from common.geometry import Pose2
from common.picture_requests import PICTURES, PictureRequests
from services.dashboard.config import DashboardConfig
from services.dashboard.panels.widgets import Panels
from services.dashboard.scene.overlay import marked


class Cameras:
    """Shows the pictures of the cameras that visitors want to see."""

    def __init__(self, config: DashboardConfig, io: Io, panels: Panels) -> None:
        self._config, self._io, self._panels = config, io, panels
        self._requests = PictureRequests(io, config.camera_rate, config.camera_width, config.camera_height)
        self._shown: dict[str, float] = {}

    def look(self, now: float, base: Pose2) -> None:
        """Show what came, and ask for more."""
        world = self._io.latest(topics.WORLD_OBJECTS)
        wanted = {name: topic for name, topic in PICTURES.items() if self._panels.wanted(name)}
        for name, topic in wanted.items():
            # Others ask for pictures, too, and more often than a person needs to see one.
            due = now - self._shown.get(name, float("-inf")) >= 0.9 / self._config.camera_rate
            for image in self._io.take_all(topic) if due else ():
                self._shown[name] = now
                pixels = marked(image, base, world.objects if world is not None else [])
                if pixels is None:
                    self._io.count_drop(topic.key, "not as many pixels as it says")
                else:
                    self._panels.picture(name, pixels)
        self._requests.step(now, {*wanted.values()})
