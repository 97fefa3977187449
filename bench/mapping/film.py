"""A film of a map that grows, beside what the robot's camera sees: frames from a running stack to an animated WebP."""

import zlib
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from common import messages as m
from common import topics
from common.bus import codec
from common.files.map_file import UNKNOWN, picture
from common.geometry import Pose2, compose
from common.topic import Topic
from evaluation.stack import Stack

HEIGHT, GAP = 300, 8
"""Height of the film, and between its two pictures [px]."""
PAUSE, LAST = 120, 2500
"""How long each frame stays, and the last one [ms]."""
QUALITY = 55
"""Of the WebP [%]; chosen: a home of 60 m2 in half a megabyte."""
ROBOT = (214, 69, 65)


class Frame(NamedTuple):
    """A moment: the map so far, the robot's pose on it, and the camera's picture (rows, columns, 3)."""

    grid: m.MapGrid
    pose: Pose2
    view: NDArray[np.uint8]


class Film:
    """`add` takes a frame of a stack as it is, `save` writes what there is."""

    def __init__(self) -> None:
        self._frames: list[Frame] = []
        self._taps: list[tuple[Topic[Any], list[bytes]]] = []
        self._last: dict[str, Any] = {}

    def add(self, stack: Stack) -> None:
        """Another moment, once there are a map and a picture."""
        if not self._taps:
            self._taps = [(t, stack.bus.tap(t)) for t in (topics.MAP_GRID, topics.ODOMETRY, topics.HEAD_RGBD)]
        for topic, payloads in self._taps:
            if payloads:
                self._last[topic.key] = codec.decode(topic, payloads[-1])
                payloads.clear()
        if len(self._last) < len(self._taps):
            return
        grid, wheels, image = (self._last[topic.key] for topic, _ in self._taps)
        rgb = np.frombuffer(image.rgb, np.uint8).reshape(image.height, image.width, 3)
        self._frames.append(Frame(grid, compose(grid.odom, (wheels.x, wheels.y, wheels.theta)), rgb))

    def save(self, path: Path) -> None:
        """Write the film; nothing without frames."""
        if not self._frames:
            return
        grids = [f.grid for f in self._frames]
        low = min(g.x for g in grids), min(g.y for g in grids)
        high = max(g.x + g.width * g.resolution for g in grids), max(g.y + g.height * g.resolution for g in grids)
        drawn = [_drawn(frame, low, high) for frame in self._frames]
        times = [PAUSE] * (len(drawn) - 1) + [LAST]
        drawn[0].save(path, save_all=True, append_images=drawn[1:], duration=times, loop=0, quality=QUALITY, method=6)


def _drawn(frame: Frame, low: tuple[float, float], high: tuple[float, float]) -> Image.Image:
    """The map within the corners `low` and `high` [map] with the robot on it, and the view beside."""
    grid, cell = frame.grid, frame.grid.resolution
    columns, rows = (round((high[k] - low[k]) / cell) for k in (0, 1))
    cells = np.full((rows, columns), UNKNOWN, np.uint8)
    x, y = round((grid.x - low[0]) / cell), round((grid.y - low[1]) / cell)
    part = np.frombuffer(zlib.decompress(grid.cells), np.uint8).reshape(grid.height, grid.width)
    cells[y : y + grid.height, x : x + grid.width] = part
    scale = HEIGHT / (rows * cell)
    plan = picture(cells).resize((round(columns * cell * scale), HEIGHT), Image.Resampling.LANCZOS).convert("RGB")
    u, v = (frame.pose[0] - low[0]) * scale, HEIGHT - (frame.pose[1] - low[1]) * scale
    radius = 0.28 * scale
    pen = ImageDraw.Draw(plan)
    pen.ellipse((u - radius, v - radius, u + radius, v + radius), fill=ROBOT)
    pen.line(
        (u, v, u + 1.6 * radius * np.cos(frame.pose[2]), v - 1.6 * radius * np.sin(frame.pose[2])), fill=ROBOT, width=3
    )
    view = Image.fromarray(frame.view)
    view = view.resize((round(view.width * HEIGHT / view.height), HEIGHT), Image.Resampling.LANCZOS)
    both = Image.new("RGB", (plan.width + GAP + view.width, HEIGHT), "white")
    both.paste(plan, (0, 0))
    both.paste(view, (plan.width + GAP, 0))
    return both
