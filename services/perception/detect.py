"""Objects in one RGB-D view: the seam for detectors, and the classical one. Pure.

`ClassicalDetector` cuts the view into the objects that stand on surfaces, then asks which object of the household
(`household.things`: kind, size, colour) explains the points and the colour best. What none explains is measured.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from common.floor_plan import Vec3
from common.geometry import Array, Mask
from common.household import Household
from common.kinds import kind_of
from common.messages import End
from common.thing import Thing
from services.perception import unlisted
from services.perception.detection import Detection
from services.perception.segments import segmentation, separate
from services.perception.segments.segment import Segment
from services.perception.shapes import known as shapes
from services.perception.shapes import known_toppled as toppled
from services.perception.views import colour
from services.perception.views.view import View

SHAPE_SCALE, HEIGHT_SCALE, COLOUR_SCALE = 0.0035, 0.010, 0.07
"""Standard deviations of a fit's mean distance [m], of the height [m], and of the colour's difference (`colour`)."""
WORST, SOUND = 3.2, 2.0
"""Score, in standard deviations, beyond which a hypothesis explains nothing, and below which no other pose is tried."""
LYING = math.pi / 2
"""Tilt [rad] of what lies on its side."""


@dataclass(frozen=True)
class RestingPose:
    """How an object may rest on a surface: its full extents there, and the tilt [rad] of its own axis."""

    size: Vec3
    tilt: float = 0.0


@dataclass(frozen=True)
class Hypothesis:
    """An object of the household in one resting pose that may explain a segment; `score` in standard deviations."""

    score: float
    spec: Thing
    rest: RestingPose
    fit: shapes.Fit


class Detector(Protocol):
    """What a detector is: made from the household's vocabulary, then asked view by view."""

    def __init__(self, household: Household, max_range: float) -> None: ...

    def detect(self, view: View, robot: Mask | None = None) -> list[Detection]:
        """Objects in a view. `robot` (h, w) marks the pixels that show the robot itself."""
        ...


class ClassicalDetector:
    """Segmentation above surfaces and model fitting."""

    def __init__(self, household: Household, max_range: float) -> None:
        self._household, self._max_range = household, max_range

    def detect(self, view: View, robot: Mask | None = None) -> list[Detection]:
        segments = segmentation.segments(view, self._household, self._max_range, robot)
        found: list[Detection] = []
        for segment in segments:
            if segment.shape is not None:
                found.append(unlisted.describe(view, segment, segment.shape))
                continue
            single = segmentation.extent(segment) < segmentation.MAX_EXTENT
            known = self._explain(view, segment) if single else None
            found += [known] if known is not None else self._measured(view, segment)
        return found

    def _measured(self, view: View, segment: Segment) -> list[Detection]:
        """The objects of a segment that no object of the household explains as a whole."""
        found = separate.pieces(view, segment)
        if len(found) == 1 and found[0].segment is segment:
            return [unlisted.describe(view, segment, found[0].shape)]
        return [self._explain(view, p.segment) or unlisted.describe(view, p.segment, p.shape) for p in found]

    def _explain(self, view: View, segment: Segment) -> Detection | None:
        """The object of the household that explains a segment; None if none does."""
        rgb = colour.typical(view.rgb[segment.rows, segment.columns])
        height = float(np.percentile(segment.points[:, 2], 98)) - segment.surface.height
        hypotheses = self._hypotheses(view, segment, rgb, height, _standing)
        if not hypotheses or hypotheses[0].score > SOUND:
            # Nothing stands there that explains it well.
            more = self._hypotheses(view, segment, rgb, height, _toppled)
            hypotheses = sorted([*hypotheses, *more], key=lambda g: g.score)
        if not hypotheses or hypotheses[0].score > WORST:
            return None
        best = hypotheses[0]
        score, spec, size, fit = best.score, best.spec, best.rest.size, best.fit
        tilt, kind = best.rest.tilt, kind_of(spec.kind)
        end = _end(spec, view, segment, fit) if tilt != LYING and "upside down" in kind.rests else ""
        if kind.straight and end == "closed":
            # The walls look alike either way up.
            tilt = math.pi
        second = next((rival.score for rival in hypotheses if rival.spec is not spec), WORST)
        # Sure when the fit is good and nothing else in the house comes close.
        confidence = math.exp(-0.5 * (score / 2.2) ** 2) * (1 - math.exp(-2.0 * (second - score) - 0.4))
        pixels = min(1.0, len(segment.rows) / 120)
        yaw, yaw_seen = fit.yaw, True
        if kind.handle and not tilt:
            yaw, yaw_seen = shapes.handle_yaw(size, segment.points, fit.x, fit.y, view.position)
        position = (fit.x, fit.y, segment.surface.height + size[2] / 2)
        return Detection(
            label=spec.name,
            kind=spec.kind,
            colour=spec.colour,
            position=position,
            yaw=yaw,
            size=size,
            confidence=confidence * (0.55 + 0.45 * pixels) * (0.6 if segment.cut else 1.0),
            on=segment.surface.name,
            distance=_distance(view, fit),
            whole=not segment.cut and score < SOUND,
            share=min(1.0, len(segment.rows) / _pixels(view, position, size)),
            tilt=tilt,
            yaw_seen=yaw_seen,
            end=end,
            shape=unlisted.family_of(kind, size),
            kinds={spec.kind: 1.0},
            colours={spec.colour: 1.0},
            points=unlisted.thinned(segment.points),
        )

    def _hypotheses(
        self,
        view: View,
        segment: Segment,
        rgb: Array,
        height: float,
        resting_poses: Callable[[Thing], list[RestingPose]],
    ) -> list[Hypothesis]:
        """What may explain the segment, the best first."""
        found = []
        for spec in self._household.things:
            # In standard deviations.
            off = colour.difference(rgb, spec.rgba) / COLOUR_SCALE
            for rest in resting_poses(spec) if off <= WORST else ():
                tall = _too_tall(spec, rest, height) / HEIGHT_SCALE
                if segment.cut:
                    tall = min(tall, 1.0)
                if tall <= WORST:
                    fit = _fit(spec, rest, view, segment)
                    if rest.tilt == math.pi and _end(spec, view, segment, fit) != "closed":
                        continue
                    score = math.sqrt((fit.residual / SHAPE_SCALE) ** 2 + tall**2 + off**2)
                    found.append(Hypothesis(score, spec, rest, fit))
        return sorted(found, key=lambda g: g.score)


def _standing(spec: Thing) -> list[RestingPose]:
    """An object as it stands, and what may lie on another face."""
    x, y, z = spec.size
    if "face" not in kind_of(spec.kind).rests:
        return [RestingPose(spec.size)]
    return [
        RestingPose(size, 0.0 if size[2] == z else LYING) for size in dict.fromkeys([(x, y, z), (z, y, x), (z, x, y)])
    ]


def _toppled(spec: Thing) -> list[RestingPose]:
    """A round object on its side, or upside down."""
    rests = kind_of(spec.kind).rests
    found = [RestingPose(toppled.extents(spec.size), LYING)] if "side" in rests else []
    return found + ([RestingPose(spec.size, math.pi)] if "upside down" in rests else [])


def _too_tall(spec: Thing, rest: RestingPose, height: float) -> float:
    """How far [m] a measured height is from a rest's."""
    low = high = rest.size[2]
    kind = kind_of(spec.kind)
    if rest.tilt == LYING and "side" in kind.rests:
        low, high = toppled.heights(kind, spec.size)
    return max(low - height, height - high, 0.0)


def _fit(spec: Thing, rest: RestingPose, view: View, segment: Segment) -> shapes.Fit:
    kind, floor, camera = kind_of(spec.kind), segment.surface.height, view.position
    if rest.tilt == math.pi:
        return toppled.fit_upside_down(kind, spec.size, segment.points, floor, camera)
    if rest.tilt and "side" in kind.rests:
        return toppled.fit(kind, spec.size, segment.points, floor, camera)
    return shapes.fit(kind, rest.size, segment.points, floor, camera, segment.ends)


def _end(spec: Thing, view: View, segment: Segment, fit: shapes.Fit) -> End:
    """What the upper end is: the walls alone fit a vessel either way up, all the more when a part of it is hidden."""
    radius = kind_of(spec.kind).foot(spec.size)
    return unlisted.end_above(view, segment, (fit.x, fit.y), radius, spec.size[2])


def _pixels(view: View, position: Vec3, size: Vec3) -> float:
    """How many pixels an object of that size covers from the front when nothing hides it."""
    scale = view.focal[0] / math.dist(position, view.position)
    return scale * scale * min(size[0], size[1]) * size[2]


def _distance(view: View, fit: shapes.Fit) -> float:
    return math.hypot(fit.x - float(view.position[0]), fit.y - float(view.position[1]))
