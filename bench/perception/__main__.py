"""Perception on random views: `python -m bench.perception --views 200`, `--unknown sizes` for things nobody listed.

Each view shows a random layout from a random place before a segment of furniture, by the sensor's model.
"""

import argparse
import sys
import time

import numpy as np

from bench.perception.listed import Listed
from bench.perception.unlisted import VIEWED, Unlisted
from bench.perception.views import add_options


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--views", type=int, default=200)
    add_options(parser, pose_noise=0.0)
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
