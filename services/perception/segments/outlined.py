"""Objects on a surface of which the picture shows the outline and little else: dark ones that get no depth. Pure."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.geometry import Array, Mask, Rectangle
from services.perception.segments.dark import HIGHEST, WIDEST, Blobs, Pixels, guessed
from services.perception.segments.in_line import JOIN, end_to_end
from services.perception.segments.segment import NEARER, RIM, Segment, Surface
from services.perception.shapes import primitives, silhouette
from services.perception.shapes.measurement import Measurement
from services.perception.views.view import View
from services.perception.views.visible_plan import Cloud

BELOW = 3
"""How many pixels below an object's lower edge the surface that it stands on is looked for: edges have no depth."""
LEVEL = 0.012
"""Distance [m] from the surface, beside noise, within which that is the surface."""
STANDS = 0.7
"""Share of the lower edge below which the surface is seen, of what no thing before it hides, from which an object
stands on it."""
HIDDEN, MOST_HIDDEN, FOOT = 0.08, 0.4, 0.2
"""Shares of the band around an outline in which something nearer is seen, from which it hides a part of it, and from
which it is no outline; least share of its lower edge below which the surface is seen."""
OWN, OWN_SHARE = 0.015, 0.6
"""How far [m] around the shape what was measured is of the object itself, and the share of a part that has to be."""

SAMPLE, GRID = 120, 12
"""Points of a part that are looked at, and points along a side of a face."""
SEAM = 2
"""Width [pixels] of the line between two parts that is of neither."""


def on_surface(
    view: View, name: str, plane: Array, over: Cloud, own: Mask, dark: Blobs, taken: Sequence[Rectangle] = ()
) -> list[Segment]:
    """The objects on a surface, z = plane (3,) @ (x, y, 1), whose outline alone is seen. `over`: the pixels over it;
    `taken`: where something else stands, with parts as dark."""
    if not len(over.pixels):
        return []
    low = np.array([over.x.min(), over.y.min()]) - OWN
    high = np.array([over.x.max(), over.y.max()]) + OWN
    found = []
    for number, pixels in dark.unseen():
        edge = _edge(view, pixels, plane)
        at = silhouette.foot(view, edge, float(plane[2]))
        if at is None or not ((low < at[:2]) & (at[:2] < high)).all():
            continue
        floor = float(plane @ (at[0], at[1], 1.0))
        at = silhouette.foot(view, edge, floor)
        if at is None or any(box.contains(float(at[0]), float(at[1])) for box in taken):
            continue
        hidden = _hidden(view, pixels, at, plane, own)
        if hidden is None:
            continue
        inside = np.isin(over.pixels, pixels[0] * view.shape[1] + pixels[1])
        points = np.stack([over.x[inside], over.y[inside], over.z[inside]], axis=1).astype(np.float64)
        points = points[points[:, 2] > floor + LEVEL]
        shape = silhouette.shape(view, silhouette.outline(view, pixels, at, hidden), at, floor, points)
        if shape is None or max(shape.size[:2]) > WIDEST or shape.size[2] > HIGHEST:
            continue
        dark.taken.add(number)
        found.append(
            Segment(
                Surface(name, floor),
                *pixels,
                points[is_of(points, shape)],
                bool(hidden.any()),
                (True, True),
                shape=shape,
            )
        )
    return found


def _hidden(view: View, pixels: Pixels, at: Array, plane: Array, own: Mask) -> NDArray[np.bool_] | None:
    """At which of its pixels (n,) something nearer hides the rest of an outline that stands on the surface `at` (3,);
    None if it does not, is larger than objects are, or is hidden for the most part."""
    rows, columns = pixels
    distance = float((at - view.position) @ view.rotation[:, 2])
    pixel = distance / view.focal[0]
    if max(np.ptp(rows) * pixel / HIGHEST, np.ptp(columns) * pixel / WIDEST) > 1.0:
        return None
    top, left = int(rows.min()) - RIM, int(columns.min()) - RIM
    window = slice(max(0, top), int(rows.max()) + RIM + 1), slice(max(0, left), int(columns.max()) + RIM + 1)
    mask = np.zeros(view.depth[window].shape, bool)
    mask[rows - window[0].start, columns - window[1].start] = True
    band = ndimage.binary_dilation(mask, iterations=RIM) & ~mask
    depth = view.depth[window]
    nearer = band & (own[window] | ((depth > 0) & (depth < distance - NEARER)))
    # What is nearer below is the surface itself.
    nearer &= own[window] | (_above(view, window, plane) > LEVEL)
    share = float(np.mean(nearer[band])) if band.any() else 0.0
    if share > MOST_HIDDEN:
        return None
    hidden = ndimage.binary_dilation(nearer, np.ones((3, 3)), iterations=RIM)
    found = np.asarray(hidden[rows - window[0].start, columns - window[1].start])
    if not _stands(view, pixels, plane, found):
        return None
    return found if share > HIDDEN else np.zeros_like(found)


def _above(view: View, window: tuple[slice, slice], plane: Array) -> NDArray[np.float64]:
    x, y, z = np.moveaxis(view.points[window], -1, 0)
    return np.asarray(z - (plane[0] * x + plane[1] * y + plane[2]), np.float64)


def _lower_edge(view: View, pixels: Pixels, plane: Array) -> tuple[Pixels, Mask, Mask]:
    """The lowest pixel of each column of an outline, which (n,) of them have depth below, and which the surface."""
    rows, columns = pixels
    lowest = np.full(int(columns.max()) + 1, -1)
    np.maximum.at(lowest, columns, rows)
    across = np.flatnonzero(lowest >= 0)
    below = np.minimum(lowest[across] + BELOW, view.shape[0] - 1)
    x, y, z = view.points[below, across].T
    seen = view.depth[below, across] > 0
    return (lowest[across], across), seen, seen & (np.abs(z - (plane[0] * x + plane[1] * y + plane[2])) < LEVEL)


def _edge(view: View, pixels: Pixels, plane: Array) -> Pixels:
    """The pixels of the lower edge of an outline below which the surface is seen; all of it if there are none."""
    (rows, columns), _, on = _lower_edge(view, pixels, plane)
    return (rows[on], columns[on]) if on.any() else (rows, columns)


def _stands(view: View, pixels: Pixels, plane: Array, hidden: NDArray[np.bool_]) -> bool:
    """Below its lower edge the surface is seen, wherever there is depth and its pixels (n,) are not `hidden`."""
    (rows, columns), seen, on = _lower_edge(view, pixels, plane)
    covered = np.zeros(view.shape, bool)
    covered[pixels] = hidden
    free = ~covered[rows, columns]
    if np.count_nonzero(seen) < len(rows) / 3 or np.mean(on) < FOOT:
        return False
    return bool(np.mean(on[seen & (free | on)]) > STANDS)


def is_of(points: Array, shape: Measurement) -> NDArray[np.bool_]:
    """Which of points (n, 3) belong to an object of that shape, by where they are on the floor plan."""
    far = np.hypot(points[:, 0] - shape.x, points[:, 1] - shape.y)
    half = math.hypot(*shape.size[:2]) / 2 if shape.family == "box" else max(shape.size[:2]) / 2
    return np.asarray(far < half + OWN)


def with_parts(view: View, segment: Segment, parts: list[Segment]) -> Segment:
    """An object that was seen by its outline, and the lit parts of it: its shape is that of the whole outline.

    The dark foot of a stapler is no object by itself, and neither is the coloured half above it.
    """
    if not parts or segment.shape is None:
        return segment
    mask = np.zeros(view.shape, bool)
    for one in (segment, *parts):
        mask[one.rows, one.columns] = True
    # Between two parts there is a line of mixed pixels.
    rows, columns = np.nonzero(ndimage.binary_closing(mask, iterations=SEAM) | mask)
    pixels = rows, columns
    points = np.concatenate([segment.points, *(p.points for p in parts)])
    floor, shape = segment.surface.height, None
    if (at := silhouette.foot(view, pixels, floor)) is not None:
        shape = silhouette.shape(view, silhouette.outline(view, pixels, at), at, floor, points)
    fits = shape is not None and max(shape.size[:2]) <= WIDEST and shape.size[2] <= HIGHEST
    if shape is not None and fits and is_of(np.array([[segment.shape.x, segment.shape.y]]), shape)[0]:
        return replace(segment, rows=rows, columns=columns, points=points, shape=shape)
    lit = np.concatenate([p.rows for p in parts]), np.concatenate([p.columns for p in parts])
    if len(lit[0]) < len(segment.rows):
        return replace(segment, rows=rows, columns=columns, points=points)
    # What is wider above its foot seems to stand behind it: its lit parts say where it is.
    foot = guessed(view, lit, (segment.rows, segment.columns))
    return replace(segment, rows=lit[0], columns=lit[1], points=points[-len(lit[0]) :], shape=None, dark=foot)


def with_rest(segment: Segment, rest: list[Segment]) -> Segment:
    """An object that was seen by its outline, and the lit `rest` of it that lies in line with it: a box around all."""
    if not rest or segment.shape is None:
        return segment
    shape, floor = segment.shape, segment.surface.height
    points = np.concatenate([segment.points, *(p.points for p in rest)])
    every = np.concatenate([_block(shape), points - (0.0, 0.0, floor)])
    _, yaw, (length, width), (x, y) = primitives.rectangle(every[:, :2], 12)[0]
    if width > length:
        length, width, yaw = width, length, yaw + math.pi / 2
    size = float(length), float(width), max(shape.size[2], *(p.top for p in rest))
    yaw = math.remainder(float(yaw), math.pi)
    return replace(
        segment,
        rows=np.concatenate([segment.rows, *(p.rows for p in rest)]),
        columns=np.concatenate([segment.columns, *(p.columns for p in rest)]),
        points=points,
        shape=Measurement("box", float(x), float(y), yaw, size, shape.residual, max(shape.spread, OWN), free=5),
    )


def in_line(segment: Segment, part: Segment) -> bool:
    """A lit part goes on where an object ends that was seen by its outline: a handle, whose blade is black."""
    if segment.shape is None:
        return False
    block, over = _block(segment.shape), part.points - (0.0, 0.0, part.surface.height)
    apart = np.linalg.norm(block[:, None, :2] - over[None, :: max(1, len(over) // SAMPLE), :2], axis=2).min()
    return float(apart) < JOIN and end_to_end([block, over])


def _block(shape: Measurement) -> Array:
    """Points (n, 3) over the surface all over the upper face of a box around a shape."""
    u, v = (side.ravel() - 0.5 for side in np.meshgrid(np.linspace(0, 1, GRID), np.linspace(0, 1, GRID)))
    u, v, (c, s) = u * shape.size[0], v * shape.size[1], (math.cos(shape.yaw), math.sin(shape.yaw))
    return np.stack([shape.x + c * u - s * v, shape.y + s * u + c * v, np.full(len(u), shape.size[2])], axis=1)


def is_part(points: Array, shape: Measurement) -> bool:
    """Points (n, 3) are for the most part of an object whose outline was seen."""
    return len(points) > 0 and float(np.mean(is_of(points, shape))) > OWN_SHARE
