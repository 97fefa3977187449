"""Fetch missions in one process, a seed each: `python -m bench.fetch --seeds 20`. Exit 1 unless all were delivered."""

import argparse
import sys

from bench.mission import Robot, fetch
from evaluation.statistics import share

ITEMS = ("red mug", "green can", "blue bottle", "apple", "yellow block", "orange box")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--set", action="append", default=[], metavar="section.key=value")
    parser.add_argument("--verbose", action="store_true")
    args = parser.parse_args()
    print(f"{'seed':>4} {'item':14} {'claimed':10} {'false':>5} {'robot s':>8} {'wall s':>7} {'speed':>6}  physics")
    good = false = 0
    for seed in range(args.first, args.first + args.seeds):
        item = ITEMS[seed % len(ITEMS)]
        robot = Robot(seed=seed, settings=tuple(args.set), log_level="info" if args.verbose else "error")
        outcome = fetch(robot, item, seed)
        robot.close()
        good += not outcome.objections
        false += outcome.false_claims
        speed = outcome.robot_seconds / outcome.wall_seconds
        physics = "; ".join([*outcome.objections, outcome.reason]) if outcome.objections else "delivered"
        print(
            f"{seed:4} {item:14} {outcome.claimed:10} {outcome.false_claims:5} {outcome.robot_seconds:8.1f} "
            f"{outcome.wall_seconds:7.1f} {speed:5.1f}x  {physics}",
            flush=True,
        )
    print(f"delivered {share(good, args.seeds)}, false claims {false}")
    return int(good < args.seeds or false > 0)


if __name__ == "__main__":
    sys.exit(main())
