"""The parts of a picture that stand up from a surface: cut apart where the depth jumps, joined to objects. Pure."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.geometry import Array, Mask
from services.perception.segments.air import ATTACHED, gap, hangs
from services.perception.segments.alike import BRIDGED, one_in_picture
from services.perception.segments.dark import Blobs, Pixels, guessed
from services.perception.segments.in_line import JOIN, end_to_end
from services.perception.segments.in_line import LONGEST as LONGEST_TOOL
from services.perception.segments.segment import Segment, Surface, covered
from services.perception.views.view import View

JUMP, JUMP_PER_METRE = 0.022, 0.012
"""Step of depth [m] between neighbouring pixels that separates two objects, and what is added per metre [m/m], as depth
noise and the slope between two pixels grow with the distance."""
JOINED_EXTENT, LONGEST = 0.17, 0.30
"""Largest extents [m] on the floor plan of what is joined, and of what is joined because the picture shows it as one.
Chosen: a bowl and its noise; a watering can with its spout."""


def between_jumps(view: View, rows: NDArray[np.intp], columns: NDArray[np.intp], least: int) -> list[Pixels]:
    """The pixels (n,) cut where the depth jumps; parts of fewer than `least` of them are left out."""
    top, left = int(rows.min()), int(columns.min())
    window = (slice(top, int(rows.max()) + 1), slice(left, int(columns.max()) + 1))
    mask = np.zeros((window[0].stop - top, window[1].stop - left), bool)
    mask[rows - top, columns - left] = True
    labels = ndimage.label(_cut(mask, view.depth[window]))[0]
    boxes = ndimage.find_objects(labels)
    found = []
    for n in np.flatnonzero(np.bincount(labels[mask], minlength=1)[1:] >= least):
        box = boxes[n]
        part_rows, part_columns = np.nonzero(labels[box] == n + 1)
        found.append((part_rows + box[0].start + top, part_columns + box[1].start + left))
    return found


def _cut(mask: Mask, depth: NDArray[np.float32]) -> Mask:
    """The mask without the far side of every depth jump."""
    kept = mask.copy()
    for axis in (0, 1):
        a = [slice(None), slice(None)]
        b = [slice(None), slice(None)]
        a[axis], b[axis] = slice(None, -1), slice(1, None)
        first, second = tuple(a), tuple(b)
        step = depth[second] - depth[first]
        limit = JUMP + JUMP_PER_METRE * np.minimum(depth[first], depth[second])
        # Where there is no depth there is no step.
        known = (depth[second] > 0) & (depth[first] > 0)
        kept[second] &= ~(known & (step > limit))
        kept[first] &= ~(known & (step < -limit))
    return kept


def joined(view: View, name: str, plane: Array, parts: list[Pixels], own: Mask, dark: Blobs | None) -> list[Segment]:
    """Parts of one object, such as the two sides of a mug's rim or a bottle's cap, stand in the same spot; those of a
    dark one are joined by what has no depth between them."""
    clouds = [view.points[rows, columns].astype(np.float64) for rows, columns in parts]
    low = np.array([c[:, :2].min(axis=0) for c in clouds])
    high = np.array([c[:, :2].max(axis=0) for c in clouds])
    groups = np.arange(len(parts))
    numbers = dark.of(view, parts) if dark else [0] * len(parts)
    order = sorted(range(len(parts)), key=lambda i: -len(clouds[i]))
    for n, i in enumerate(order):
        # The samples are at least as far apart as their bounds.
        for j in order[n + 1 :]:
            one_blob = numbers[i] > 0 and numbers[i] == numbers[j]
            apart = max(*(low[i] - high[j]), *(low[j] - high[i])) >= BRIDGED
            if groups[i] == groups[j] or (apart and not one_blob):
                continue
            members = (groups == groups[i]) | (groups == groups[j])
            extent = (high[members].max(axis=0) - low[members].min(axis=0)).max()
            distance = _gap(clouds[i], clouds[j])
            near = extent < JOINED_EXTENT and (one_blob or distance < JOIN)
            if near or (extent < LONGEST and distance < BRIDGED and one_in_picture(view, plane, parts[i], parts[j])):
                groups[groups == groups[j]] = groups[i]
            elif distance < JOIN and extent < LONGEST_TOOL:
                both = [np.concatenate([clouds[k] for k in np.flatnonzero(groups == groups[n])]) for n in (i, j)]
                if end_to_end([_over(plane, points) for points in both]):
                    groups[groups == groups[j]] = groups[i]
    _carried(view, plane, clouds, groups)
    found = []
    h, w = view.shape
    for group in np.unique(groups):
        members = np.flatnonzero(groups == group)
        rows = np.concatenate([parts[k][0] for k in members])
        columns = np.concatenate([parts[k][1] for k in members])
        blob = max(numbers[k] for k in members)
        hole = dark.hole(blob) if dark and blob else (rows[:0], rows[:0])
        all_rows, all_columns = np.append(rows, hole[0]), np.append(columns, hole[1])
        hidden = covered(view, all_rows, all_columns, own)
        ends = not hidden[2] and int(all_columns.max()) < w - 2, not hidden[1] and int(all_columns.min()) > 1
        cut = bool(hidden[0] or all_rows.min() <= 1 or all_rows.max() >= h - 2 or not all(ends))
        points = np.concatenate([clouds[k] for k in members])
        x, y, _ = points.mean(axis=0)
        surface = Surface(name, float(plane[0] * x + plane[1] * y + plane[2]))
        guess = guessed(view, (rows, columns), hole) if len(hole[0]) else np.empty((0, 3))
        found.append(Segment(surface, rows, columns, points, cut, ends, guess))
    return found


def _carried(view: View, plane: Array, clouds: list[NDArray[np.float64]], groups: NDArray[np.intp]) -> None:
    """Give each group of parts (n,) that hangs in the air to the nearest one that may carry it."""
    for group in np.unique(groups):
        members = np.flatnonzero(groups == group)
        if len(members) in (0, len(groups)):
            continue  # it carries one before it, or there is nothing that could carry it
        points = np.concatenate([clouds[k] for k in members])
        x, y, _ = points.mean(axis=0)
        if not hangs(view, points, float(plane @ (x, y, 1.0))):
            continue
        others = [k for k in range(len(clouds)) if groups[k] != group]
        distance, nearest = min((gap(points, clouds[k]), k) for k in others)
        if distance < ATTACHED:
            groups[groups == groups[nearest]] = group


def _over(plane: Array, points: Array) -> Array:
    """Points (n, 3) with their heights over the surface z = plane (3,) @ (x, y, 1)."""
    return np.column_stack([points[:, :2], points[:, 2] - points[:, :2] @ plane[:2] - plane[2]])


def _gap(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Horizontal distance between two clouds, from a sample of each."""
    pa = a[:: max(1, len(a) // 120), :2]
    pb = b[:: max(1, len(b) // 120), :2]
    distance = np.linalg.norm(pa[:, None] - pb[None], axis=2)
    return float(distance.min())
