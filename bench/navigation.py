"""Drives among unmapped boxes and walking people: arrivals, touches, detours. `python -m bench.navigation --seeds 10`.

Each seed drives three random goals in each of five situations. Exit 1 after a touch or a wrong outcome.
"""

import argparse
import math
import sys
from dataclasses import dataclass, field
from typing import Any

import msgspec
import numpy as np

from bench.driving import Driver
from common.scene import Obstacle, Scene, load_scene
from services.navigation.config import NavigationConfig
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner

CONFIG = NavigationConfig()
GOALS = 3
"""Places driven to in each layout."""
PATIENCE = 240.0
"""Robot time [s] for one drive."""
ROOM = 1.1
"""Clearance [m] of a point where a passer-by may stand in the way and still leave one."""


class Guide:
    """Paths on the static map, to place obstacles and to judge detours by."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.costmap = Costmap(scene, CONFIG.resolution, 1.0)
        self.planner = PathPlanner(self.costmap, CONFIG.footprint_radius + CONFIG.clearance, CONFIG.inflation)

    def path(self, a: tuple[float, float], b: tuple[float, float]) -> list[tuple[float, float]]:
        return self.planner.path(self.planner.field(*a), a, b) or []

    def free_point(self, rng: np.random.Generator, clearance: float) -> tuple[float, float]:
        while True:
            x, y = rng.uniform(self.scene.low, self.scene.high).tolist()
            if self.costmap.clearance(x, y) > clearance and self.path((0.0, 0.0), (x, y)):
                return x, y


def boxes_on_the_way(guide: Guide, rng: np.random.Generator, goals: list[str]) -> tuple[Obstacle, ...]:
    """A box beside the middle of the way to each goal, where a robot still gets by or around."""
    places = {p.name: (p.x, p.y) for p in guide.scene.places}
    here, boxes = (0.0, 0.0), []
    for n, goal in enumerate(goals):
        path = guide.path(here, places[goal])
        here = places[goal]
        roomy = [p for p in path[20:-20] if guide.costmap.clearance(*p) > ROOM and math.dist(p, (0.0, 0.0)) > 1.0]
        if roomy:
            spot = roomy[int(rng.integers(len(roomy)))]
            size = rng.uniform(0.2, 0.5, 2).tolist()
            boxes.append(
                _obstacle(f"box {n}", kind="box", position=spot, size=(*size, 0.5), yaw=float(rng.uniform(0, 3)))
            )
    return tuple(boxes)


def people(guide: Guide, rng: np.random.Generator, polite: bool, count: int) -> tuple[Obstacle, ...]:
    """Walkers on paths between random points, to and fro."""
    found = []
    for n in range(count):
        while True:
            a, b = guide.free_point(rng, 0.5), guide.free_point(rng, 0.5)
            path = guide.path(a, b)
            if len(path) > 40 and math.dist(a, (0.0, 0.0)) > 1.2:
                break
        found.append(
            _obstacle(
                f"person {n}", position=a, path=tuple(path[10::10]), speed=float(rng.uniform(0.3, 0.8)), repeat=True,
                polite=polite,
            )
        )  # fmt: skip
    return tuple(found)


def _obstacle(name: str, **fields: Any) -> Obstacle:
    return msgspec.convert({"name": name, **fields}, Obstacle)


@dataclass
class Tally:
    name: str
    right: int = 0
    drives: int = 0
    touches: int = 0
    detour: list[float] = field(default_factory=list)
    recoveries: int = 0
    notes: list[str] = field(default_factory=list)
    ms: list[float] = field(default_factory=list)


def drive(
    tally: Tally, seed: int, obstacles: tuple[Obstacle | str, ...], goals: list[str], guide: Guide, expected: str
) -> None:
    """One robot drives the goals one after the other."""
    robot = Driver(seed=seed, obstacles=obstacles)
    for goal in goals:
        start, began, travelled = robot.base(), robot.now, 0.0
        robot.goal(f"goto {goal}")
        last = robot.base()
        while robot.status().status == "navigating" and robot.now - began < PATIENCE:
            robot.advance(0.1)
            here = robot.base()
            travelled += math.dist(here[:2], last[:2])
            last = here
        status = robot.status()
        outcome = status.code if status.status == "failed" else status.status
        tally.drives += 1
        tally.right += outcome == expected
        tally.recoveries += robot.feedback().recoveries
        if outcome != expected:
            tally.notes.append(f"seed {seed}, {goal}: {outcome}: {status.detail}")
        elif expected == "arrived":
            place = next(p for p in guide.scene.places if p.name == goal)
            shortest = 0.05 * len(guide.path((start[0], start[1]), (place.x, place.y)))
            tally.detour.append(max(travelled, shortest) / max(shortest, 0.05))
    for contact in robot.truth()["contacts"]:
        tally.touches += 1
        tally.notes.append(
            f"seed {seed}: {contact['part']} touched {contact['thing']} at {contact['first']:.1f} s "
            f"for {contact['seconds']:.2f} s"
        )
    tally.ms += [1000 * s for s in robot.timed.seconds]
    print(f"  {tally.name}, seed {seed}: {tally.right}/{tally.drives} right, {tally.touches} touches", flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--only", default="", help="situations whose name contains this")
    args = parser.parse_args()
    guide = Guide(load_scene("apartment"))
    doors = tuple(f"box in the {name} door" for name in ("kitchen", "study", "bedroom"))
    tallies = [
        Tally(n)
        for n in ("boxes on the way", "door shut, another way", "every door shut", "polite people", "rude people")
    ]
    chosen = [t for t in tallies if args.only in t.name]
    for seed in range(args.first, args.first + args.seeds):
        for tally in chosen:
            rng = np.random.default_rng([seed, 5])
            goals = rng.permutation([p.name for p in guide.scene.places]).tolist()[:GOALS]
            expected, obstacles = "arrived", ()
            if tally.name == "boxes on the way":
                obstacles = boxes_on_the_way(guide, rng, goals)
            elif tally.name == "door shut, another way":
                obstacles, goals = (doors[int(rng.integers(3))],), ["kitchen", "study", "living room"]
            elif tally.name == "every door shut":
                obstacles, goals, expected = doors, [str(rng.choice(["kitchen", "bedroom", "study"]))], "BLOCKED"
            else:
                obstacles = people(guide, rng, "polite" in tally.name, 2)
            drive(tally, seed, obstacles, goals, guide, expected)
    print(f"{'':24} {'right':>8} {'touches':>8} {'way/shortest':>13} {'recoveries':>11} {'ms/step':>8} {'p99':>6}")
    for t in chosen:
        way = f"{np.mean(t.detour):.2f}" if t.detour else "-"
        print(
            f"{t.name:24} {t.right:4}/{t.drives:<3} {t.touches:8} {way:>13} {t.recoveries:11} "
            f"{np.mean(t.ms):8.2f} {np.percentile(t.ms, 99):6.1f}"
        )
    for t in chosen:
        for note in t.notes:
            print(f"{t.name}: {note}")
    return int(any(t.touches or t.right < t.drives for t in chosen))


if __name__ == "__main__":
    sys.exit(main())
