"""What a segment is that nothing the robot was told of explains: its shape, kinds and colours. Pure."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array, Point, cell_means
from common.kinds import LOOKS, Kind, kind_of, laid_on_a_side
from common.messages import End, ShapeFamily
from common.naming.looks import OTHER, Measures, likely
from services.perception.detection import Detection
from services.perception.segments.segment import DEPTH_NOISE, Segment
from services.perception.shapes.handle import parted
from services.perception.shapes.measure import measure
from services.perception.shapes.measurement import LEVEL, Measurement
from services.perception.shapes.upper_end import upper_end
from services.perception.views import colour
from services.perception.views.view import View

SURE, FEW, LIKE_NOTHING = 0.9, 180, 0.75
"""Confidence of what is seen whole and near, the pixels below which it falls, and its share for what has no shape."""
CUT, CUT_SPREAD = 0.6, 0.02
"""Share of the confidence of what is seen in part, and the least spread [m] of its extents."""
NECK, NECK_UPPER = 0.66, 2
"""Radius of the upper slices by that of the widest, below which there is a neck, and how many slices are looked at."""
MOSTLY = 0.5
"""Least share of the kinds that lie as long as it is in what it may be."""
VOXEL = 0.005
"""Side [m] of the cells in which points are averaged. Chosen: a third of a finger pad."""
DIM, DARKEST = 60.0, 12.0
"""Levels (of 255) of the brightest channel below which depth grows noisier, with the square root of how little light
comes back, and below which there is none."""
MOST_POINTS = 600
"""Points of an object that are told to others: one for each cell of the visible side of something of 25 by 6 cm. With a
third of them a stem, a drip pan and the gap of a handle all looked alike to the hand."""


def describe(view: View, segment: Segment, found: Measurement) -> Detection:
    """The object that a segment shows, by its looks alone: its shape as `found`."""
    shares = colour.shares(view.rgb[segment.rows, segment.columns], view.light)
    words = colour.main_words(shares)
    spread = found.spread if not segment.cut else max(found.spread, CUT_SPREAD)
    kinds = kinds_of(found, spread, words)
    height = found.size[1] if found.tilt else found.size[2]
    tilt = _tilt(found, kinds)
    confidence = SURE * (0.45 + 0.55 * min(1.0, len(segment.rows) / FEW)) * (CUT if segment.cut else 1.0)
    kind = next(iter(kinds))
    end = found.end
    if not end and not found.tilt and found.family in ("box", "round"):
        end = end_above(
            view, segment, (found.x, found.y), min(found.size[:2]) / 2 * (found.profile or (1.0,))[-1], height
        )
    return Detection(
        label="",
        kind=kind,
        colour=words[0],
        position=(found.x, found.y, segment.surface.height + height / 2),
        yaw=found.yaw if found.tilt or math.isnan(found.handle) else found.handle,
        size=found.size,
        confidence=confidence * (LIKE_NOTHING if found.family == "irregular" else 1.0),
        on=segment.surface.name,
        distance=math.hypot(found.x - float(view.position[0]), found.y - float(view.position[1])),
        known=False,
        whole=not segment.cut,
        tilt=tilt,
        end=end,
        yaw_seen=found.top_seen if found.tilt else found.family != "round" or not math.isnan(found.handle),
        shape=found.family,
        kinds=kinds,
        colours=shares,
        spread=spread,
        points=thinned(segment.points),
    )


def _tilt(found: Measurement, kinds: Mapping[str, float]) -> float:
    """Tilt [rad] of an object by its shape and what it may be: a box that stands on its end may lie on a side, what has
    a handle and a bottom above stands on its mouth.
    """
    if found.family == "box":
        lying = sum(share for kind, share in kinds.items() if laid_on_a_side(kind, found.size))
        return LEVEL if lying >= MOSTLY else 0.0
    vessel = "upside down" in kind_of(next(iter(kinds))).rests
    on_its_mouth = vessel and found.end == "closed" and not found.tilt and not math.isnan(found.handle)
    return math.pi if on_its_mouth else found.tilt


def kinds_of(found: Measurement, spread: float, words: list[str]) -> dict[str, float]:
    """What an object may be, the likeliest first, by its shape and those that explain it nearly as well."""
    votes: dict[str, float] = {}
    for weight, shape in ((1.0, found), *found.rivals):
        for kind, share in likely(LOOKS, measures_of(shape, spread), words).items():
            votes[kind] = votes.get(kind, 0.0) + weight * share
    total = sum(votes.values())
    ordered = sorted(votes, key=lambda kind: (-votes[kind], kind))
    return {kind: votes[kind] / total for kind in ordered if votes[kind] > 0.04 * total} or {OTHER: 1.0}


def measured(view: View, segment: Segment, hanging: NDArray[np.bool_] | None = None) -> Measurement:
    """The shape of a segment, its noise by its distance; `hanging` (n,): which of its pixels hang beside its body."""
    far = float(np.median((segment.points - view.position) @ view.rotation[:, 2]))
    handle = parted(segment.rows, segment.columns, far / view.focal[0]).of_handle(segment.rows, segment.columns)
    return measure(
        segment.points,
        segment.surface.height,
        view.position,
        segment.ends,
        0.5 / view.focal[0],
        noise_of(view, segment),
        segment.dark,
        handle if hanging is None else handle | hanging,
    )


def end_above(view: View, segment: Segment, middle: Point, radius: float, height: float) -> End:
    """What the upper end of a segment is, `radius` and `height` [m] over its surface."""
    down = np.array([0.0, 0.0, segment.surface.height])
    noise = noise_of(view, segment) if len(segment.points) else 0.0
    return upper_end(segment.points - down, middle, radius, height, view.position - down, noise)


def noise_of(view: View, segment: Segment) -> float:
    """Standard deviation [m] of a segment's points along the line of sight; what is dark gives little light."""
    far = float(np.linalg.norm(segment.points.mean(axis=0) - view.position))
    level = float(np.median(view.rgb[segment.rows, segment.columns].max(axis=1)))
    return DEPTH_NOISE * far * far * math.sqrt(DIM / min(DIM, max(DARKEST, level)))


def measures_of(m: Measurement, error: float) -> Measures:
    """The measures in the object's own frame, by which its kind is told."""
    if m.family in ("round", "bowl", "ball") or (m.family == "long" and m.profile):
        across, along = (m.size[1], m.size[0]) if m.tilt == LEVEL else (m.size[0], m.size[2])
        # What lies shows its neck from the side, to its end.
        upper = m.profile[-1:] if m.tilt == LEVEL else m.profile[-NECK_UPPER:]
        neck = bool(upper) and max(upper) < NECK and not m.hollow
        return Measures(m.family, across, along, 1.0, m.hollow, neck, not math.isnan(m.handle), error)
    shortest, middle, longest = sorted(m.size)
    return Measures(m.family, shortest, longest, middle / shortest, error=error)


def thinned(points: Array) -> Array:
    """At most MOST_POINTS of points (n, 3), evenly spread, each the mean of its cell."""
    if not len(points):
        return points
    means, *_ = cell_means(points, VOXEL)
    if len(means) <= MOST_POINTS:
        return means
    return np.asarray(means[np.linspace(0, len(means) - 1, MOST_POINTS).astype(int)])


def family_of(kind: Kind, size: tuple[float, float, float]) -> ShapeFamily:
    """The shape family of an object of a known kind and extents."""
    families: Mapping[str, ShapeFamily] = {"box": "box", "sphere": "ball"}
    return families.get(kind.shape, "bowl" if kind.lean and size[0] > size[2] else "round")
