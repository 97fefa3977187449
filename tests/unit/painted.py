"""Views of boxes whose fronts are painted, made without a renderer: for tests of what is seen on an object."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from common.messages import WorldObject
from services.perception.views.view import View

HEIGHT = 1.0
"""Height [m] of the camera, which looks along x from the origin of the map."""
OPTICAL = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
"""Columns: the optical frame's axes (right, down, ahead) in frame map."""


@dataclass(frozen=True)
class Box:
    """A box before the camera: its centre (x, y) [m], its front `width` x `height` [m] painted with `front`."""

    x: float
    y: float
    front: NDArray[np.uint8]
    width: float = 0.08
    height: float = 0.12
    depth: float = 0.06

    def believed(self, key: str, label: str, kind: str = "box", colour: str = "") -> WorldObject:
        return WorldObject(
            label=label, kind=kind, colour=colour, position=(self.x, self.y, HEIGHT), id=key,
            size=(self.depth, self.width, self.height), on="counter",
        )  # fmt: skip


def label(*lines: str, ground: tuple[int, int, int] = (190, 40, 40), ink: tuple[int, int, int] = (250, 250, 240),
          band: tuple[int, int, int] | None = None) -> NDArray[np.uint8]:  # fmt: skip
    """A printed front, 160 x 240 pixels: a ground, a band of another colour below, and lines of text."""
    picture = Image.new("RGB", (160, 240), ground)
    draw = ImageDraw.Draw(picture)
    if band is not None:
        draw.rectangle((0, 150, 160, 240), fill=band)
    for n, line in enumerate(lines):
        draw.text((80, 60 + 40 * n), line, font=ImageFont.load_default(34), fill=ink, anchor="mm")
    return np.asarray(picture)


def view_of_boxes(
    boxes: list[Box], width: int = 640, height: int = 480, light: float = 1.0, noise: float = 3.0, t: float = 0.0
) -> View:
    """What the camera sees of boxes that face it, in `light` times as much light, before a grey wall 3 m away."""
    focal = height * 0.96
    rng = np.random.default_rng(7)
    rgb = np.full((height, width, 3), 120.0)
    depth = np.full((height, width), 3.0, np.float32)
    for box in sorted(boxes, key=lambda b: -b.x):
        near = box.x - box.depth / 2
        left, right = (round(width / 2 - focal * (box.y + s * box.width / 2) / near) for s in (1, -1))
        top, bottom = (round(height / 2 - focal * s * box.height / 2 / near) for s in (1, -1))
        front = Image.fromarray(box.front).resize((right - left, bottom - top), Image.Resampling.BOX)
        rgb[top:bottom, left:right] = np.asarray(front)
        depth[top:bottom, left:right] = near
    rgb = np.clip(rgb * light + rng.normal(0.0, noise, rgb.shape), 0, 255)
    return View(
        rgb=rgb.astype(np.uint8), depth=depth, focal=(focal, focal), middle=(width / 2, height / 2),
        position=np.array([0.0, 0.0, HEIGHT]), rotation=OPTICAL, t=t,
    )  # fmt: skip
