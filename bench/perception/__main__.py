"""Perception on random views: `python -m bench.perception --views 200`, `--unknown sizes` for things nobody listed.

Each view shows a random layout from a random place before a segment of furniture, by the sensor's model.
"""

import argparse
import sys
import time

import numpy as np

from bench.perception.listed import Listed
from bench.perception.unlisted import VIEWED, Unlisted


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
    parser.add_argument("--unknown", choices=VIEWED, help="worlds that perception is not told about")
    args = parser.parse_args()
    measure = Unlisted(args) if args.unknown else Listed(args)
    seconds: list[float] = []
    for looked in measure.views():
        began = time.thread_time()
        found = looked.detector.detect(looked.view)
        seconds.append(time.thread_time() - began)
        measure.add(looked, found)
    measure.show()
    print(f"CPU time a view: median {np.median(seconds) * 1e3:.0f} ms, p95 {np.percentile(seconds, 95) * 1e3:.0f} ms")
    return 0


if __name__ == "__main__":
    sys.exit(main())
