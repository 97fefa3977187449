"""Perception of the things that a household lists, in the shipped flat.

The table compares what is detected with the simulation's own poses, and asks for things that are not there. The peer
gets the same pixels of each thing and takes the middle of the visible points and the nearest colour for its answer.
"""

import argparse
import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from bench.perception.views import RANGE, Looked, stand, take, visible
from common.household import told
from common.messages import WorldObject
from common.rendering.renderer import Renderer
from common.scene import Scene, load_scene
from services.perception.detect import ClassicalDetector
from services.perception.detection import Detection
from services.perception.grounding import ground
from services.perception.segments import segmentation
from services.perception.views import colour
from services.perception.views.view import View
from services.sim.layout import Placement, place_objects
from services.sim.world import world_mjcf

NEAR, NOTHING = 0.10, 0.12
"""Distance [m] on the floor plan within which an object was found, and beyond which from all a detection is of none."""
MIN_CONFIDENCE = 0.5
"""Detections below it are not told to others and not counted."""
VIEWS_PER_LAYOUT = 5
"""Standing places for each layout."""
ASIDE = 60
"""How far beyond the picture's edge [px] what is not in view is at least: more than half of the largest object."""


@dataclass
class Score:
    """Errors [m] of what was found, and how many were named right."""

    errors: list[float] = field(default_factory=list)
    right: int = 0

    def row(self, name: str, total: int) -> str:
        e = np.array(self.errors) * 100 if self.errors else np.array([math.nan])
        return (
            f"{name:28} {len(self.errors) / max(1, total):7.3f} {self.right / max(1, total):7.3f} "
            f"{np.median(e):9.2f} {e.mean():7.2f} {np.percentile(e, 95):7.2f}"
        )


def naive(view: View, scene: Scene, placement: Placement) -> tuple[float, bool] | None:
    """The peer: error and rightness for the segment at an object's place."""
    for segment in segmentation.segments(view, scene, RANGE):
        middle = segment.points.mean(axis=0)
        if math.hypot(middle[0] - placement.position[0], middle[1] - placement.position[1]) < NEAR:
            rgb = colour.typical(view.rgb[segment.rows, segment.columns])
            named = min(scene.objects, key=lambda o: colour.difference(rgb, o.rgba))
            return math.dist(middle, placement.position), named.name == placement.spec.name
    return None


class Listed:
    """What perception makes of the household's own things."""

    def __init__(self, args: argparse.Namespace) -> None:
        self._args = args
        self._scene = load_scene("apartment")
        self._household = told(self._scene)
        self._ours, self._peer = Score(), Score()
        self._seen = self._total = self._false = self._absent = self._abstained = 0

    def views(self) -> Iterator[Looked]:
        """Random layouts from random places before the furniture."""
        args, rng, made = self._args, np.random.default_rng(self._args.seed), 0
        detector = ClassicalDetector(self._household, 3.5)
        while made < args.views:
            placements = place_objects(self._scene, int(rng.integers(1 << 30)))
            renderer = Renderer(world_mjcf(self._scene, placements), args.backend)
            for _ in range(VIEWS_PER_LAYOUT):
                pose = stand(rng, self._scene, placements[int(rng.integers(len(placements)))])
                if pose is not None and made < args.views:
                    made += 1
                    yield Looked(take(renderer, pose, args, rng), placements, detector)
            renderer.close()

    def add(self, looked: Looked, found: list[Detection]) -> None:
        """One view, and what was detected in it."""
        view, placements, _ = looked
        self._seen += 1
        for p in placements:
            if visible(view, p):
                self._compare(view, p, found)
        far = [d for d in found if all(math.dist(d.position[:2], p.position[:2]) > NOTHING for p in placements)]
        self._false += len(far)
        self._ask_for_what_is_not_there(looked, found)

    def _compare(self, view: View, p: Placement, found: list[Detection]) -> None:
        self._total += 1
        near = [d for d in found if math.dist(d.position[:2], p.position[:2]) < NEAR]
        best = min(near, key=lambda d: math.dist(d.position, p.position), default=None)
        if best is not None:
            self._ours.errors.append(math.dist(best.position, p.position))
            self._ours.right += best.label == p.spec.name
        if self._args.verbose and (best is None or best.label != p.spec.name):
            print(f"view {self._seen}: {p.spec.name} was taken for {best.label if best else 'nothing'}")
        other = naive(view, self._scene, p)
        if other is not None:
            self._peer.errors.append(other[0])
            self._peer.right += other[1]

    def _ask_for_what_is_not_there(self, looked: Looked, found: list[Detection]) -> None:
        world = [
            WorldObject(label=d.label, kind=d.kind, colour=d.colour, position=d.position, on=d.on, id=str(n))
            for n, d in enumerate(found)
            if d.confidence >= MIN_CONFIDENCE
        ]
        height, width = looked.view.shape
        for p in looked.placements:
            u, v, z = (float(a) for a in looked.view.project(np.array([p.position]))[0])
            if z <= 0.0 or not (-ASIDE < u < width + ASIDE and -ASIDE < v < height + ASIDE):
                self._absent += 1
                self._abstained += ground(p.spec.name, world, self._household, (0.0, 0.0, 0.0), {}).found is None

    def show(self) -> None:
        """Print the table."""
        size = f"{self._args.width} x {self._args.height}"
        print(f"{self._seen} views, {self._total} visible objects within {RANGE:.0f} m, {size}")
        print(f"{'':28} {'found':>7} {'named':>7} {'median cm':>9} {'mean':>7} {'p95':>7}")
        print(self._ours.row("fitted models", self._total))
        print(self._peer.row("middle of points and colour", self._total))
        share = self._abstained / max(1, self._absent)
        print(f"asked for what is not in view: abstained {share:.3f} of {self._absent}; false objects: {self._false}")
