"""Perception on random views: `python -m bench.perception --views 200`.

Each view shows a random layout from a random place before a segment of furniture, by the sensor's model. The table
compares what is detected with the simulation's own poses, and asks for things that are not there. The peer gets the
same pixels of each thing and takes the middle of the visible points and the nearest colour for its answer.
"""

import argparse
import math
import sys
import time
from dataclasses import dataclass, field

import numpy as np

from bench.perception import unlisted
from bench.perception.views import RANGE, take_all, visible
from common.household import told
from common.messages import WorldObject
from common.scene import Scene, load_scene
from services.perception.detect import ClassicalDetector
from services.perception.grounding import ground
from services.perception.segments import segmentation
from services.perception.views import colour
from services.perception.views.view import View
from services.sim.layout import Placement

NEAR = 0.10
"""Distance [m] to the truth that counts as found."""
MIN_CONFIDENCE = 0.5
"""Detections below it are not told to others and not counted."""


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


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--views", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--width", type=int, default=640)
    parser.add_argument("--height", type=int, default=480)
    parser.add_argument("--sensors", choices=("bought", "ideal"), default="bought", help="the camera's (bought)")
    parser.add_argument("--pose-noise", type=float, default=0.0, help="of the robot's own pose [m and rad]")
    parser.add_argument("--backend", default="auto", choices=("auto", "egl", "osmesa", "raycast"))
    parser.add_argument("--verbose", "-v", action="store_true", help="name every mistake")
    parser.add_argument("--unknown", choices=unlisted.VIEWED, help="worlds that perception is not told about")
    args = parser.parse_args()
    if args.unknown:
        unlisted.measure(args)
        return 0
    scene = load_scene("apartment")
    household = told(scene)
    detector = ClassicalDetector(household, 3.5)
    ours, peer = Score(), Score()
    seen = total = false = absent = abstained = 0
    seconds: list[float] = []
    for view, placements in take_all(args, scene):
        began = time.thread_time()
        found = detector.detect(view)
        seconds.append(time.thread_time() - began)
        seen += 1
        for p in placements:
            if not visible(view, p):
                continue
            total += 1
            near = [d for d in found if math.dist(d.position[:2], p.position[:2]) < NEAR]
            best = min(near, key=lambda d: math.dist(d.position, p.position), default=None)
            if best is not None:
                ours.errors.append(math.dist(best.position, p.position))
                ours.right += best.label == p.spec.name
            if args.verbose and (best is None or best.label != p.spec.name):
                print(f"view {seen}: {p.spec.name} was taken for {best.label if best else 'nothing'}")
            other = naive(view, scene, p)
            if other is not None:
                peer.errors.append(other[0])
                peer.right += other[1]
        false += sum(all(math.dist(d.position[:2], p.position[:2]) > 0.12 for p in placements) for d in found)
        # Ask for the things of the household that are certainly not in the picture.
        world = [
            WorldObject(label=d.label, kind=d.kind, colour=d.colour, position=d.position, on=d.on, id=str(n))
            for n, d in enumerate(found)
            if d.confidence >= MIN_CONFIDENCE
        ]
        for p in placements:
            u, v, z = (float(a) for a in view.project(np.array([p.position]))[0])
            if z <= 0.0 or not (-60 < u < args.width + 60 and -60 < v < args.height + 60):
                absent += 1
                abstained += ground(p.spec.name, world, household, (0.0, 0.0, 0.0), {}).found is None
    print(f"{seen} views, {total} visible objects within {RANGE:.0f} m, {args.width} x {args.height}")
    print(f"{'':28} {'found':>7} {'named':>7} {'median cm':>9} {'mean':>7} {'p95':>7}")
    print(ours.row("fitted models", total))
    print(peer.row("middle of points and colour", total))
    print(
        f"asked for what is not in view: abstained {abstained / max(1, absent):.3f} of {absent}; false objects: {false}"
    )
    print(f"CPU time a view: median {np.median(seconds) * 1e3:.0f} ms, p95 {np.percentile(seconds, 95) * 1e3:.0f} ms")
    return 0


if __name__ == "__main__":
    sys.exit(main())
