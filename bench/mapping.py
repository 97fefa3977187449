"""Mapping against the truth: errors of walls and surfaces, what was missed, and how long exploring took.

`python -m bench.mapping --homes 3 --seed 20000`; `--apartment` for the shipped flat. Exit 1 when the median of a kind
of error is above its aim, or something was hit. With `--out DIR` the maps are kept, each with its world, so that
`tidybot eval --world DIR` gives missions in homes that the robot has mapped itself.
"""

import argparse
import math
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import msgspec
import numpy as np

from common import messages as m
from common import topics
from common.floor_plan import FloorPlan, Receptacle
from common.geometry import Rectangle
from common.household import Household, load_household
from common.map_file import HOUSEHOLD
from common.plan_file import to_toml
from common.scene import Scene, load_scene
from evaluation.homes.suite import homes
from evaluation.stack import Stack
from evaluation.worlds import WORLD
from judge.contacts import ContactBook
from services.mapping.service import MappingService

WALL, HEIGHT, OUTLINE = 0.03, 0.01, 0.05
"""Aims [m]: the distance of a wall's face from the nearest true one, a surface's height, and each of its edges."""
SAME = 0.35
"""Middles of surfaces farther apart [m] are not the same one."""
LIMIT = 1800.0
"""Robot time [s] for one home."""
SPACING = 0.05
"""Between the points of a wall that are compared [m]."""
NOT_NEEDED = ("manipulation", "speech", "planner", "perception", "brain")


class Explored(NamedTuple):
    """How an exploration went: robot time [s], the last status, and what was hit."""

    seconds: float
    status: m.MappingStatus
    hits: list[str]


def explore(scene: Scene, seed: int, out: Path, limit: float = LIMIT, say: bool = False) -> Explored:
    """Map a home in lockstep, all services in this process; the files are in `out`."""
    stack = Stack(
        scene, seed, ("navigation.map=mapping", f"mapping.out={out}"), household=load_household("unmapped"),
        without=NOT_NEEDED,
    )  # fmt: skip
    stack.join(MappingService)
    touches = stack.bus.tap(topics.SIM_CONTACTS)
    book, status = ContactBook(), m.MappingStatus(t=0.0, phase="idle")
    try:
        while stack.now < limit and status.phase not in ("done", "failed"):
            stack.advance(5.0)
            status = msgspec.json.decode(stack.bus.last[topics.MAPPING_STATUS.key], type=m.MappingStatus)
            for payload in touches:
                book.note(msgspec.msgpack.decode(payload, type=m.SimContacts))
            touches.clear()
            if say and round(stack.now) % 60 == 0:
                words = f"{stack.now:5.0f} s {status.phase}, {status.area:.1f} m2, {status.frontiers} left"
                print(f"    {words}, {status.keyframes} keyframes {status.detail}", flush=True)
        if status.phase not in ("done", "failed"):
            stack.bus.send(topics.MAPPING_GOAL, m.MappingGoal(goal="save", id="limit"))
            stack.advance(5.0)
        return Explored(stack.now, status, book.hits())
    finally:
        stack.close()


class Errors(NamedTuple):
    """Of one home [m]; `missed` and `extra` name surfaces, `covered` is the share of true walls that were found."""

    walls: np.ndarray
    covered: float
    heights: list[float]
    outlines: list[float]
    found: int
    missed: list[str]
    extra: list[str]


def compare(made: Household, truth: Scene) -> Errors:
    """What was mapped against what is there."""
    heights, outlines, missed = [], [], []
    left = list(made.receptacles)
    for r in truth.receptacles:
        near = [o for o in left if math.dist(o.center[:2], r.center[:2]) < SAME and bool(o.depth) == bool(r.depth)]
        if not near:
            missed.append(r.name)
            continue
        own = min(near, key=lambda o: math.dist(o.center[:2], r.center[:2]))
        left.remove(own)
        heights.append(abs(_top(own) - _top(r)))
        outlines.append(edge_error(own.outline, r.outline))
    extra = [r.name for r in left if not any(b.outline.contains(*r.center[:2]) for b in truth.furniture)]
    walls, covered = wall_errors(made, truth)
    return Errors(walls, covered, heights, outlines, len(heights), missed, extra)


def _top(r: Receptacle) -> float:
    return r.depth or r.center[2]


def edge_error(a: Rectangle, b: Rectangle) -> float:
    """The mean distance [m] of the corners of two rectangles, in the best order."""

    def corners(r: Rectangle) -> list[tuple[float, float]]:
        half = ((1, 1), (-1, 1), (-1, -1), (1, -1))
        return [r.to_map(i * r.length / 2, j * r.width / 2) for i, j in half]

    one, two = corners(a), corners(b)
    return min(sum(math.dist(one[i], two[(i + k) % 4]) for i in range(4)) / 4 for k in range(4)) / math.sqrt(2)


def wall_errors(made: FloorPlan, truth: FloorPlan) -> tuple[np.ndarray, float]:
    """Distances [m] of the mapped walls' faces from the nearest true face of anything, and the share of the true walls
    that have a mapped face within twice the aim."""
    faces = [face for w in truth.walls for face in _faces(w.footprint)]
    solid = [f for box in truth.footprints for f in _faces(box)]
    errors: list[float] = []
    mapped: list[np.ndarray] = []
    for wall in made.walls:
        pair = _faces(wall.footprint)[:2]
        mapped += pair
        # Of a wall that was seen from one side the other one is a guess.
        errors += list(np.minimum(*(_nearest(p, faces + solid) for p in pair)))
    points = np.concatenate([f for w in truth.walls for f in _faces(w.footprint)[:2]])
    inside = (points > np.array(truth.low) + 0.02).all(axis=1) & (points < np.array(truth.high) - 0.02).all(axis=1)
    free = inside.copy()
    for box in truth.footprints:
        free &= box.grown(0.10).signed_distances(points[:, 0], points[:, 1]) > 0.0
    near = _nearest(points[free], mapped) < 2 * WALL if mapped else np.zeros(1, bool)
    return np.array(errors or [math.inf]), float(np.mean(near))


def _faces(r: Rectangle) -> list[np.ndarray]:
    """Points (n, 2) along the sides of a rectangle, the long ones first."""
    found = []
    for along, across, turned in ((r.length, r.width, False), (r.width, r.length, True)):
        u = np.linspace(-along / 2, along / 2, max(2, int(along / SPACING)))
        for side in (-0.5, 0.5):
            v = np.full(len(u), side * across)
            x, y = r.to_map(v, u) if turned else r.to_map(u, v)
            found.append(np.stack([x, y], axis=1))
    return found


def _nearest(points: np.ndarray, faces: list[np.ndarray]) -> np.ndarray:
    """Distance (n,) of each point from the nearest of the faces, as straight lines between their points."""
    best = np.full(len(points), np.inf)
    for face in faces:
        a, b = face[0], face[-1]
        way = b - a
        share = np.clip((points - a) @ way / max(float(way @ way), 1e-12), 0.0, 1.0)
        np.minimum(best, np.hypot(*(points - a - share[:, None] * way).T), out=best)
    return best


def line(name: str, explored: Explored, errors: Errors, wall_seconds: float) -> str:
    """One row of the table."""

    def cm(values: object, share: float) -> str:
        rows = np.asarray(values, float)
        return f"{np.quantile(rows, share) * 100:.1f}" if rows.size else "-"

    total = errors.found + len(errors.missed)
    return (
        f"{name:12} {explored.status.phase:9} {explored.status.area:5.1f} m2 {explored.seconds:5.0f} s  walls "
        f"{cm(errors.walls, 0.5)}/{cm(errors.walls, 0.9)} cm {errors.covered:.0%}  heights {cm(errors.heights, 0.5)}/"
        f"{cm(errors.heights, 1.0)}  outlines {cm(errors.outlines, 0.5)}/{cm(errors.outlines, 1.0)}  surfaces "
        f"{errors.found} of {total}, {len(errors.extra)} extra  hits {len(explored.hits)}  ({wall_seconds:.0f} s)"
    )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--homes", type=int, default=2, help="homes of the generator (default %(default)s)")
    parser.add_argument("--seed", type=int, default=20000, help="of the first (default %(default)s)")
    parser.add_argument("--apartment", action="store_true", help="the shipped flat as well")
    parser.add_argument("--out", type=Path, help="keep the maps there")
    args = parser.parse_args()
    scenes = [("apartment", load_scene("apartment"))] if args.apartment else []
    for seed in range(args.seed, args.seed + args.homes):
        scene = homes(seed).scene
        assert scene is not None
        scenes.append((f"home {seed}", scene))
    print("errors as median/90 % (walls) and median/worst; aims: walls 3 cm, heights 1 cm, outlines 5 cm")
    good = True
    with tempfile.TemporaryDirectory() as kept:
        for name, scene in scenes:
            out = (args.out or Path(kept)) / name.replace(" ", "_")
            began = time.monotonic()
            out.mkdir(parents=True, exist_ok=True)
            (out / WORLD).write_text(to_toml(scene), encoding="utf-8")
            explored = explore(scene, args.seed, out, say=True)
            errors = compare(load_household(str(out / HOUSEHOLD)), scene)
            print(line(name, explored, errors, time.monotonic() - began), flush=True)
            for words in (
                *explored.hits,
                *(f"missed {n}" for n in errors.missed),
                *(f"extra {n}" for n in errors.extra),
            ):
                print(f"    {words}", flush=True)
            aims = ((errors.walls, WALL), (errors.heights, HEIGHT), (errors.outlines, OUTLINE))
            good &= all(np.median(e) <= aim for e, aim in aims if len(e)) and not explored.hits
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
