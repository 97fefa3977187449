"""Ten minutes of driving with drifting wheels: navigation's pose against the truth.

`python -m bench.localisation --seconds 600 --seeds 1`. Exit 1 when an error is above 3 cm or 1.5 degrees RMS.

`--anywhere 10` instead: in so many drawn homes with boxes, chairs and people that their map does not have, the robot is
carried to PLACES places one after the other. Exit 1 when it once believes to be where it is not.
"""

import argparse
import math
import sys
import time
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from common import messages as m
from common import topics
from common.bus import codec
from common.geometry import Rectangle, wrap
from common.scene import Scene
from common.time.lockstep import DT
from common.topic import Topic
from evaluation.homes.floor import Floor
from evaluation.homes.suite import aged
from evaluation.report.statistics import interval
from evaluation.stack import Stack, paced_services

LIMIT, LIMIT_ANGLE = 0.03, math.radians(1.5)
"""Errors RMS [m, rad] that are allowed; chosen: a third of what grasping at a stand-off forgives."""
PLACES = 10
"""Places to which the robot is carried in each home [count]."""
PATIENCE, SETTLED = 20.0, 1.0
"""Time in which it finds itself [s], and for how long it is then watched [s]."""
WRONG, WRONG_ANGLE = 0.15, math.radians(8.0)
"""Errors [m, rad] beyond which it is somewhere else than it believes; chosen: doors are missed from there on."""
PERIOD = 5
"""Ticks between two samples: 20 Hz."""


class Driver(Stack):
    """A robot that only drives. `goal` sends it somewhere, `base` is where it is; `seconds` of CPU of each step."""

    def __init__(self, scene: Scene | str = "apartment", seed: int = 0, settings: tuple[str, ...] = ()) -> None:
        self.goals, self.seconds = 0, list[float]()
        others = tuple(name for name in paced_services() if name != "navigation")
        super().__init__(scene, seed, settings, without=others, swaps={"navigation": self._timed})
        self.advance(0.2)

    def _timed(self, kind: Any) -> Any:
        seconds = self.seconds

        class Timed(kind):  # type: ignore[misc]
            def step(self, now: float) -> None:
                began = time.thread_time()
                super().step(now)
                seconds.append(time.thread_time() - began)

        return Timed

    def goal(self, text: str) -> None:
        self.goals += 1
        self.bus.send(topics.NAVIGATION_GOAL, m.NavigationGoal(goal=text, id=f"drive.{self.goals}"))
        self.advance(0.1)

    def last(self, topic: Topic[Any]) -> Any:
        """The newest message of a topic."""
        return codec.decode(topic, self.bus.last[topic.key])

    def base(self) -> list[float]:
        """Where the base really is."""
        physics = self.sim.physics
        found: list[float] = physics.data.qpos[physics.qpos_at[:3]].tolist()
        return found


@dataclass
class Errors:
    """Offsets from the truth: rows (distance [m], angle [rad])."""

    name: str
    rows: list[tuple[float, float]] = field(default_factory=list)

    def add(self, pose: Any, true: list[float]) -> None:
        self.rows.append((math.hypot(pose.x - true[0], pose.y - true[1]), wrap(pose.theta - true[2])))

    def rms(self) -> tuple[float, float]:
        distance, angle = np.sqrt(np.mean(np.square(self.rows), axis=0)).tolist()
        return distance, angle

    def line(self) -> str:
        distance, angle = self.rms()
        worst, worst_angle = np.abs(self.rows).max(axis=0).tolist()
        return (
            f"{self.name:28} {len(self.rows):6} {distance * 100:8.2f} {worst * 100:8.2f} "
            f"{math.degrees(angle):8.2f} {math.degrees(worst_angle):8.2f}"
        )


def drive(seed: int, seconds: float, settings: tuple[str, ...]) -> tuple[list[Errors], Driver]:
    """Random places and surfaces one after the other for `seconds` of robot time."""
    robot = Driver(seed=seed, settings=settings)
    rng = np.random.default_rng(seed)
    goals = [p.name for p in robot.scene.places]
    goals += [r.name for r in robot.scene.receptacles if r.approach and r.name != robot.scene.delivery]
    estimate, still = Errors("navigation/pose"), Errors("the same, at rest at goals")
    travelled, failed, last = 0.0, 0, robot.base()
    status, told = robot.last(topics.NAVIGATION_STATUS), 0.0
    while robot.now < seconds:
        if status.status != "navigating":
            failed += status.status == "failed"
            robot.goal(f"goto {rng.choice(goals)}")
        robot.advance(PERIOD * DT)
        status, true, pose = robot.last(topics.NAVIGATION_STATUS), robot.base(), robot.last(topics.POSE)
        travelled += math.dist(last[:2], true[:2])
        last = true
        estimate.add(pose, true)
        if status.status == "arrived":
            still.add(pose, true)
        if robot.now - told >= 60.0:
            told = robot.now
            print(f"  {told:.0f} s: {estimate.rms()[0] * 100:.2f} cm", flush=True)
    print(f"seed {seed}: {robot.goals} goals, {failed} failed, {travelled:.0f} m in {robot.now:.0f} s")
    return [estimate, still], robot


def carried(seed: int) -> list[tuple[str, float]]:
    """Kidnap the robot PLACES times in one home: found, unnoticed, wrong or lost, and after how long [s]."""
    case = aged(seed)
    assert case.scene is not None
    robot, rng = Driver(case.scene, seed), np.random.default_rng([seed, 3])
    floor = Floor(case.scene.low, case.scene.high, case.scene.walls)
    outlines = [Rectangle(*o.position, *o.size[:2], o.yaw) for o in case.scene.obstacles if not o.path]
    for outline in (*case.scene.footprints, *outlines):
        floor.take(outline)
    home = case.scene.home
    within = floor.reached((home.x, home.y))
    rows = []
    for _ in range(PLACES):
        pose = (*floor.somewhere(rng, within), float(rng.uniform(-math.pi, math.pi)))
        robot.sim.carry(pose)
        since, noticed = robot.now, False
        while robot.now < since + PATIENCE:
            robot.advance(PERIOD * DT)
            lost = robot.last(topics.POSE).lost
            noticed |= lost
            if (noticed or robot.now > since + PATIENCE / 4) and not lost:
                break
        seconds = robot.now - since
        robot.advance(SETTLED)
        pose_now, true = robot.last(topics.POSE), robot.base()
        off = math.dist((pose_now.x, pose_now.y), true[:2]), abs(wrap(pose_now.theta - true[2]))
        right = off[0] < WRONG and off[1] < WRONG_ANGLE
        rows.append(("lost" if pose_now.lost else "found" if right else "wrong" if noticed else "unnoticed", seconds))
    print(
        f"home {seed}, {len(case.scene.rooms)} rooms: {', '.join(f'{what} {t:.1f} s' for what, t in rows)}", flush=True
    )
    return rows


def anywhere(homes: int, first: int) -> int:
    """Carry the robot about in so many homes; the exit status."""
    rows = [row for seed in range(first, first + homes) for row in carried(seed)]
    for what in ("found", "lost", "unnoticed", "wrong"):
        times = [t for w, t in rows if w == what]
        share = interval(len(times), len(rows))
        took = f", {np.median(times):.1f} s in the middle, {max(times):.1f} at most" if times else ""
        print(f"{what:10} {len(times):4} of {len(rows)} ({share[0]:.0%} to {share[1]:.0%}){took}")
    return int(any(what in ("wrong", "unnoticed") for what, _ in rows))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--set", action="append", default=[], metavar="section.key=value")
    parser.add_argument("--anywhere", type=int, default=0, metavar="HOMES", help="carry it about in so many homes")
    args = parser.parse_args()
    if args.anywhere:
        return anywhere(args.anywhere, args.first)
    bad = 0
    for seed in range(args.first, args.first + args.seeds):
        errors, robot = drive(seed, args.seconds, tuple(args.set))
        print(f"{'':28} {'n':>6} {'rms cm':>8} {'max cm':>8} {'rms deg':>8} {'max deg':>8}")
        for one in errors:
            print(one.line())
        mean, high = np.mean(robot.seconds) * 1000, np.percentile(robot.seconds, 99) * 1000
        print(f"navigation step {mean:.2f} ms mean, {high:.1f} ms p99")
        distance, angle = errors[0].rms()
        bad += distance > LIMIT or angle > LIMIT_ANGLE
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
