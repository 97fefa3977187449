"""Objects in one RGB-D view: the seam for detectors, and the classical one. Pure.

`ClassicalDetector` cuts the view into the things that stand on surfaces, then asks which thing of the household
(`scene.objects`: kind, size, colour) explains the points and the colour best. What fits none is reported by its
measured size and its nearest kind, with little confidence.
"""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from common.geometry import Array
from common.scene import ObjectKind, ObjectSpec, Scene, Vec3
from services.perception import colour, segment, shapes
from services.perception.segment import Piece
from services.perception.view import Mask, View

SHAPE_SCALE, HEIGHT_SCALE, COLOUR_SCALE = 0.0035, 0.010, 0.07
WORST, SOUND = 3.2, 2.0
STRANGE_CONFIDENCE = 0.45
STRANGE_KINDS: tuple[ObjectKind, ...] = ("can", "box")


@dataclass(frozen=True)
class Detection:
    """An object in frame map: `position` is its centre, `size` its full extent, `yaw` about z; `on` its surface.

    `whole`: all of it was in view, so that the position can be trusted; `share`: about how much of it was.
    """

    label: str
    kind: str
    colour: str
    position: Vec3
    yaw: float
    size: Vec3
    confidence: float
    on: str
    distance: float
    known: bool = True
    whole: bool = True
    share: float = 1.0


class Detector(Protocol):
    """What a detector is: made from the scene's vocabulary, then asked view by view."""

    def __init__(self, scene: Scene, max_range: float) -> None: ...

    def detect(self, view: View, robot: Mask | None = None) -> list[Detection]:
        """Objects in a view. `robot` (h, w) marks the pixels that show the robot itself."""
        ...


class ClassicalDetector:
    """Segmentation above surfaces and model fitting."""

    def __init__(self, scene: Scene, max_range: float) -> None:
        self._scene, self._max_range = scene, max_range

    def detect(self, view: View, robot: Mask | None = None) -> list[Detection]:
        found = []
        for piece in segment.pieces(view, self._scene, self._max_range, robot):
            detection = self._explain(view, piece)
            if detection is not None:
                found.append(detection)
        return found

    def _explain(self, view: View, piece: Piece) -> Detection | None:
        rgb = colour.typical(view.rgb[piece.rows, piece.columns])
        height = float(np.percentile(piece.points[:, 2], 98)) - piece.surface.height
        scored = sorted(
            (
                (score, spec, size, fit)
                for spec in self._scene.objects
                for size in _stances(spec)
                for score, fit in self._score(view, piece, spec, size, rgb, height)
            ),
            key=lambda row: row[0],
        )
        if not scored or scored[0][0] > WORST:
            return self._strange(view, piece, rgb, height)
        score, spec, size, fit = scored[0]
        second = next((rival for rival, other, *_ in scored if other is not spec), WORST)
        # Sure when the fit is good and nothing else in the house comes close.
        confidence = math.exp(-0.5 * (score / 2.2) ** 2) * (1 - math.exp(-2.0 * (second - score) - 0.4))
        pixels = min(1.0, len(piece.rows) / 120)
        yaw = fit.yaw
        if spec.kind == "mug":
            yaw = shapes.handle_yaw(size, piece.points, fit.x, fit.y, view.position)
        position = (fit.x, fit.y, piece.surface.height + size[2] / 2)
        return Detection(
            label=spec.name,
            kind=spec.kind,
            colour=spec.colour,
            position=position,
            yaw=yaw,
            size=size,
            confidence=confidence * (0.55 + 0.45 * pixels) * (0.6 if piece.cut else 1.0),
            on=piece.surface.name,
            distance=_distance(view, fit),
            whole=not piece.cut and score < SOUND,
            share=min(1.0, len(piece.rows) / _pixels(view, position, size)),
        )

    def _score(
        self, view: View, piece: Piece, spec: ObjectSpec, size: Vec3, rgb: Array, height: float
    ) -> list[tuple[float, shapes.Fit]]:
        """How badly a thing explains the piece, in standard deviations; empty when it is out of the question."""
        off = colour.difference(rgb, spec.rgba) / COLOUR_SCALE
        tall = abs(height - size[2]) / HEIGHT_SCALE
        if piece.cut:
            tall = min(tall, 1.0)
        if off > WORST or tall > WORST:
            return []
        fit = shapes.fit(spec.kind, size, piece.points, piece.surface.height, view.position, piece.ends)
        return [(math.sqrt((fit.residual / SHAPE_SCALE) ** 2 + tall**2 + off**2), fit)]

    def _strange(self, view: View, piece: Piece, rgb: Array, height: float) -> Detection | None:
        """A thing that is not of the household, by its measured size."""
        if piece.cut or len(piece.rows) < 2 * segment.MIN_PIXELS:
            return None
        low, high = piece.points[:, :2].min(axis=0), piece.points[:, :2].max(axis=0)
        width = float(np.clip(np.max(high - low), 0.02, 0.25))
        size = (width, width, max(0.02, height))
        fits = [shapes.fit(k, size, piece.points, piece.surface.height, view.position) for k in STRANGE_KINDS]
        fit = min(fits, key=lambda f: f.residual)
        word = colour.name(rgb)
        return Detection(
            label=f"{word} thing",
            kind="thing",
            colour=word,
            position=(fit.x, fit.y, piece.surface.height + size[2] / 2),
            yaw=fit.yaw,
            size=size,
            confidence=STRANGE_CONFIDENCE,
            on=piece.surface.name,
            distance=_distance(view, fit),
            known=False,
        )


def _stances(spec: ObjectSpec) -> list[Vec3]:
    """The extents of a thing as it stands, and of a box that lies on one of its sides."""
    x, y, z = spec.size
    return list(dict.fromkeys([(x, y, z), (y, z, x), (z, x, y)])) if spec.kind == "box" else [spec.size]


def _pixels(view: View, position: Vec3, size: Vec3) -> float:
    """How many pixels a thing of that size covers from the front when nothing hides it."""
    scale = view.focal[0] / math.dist(position, view.position)
    return scale * scale * min(size[0], size[1]) * size[2]


def _distance(view: View, fit: shapes.Fit) -> float:
    return math.hypot(fit.x - float(view.position[0]), fit.y - float(view.position[1]))
