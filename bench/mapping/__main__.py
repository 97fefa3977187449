"""Mapping against the truth: errors of walls and surfaces, what was missed, and how long exploring took.

`python -m bench.mapping --homes 3 --seed 20000`; `--apartment` for the shipped flat, `--world DIR` for worlds of yours.
Exit 1 when the median of a kind of error is above its aim, or something was hit. With `--out DIR` the maps are kept,
each with its world and cases: `tidybot eval --world DIR` then gives missions in homes that the robot has mapped itself.
"""

import argparse
import shutil
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from common import messages as m
from common.files.map_file import HOUSEHOLD
from common.files.plan_file import to_toml
from common.household import load_household
from common.scene import load_scene
from evaluation.homes.explore import Explored, explore
from evaluation.homes.map_errors import HEIGHT, OUTLINE, WALL, Errors, centimetres, compare
from evaluation.homes.suite import homes
from evaluation.stack import Stack
from evaluation.suites.worlds import CASES, WORLD, worlds


def say(stack: Stack, status: m.MappingStatus) -> None:
    """Print how far exploring has come, once a minute."""
    if round(stack.now) % 60 == 0:
        words = f"{stack.now:5.0f} s {status.phase}, {status.area:.1f} m2, {status.frontiers} left"
        print(f"    {words}, {status.keyframes} keyframes {status.detail}", flush=True)


def line(name: str, explored: Explored, errors: Errors, wall_seconds: float) -> str:
    """One row of the table."""

    def cm(values: object, share: float) -> str:
        found = centimetres(values, share)
        return f"{found[0]:.1f}/{found[1]:.1f}" if found else "-"

    total = errors.found + len(errors.missed)
    return (
        f"{name:12} {explored.status.phase:9} {explored.status.area:5.1f} m2 {explored.seconds:5.0f} s  walls "
        f"{cm(errors.walls, 0.9)} cm {errors.covered:.0%}  heights {cm(errors.heights, 1.0)}  outlines "
        f"{cm(errors.outlines, 1.0)}  surfaces {errors.found} of {total}, {len(errors.extra)} extra  "
        f"hits {len(explored.hits)}  ({wall_seconds:.0f} s)"
    )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--homes", type=int, help="homes of the generator (default 2; 0 with --world)")
    parser.add_argument("--seed", type=int, default=20000, help="of the first (default %(default)s)")
    parser.add_argument("--apartment", action="store_true", help="the shipped flat as well")
    parser.add_argument("--world", type=Path, metavar="DIR", help="the worlds there (docs/WORLDS.md)")
    parser.add_argument("--out", type=Path, help="keep the maps there")
    args = parser.parse_args()
    scenes = [("apartment", load_scene("apartment"))] if args.apartment else []
    outside = worlds(args.world) if args.world else []
    scenes += [(found.name, found.world) for found in outside]
    for seed in range(args.seed, args.seed + (args.homes if args.homes is not None else 0 if outside else 2)):
        scene = homes(seed).scene
        assert scene is not None
        scenes.append((f"home {seed}", scene))
    print("errors as median/90 % (walls) and median/worst; aims: walls 3 cm, heights 1 cm, outlines 5 cm")
    listed = {found.name: found.cases for found in outside if found.cases}
    good = True
    with tempfile.TemporaryDirectory() as kept:
        for name, scene in scenes:
            out = (args.out or Path(kept)) / name.replace(" ", "_")
            began = time.monotonic()
            out.mkdir(parents=True, exist_ok=True)
            (out / WORLD).write_text(to_toml(scene), encoding="utf-8")
            if name in listed:
                shutil.copyfile(listed[name], out / CASES)
            explored = explore(scene, args.seed, out, tell=say)
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
