"""The panel of camera pictures, requested only while somebody looks, with the known objects drawn in."""

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Pose2, quat_matrix, yaw_matrix
from common.picture_requests import PictureRequests
from common.robot.pictures import PictureError, colours, depths
from services.dashboard.config import DashboardConfig
from services.dashboard.panels.widgets import Panels

NEAR = 0.1
"""Depth [m] from which on a box is drawn into a picture; chosen: a nearer one would fill it."""
AGREES = 0.12
"""Difference [m] to the picture's own depth up to which a believed object is marked; chosen:
a belief that is off by some centimetres is still marked."""
COLOUR, BACK = (255, 214, 10), (0, 0, 0)
"""Colours [sRGB] of frames and names, and of the rim that makes names readable on anything."""


class Cameras:
    """Requests and shows the pictures of the cameras that visitors have chosen."""

    def __init__(self, config: DashboardConfig, io: Io, panels: Panels) -> None:
        self._config, self._io, self._panels = config, io, panels
        self._requests = PictureRequests(io, config.camera_rate, config.camera_width, config.camera_height)
        self._shown: dict[str, float] = {}

    def look(self, now: float, base: Pose2) -> None:
        """Show the pictures that have come, and request the next ones."""
        world = self._io.latest(topics.WORLD_OBJECTS)
        wanted = {name: topic for name, topic in topics.PICTURES.items() if self._panels.wanted(name)}
        for name, topic in wanted.items():
            # Others ask for pictures, too, and more often than a person needs to see one.
            due = now - self._shown.get(name, float("-inf")) >= 0.9 / self._config.camera_rate
            for image in self._io.take_all(topic) if due else ():
                self._shown[name] = now
                try:
                    self._panels.picture(name, marked(image, base, world.objects if world is not None else []))
                except PictureError as error:
                    self._io.count_drop(topic.key, str(error))
        self._requests.step(now, {*wanted.values()})


# --- what the robot believes, drawn into what it sees
def boxes(
    image: m.Rgbd, base: Pose2, objects: list[m.WorldObject]
) -> list[tuple[str, tuple[float, float, float, float]]]:
    """Label and (left, top, right, bottom) in pixels of every believed object that is in the picture and in sight."""
    depth = depths(image)
    turn, level = quat_matrix(image.orientation), yaw_matrix(base[2])
    found = []
    for one in objects:
        half = np.maximum(np.array(one.size) / 2, 0.01)
        corners = np.array(np.meshgrid(*[(-1, 1)] * 3)).reshape(3, -1).T * half @ quat_matrix(one.orientation).T
        points = np.concatenate([[one.position], corners + one.position]) - (base[0], base[1], 0.0)
        seen = (points @ level - np.array(image.position)) @ turn
        if seen[:, 2].min() < NEAR:
            continue
        u = image.fx * seen[:, 0] / seen[:, 2] + image.cx
        v = image.fy * seen[:, 1] / seen[:, 2] + image.cy
        if not (0 <= u[0] < image.width and 0 <= v[0] < image.height):
            continue
        there = float(depth[int(v[0]), int(u[0])])
        if abs(there - seen[0, 2]) > AGREES + float(half.max()):
            continue
        found.append((one.label, (float(u[1:].min()), float(v[1:].min()), float(u[1:].max()), float(v[1:].max()))))
    return found


def marked(image: m.Rgbd, base: Pose2, objects: list[m.WorldObject]) -> NDArray[np.uint8]:
    """The picture (height, width, 3) with the believed objects framed.

    Raises:
        PictureError: not as many pixels as it says.
    """
    canvas = Image.fromarray(colours(image))
    pen = ImageDraw.Draw(canvas)
    for label, (left, top, right, bottom) in boxes(image, base, objects):
        pen.rectangle((left, top, right, bottom), outline=COLOUR)
        pen.text((left + 1, max(0.0, top - 11)), label, fill=COLOUR, stroke_width=1, stroke_fill=BACK)
    return np.asarray(canvas)
