"""Ten minutes of driving with drifting wheels: navigation's pose against the truth, plain odometry as the peer.

`python -m bench.localisation --seconds 600 --seeds 1`. Exit 1 when an error is above 5 cm or 3 degrees RMS.
"""

import argparse
import math
import sys
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bench.driving import Driver
from common.geometry import wrap
from common.time.lockstep import DT

LIMIT, LIMIT_ANGLE = 0.05, math.radians(3.0)
"""Errors [m, rad] beyond which a pose counts as wrong; chosen."""
PERIOD = 5
"""Ticks between two samples: 20 Hz."""


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
    estimate, still, wheels = Errors("navigation/pose"), Errors("the same, at rest at goals"), Errors("base/odom")
    travelled, failed, last = 0.0, 0, robot.base()
    status, told = robot.status(), 0.0
    while robot.now < seconds:
        if status.status != "navigating":
            failed += status.status == "failed"
            robot.goal(f"goto {rng.choice(goals)}")
        robot.advance(PERIOD * DT)
        status, true, pose = robot.status(), robot.base(), robot.pose()
        travelled += math.dist(last[:2], true[:2])
        last = true
        estimate.add(pose, true)
        wheels.add(robot.odometry(), true)
        if status.status == "arrived":
            still.add(pose, true)
        if robot.now - told >= 60.0:
            told = robot.now
            print(
                f"  {told:.0f} s: {estimate.rms()[0] * 100:.2f} cm, wheels {wheels.rms()[0] * 100:.1f} cm", flush=True
            )
    print(f"seed {seed}: {robot.number} goals, {failed} failed, {travelled:.0f} m in {robot.now:.0f} s")
    return [estimate, still, wheels], robot


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--set", action="append", default=[], metavar="section.key=value")
    args = parser.parse_args()
    bad = 0
    for seed in range(args.first, args.first + args.seeds):
        errors, robot = drive(seed, args.seconds, tuple(args.set))
        print(f"{'':28} {'n':>6} {'rms cm':>8} {'max cm':>8} {'rms deg':>8} {'max deg':>8}")
        for one in errors:
            print(one.line())
        mean, high = np.mean(robot.timed.seconds) * 1000, np.percentile(robot.timed.seconds, 99) * 1000
        print(f"navigation step {mean:.2f} ms mean, {high:.1f} ms p99")
        distance, angle = errors[0].rms()
        bad += distance > LIMIT or angle > LIMIT_ANGLE
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
