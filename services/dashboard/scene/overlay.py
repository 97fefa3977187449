"""What the robot believes, drawn into what it sees."""

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from common import messages as m
from common.geometry import Pose2, quat_matrix

Array = NDArray[np.float64]
NEAR = 0.1
"""Depth [m] from which on a box is drawn into a picture; chosen: a nearer one would fill it."""
AGREES = 0.12
"""Difference [m] to the picture's own depth up to which a believed object is marked; chosen:
a belief that is off by some centimetres is still marked."""
COLOUR, BACK = (255, 214, 10), (0, 0, 0)
"""Colours [sRGB] of frames and names, and of the rim that makes names readable on anything."""


def boxes(
    image: m.Rgbd, base: Pose2, objects: list[m.WorldObject]
) -> list[tuple[str, tuple[float, float, float, float]]]:
    """Label and (left, top, right, bottom) in pixels of every believed object that is in the picture and in sight."""
    depth = np.frombuffer(image.depth, "<u2").reshape(image.height, image.width) / 1000.0
    turn = quat_matrix(image.orientation)
    c, s = np.cos(base[2]), np.sin(base[2])
    level = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
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


def marked(image: m.Rgbd, base: Pose2, objects: list[m.WorldObject]) -> NDArray[np.uint8] | None:
    """The picture (height, width, 3) with the believed objects framed; None when its size is wrong."""
    pixels = image.width * image.height
    if len(image.rgb) != 3 * pixels or len(image.depth) != 2 * pixels:
        return None
    canvas = Image.frombytes("RGB", (image.width, image.height), image.rgb)
    pen = ImageDraw.Draw(canvas)
    for label, (left, top, right, bottom) in boxes(image, base, objects):
        pen.rectangle((left, top, right, bottom), outline=COLOUR)
        pen.text((left + 1, max(0.0, top - 11)), label, fill=COLOUR, stroke_width=1, stroke_fill=BACK)
    return np.asarray(canvas)
