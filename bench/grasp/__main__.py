"""Reach, grasp, lift, carry and put down in real physics, per kind of object: `python -m bench.grasp --trials 10`.

The base stands where navigation would put it, off by a random error; the peer is the same code with one candidate only.
With `--unknown` the objects are drawn, lying or standing, alone or in a crowd, and known by what a camera sees of them.
"""

import argparse
import sys
from collections import Counter
from collections.abc import Callable

import numpy as np

from bench.grasp import unlisted
from bench.grasp.hand import Bench
from bench.grasp.tools import TOOLS
from common.kinds import KINDS
from common.scene import ObjectSpec, Scene, load_scene
from evaluation.report.statistics import percent
from services.manipulation.config import ManipulationConfig


def trial(scene: Scene, spec: ObjectSpec, seed: int, config: ManipulationConfig) -> str:
    """`ok`, or the stage and reason of the failure."""
    rng = np.random.default_rng([seed, 3])
    bench = Bench(scene, spec, float(rng.uniform(0.45, 0.76)), seed, config)
    bench.stand(bench.before_it(rng))
    return bench.there_and_back()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=10)
    parser.add_argument("--seed", type=int, default=0, help="the first of the trials' seeds")
    parser.add_argument("--kinds", default="", help="some of the kinds, or of the shapes with --unknown")
    parser.add_argument("--peer", action="store_true", help="also run with a single candidate grasp")
    parser.add_argument("--unknown", action="store_true", help="shapes that are drawn, known by what is seen of them")
    args = parser.parse_args()
    scene = load_scene("apartment")
    specs = {o.kind: o for o in reversed(scene.objects)}
    configs = {"full": ManipulationConfig()}
    if args.peer:
        configs["one candidate"] = ManipulationConfig(max_candidates=1)

    def known(kind: str, config: ManipulationConfig) -> Callable[[int], str]:
        return lambda seed: trial(scene, specs[kind], seed, config)

    def drawn(shape: str, config: ManipulationConfig) -> Callable[[int], str]:
        return lambda seed: unlisted.trial(scene, shape, seed, config)

    names = [*unlisted.SHAPES, *TOOLS] if args.unknown else [k for k in KINDS if k in specs]
    chosen = args.kinds.split(",") if args.kinds else list(names)
    if wrong := [kind for kind in chosen if kind.partition(" +")[0] not in {*names}]:
        parser.error(f"there is no {', '.join(wrong)}; there are: {', '.join(names)}")
    make, failed = drawn if args.unknown else known, False
    print(f"{'kind':14} {'variant':14} {'ok':>5} {'of':>4} {'95 %':>12}  failures")
    for kind in chosen:
        for name, config in configs.items():
            run = make(kind, config)
            outcomes = Counter(run(args.seed + n) for n in range(args.trials))
            good = outcomes.pop("ok", 0)
            failed |= good < args.trials and name == "full"
            share = percent(good, args.trials)
            print(f"{kind:14} {name:14} {good:5} {args.trials:4} {share:>12}  {dict(outcomes) or ''}", flush=True)
    sys.exit(int(failed))


if __name__ == "__main__":
    main()
