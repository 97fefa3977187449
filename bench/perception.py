"""Perception on random views: `python -m bench.perception --views 200`.

Each view shows a random layout from a random place before a segment of furniture, by the sensor's model. The table
compares what is detected with the simulation's own poses, and asks for things that are not there. The peer gets the
same pixels of each thing and takes the middle of the visible points and the nearest colour for its answer.
"""

import argparse
import math
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from bench import unknown_objects
from common.geometry import Pose2
from common.household import told
from common.messages import WorldObject
from common.rendering.renderer import Renderer
from common.scene import Receptacle, Scene, body_name, load_scene
from services.camera.sensor import StereoCamera
from services.perception import colour, segmentation
from services.perception.detect import ClassicalDetector
from services.perception.grounding import ground
from services.perception.view import View
from services.sim.layout import Placement, place_objects
from services.sim.model import own
from services.sim.world import world_mjcf

RANGE, MARGIN, NEAR = 3.0, 12, 0.10
"""Depth [m] up to which, and margin of the picture [px] within which an object must be seen; distance [m] to the truth
that counts as found."""
VIEWS_PER_LAYOUT = 5
"""Standing places for each layout."""
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


def stand(rng: np.random.Generator, scene: Scene, placement: Placement) -> Pose2 | None:
    """A place before the furniture of an object, roughly facing it; None when that is in another room."""
    r = scene.receptacle(placement.on)
    assert r is not None
    x, y = _before(rng, r)
    if scene.room_at(x, y) is not scene.room_at(r.center[0], r.center[1]):
        return None
    facing = math.atan2(placement.position[1] - y, placement.position[0] - x)
    return x, y, facing + float(rng.uniform(-0.4, 0.4))


def _before(rng: np.random.Generator, r: Receptacle) -> tuple[float, float]:
    ax, ay = r.approach[int(rng.integers(len(r.approach)))]
    ux, uy = r.outline.direction(ax, ay)
    distance = (r.size[0] if ax else r.size[1]) / 2 + rng.uniform(0.4, 1.6)
    side = rng.uniform(-0.6, 0.6)
    return float(r.center[0] + ux * distance - uy * side), float(r.center[1] + uy * distance + ux * side)


def views(args: argparse.Namespace, scene: Scene) -> Iterator[tuple[View, list[Placement]]]:
    """Views with what stands in the flat."""
    rng = np.random.default_rng(args.seed)
    made = 0
    while made < args.views:
        placements = place_objects(scene, int(rng.integers(1 << 30)))
        renderer = Renderer(world_mjcf(scene, placements), args.backend)
        for _ in range(VIEWS_PER_LAYOUT):
            pose = stand(rng, scene, placements[int(rng.integers(len(placements)))])
            if pose is not None and made < args.views:
                made += 1
                yield take(renderer, pose, args, rng), placements
        renderer.close()


def take(
    renderer: Renderer,
    pose: Pose2,
    args: argparse.Namespace,
    rng: np.random.Generator,
    camera: StereoCamera | None = None,
) -> View:
    """The view of the head camera with the base at `pose`, by `camera` or else by any camera of the kind."""
    model, data = renderer.model, renderer.data
    names = ("base_x", "base_y", "base_yaw", *(f"joint_{i}" for i in range(1, 8)))
    for name, value in zip(names, (*pose, *own().home), strict=True):
        data.qpos[model.joint(name).qposadr[0]] = value
    renderer.load(data.qpos.copy().tobytes(), b"")
    rgb, depth = renderer.rgbd("head", args.width, args.height)
    focal = renderer.focal("head", args.height)
    if args.sensors == "bought":
        surfaces = renderer.surfaces("head", args.width, args.height)
        camera = camera or StereoCamera(int(rng.integers(2**32)))
        taken = camera.expose(rgb, depth, focal, int(rng.integers(2**31)), surfaces)
        rgb, depth = taken.rgb, taken.depth / 1000.0
    position, rotation = renderer.optical_pose("head")
    # Where the robot believes to be is a little off.
    x, y, theta = (v + float(rng.normal(0.0, args.pose_noise)) for v in pose)
    c, s = math.cos(theta), math.sin(theta)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return View(
        rgb=rgb,
        depth=(np.round(np.maximum(depth, 0.0) * 1000) / 1000).astype(np.float32),
        focal=(focal, focal),
        middle=(args.width / 2, args.height / 2),
        position=turn @ position + np.array([x, y, 0.0]),
        rotation=turn @ rotation,
    )


def look_at(
    args: argparse.Namespace,
    renderer: Renderer,
    chosen: Placement,
    placements: list[Placement],
    rng: np.random.Generator,
) -> View | None:
    """A view of an object of a world that is the shipped flat with other objects; None from another room."""
    for p in placements:
        row = renderer.model.joint(body_name(p.spec)).qposadr[0]
        renderer.data.qpos[row : row + 7] = (*p.position, *p.quat)
    pose = stand(rng, load_scene("apartment"), chosen)
    return take(renderer, pose, args, rng) if pose is not None else None


def visible(view: View, placement: Placement) -> bool:
    """Its centre is in the picture, not far, and nothing stands before it."""
    u, v, z = (float(a) for a in view.project(np.array([placement.position]))[0])
    h, w = view.shape
    if not (MARGIN < u < w - MARGIN and MARGIN < v < h - MARGIN and 0.0 < z < RANGE):
        return False
    return abs(float(view.depth[int(v), int(u)]) - z) < 0.09


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
    parser.add_argument("--unknown", choices=unknown_objects.SUITES, help="worlds that perception is not told about")
    args = parser.parse_args()
    if args.unknown:
        unknown_objects.measure(args, partial(look_at, args), visible)
        return 0
    scene = load_scene("apartment")
    household = told(scene)
    detector = ClassicalDetector(household, 3.5)
    ours, peer = Score(), Score()
    seen = total = false = absent = abstained = 0
    seconds: list[float] = []
    for view, placements in views(args, scene):
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
