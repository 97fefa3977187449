"""Determinism: whether a seed's run is the same every time, in one process and with every process real.

`python -m bench.determinism --seed 3 --runs memory,memory,processes,processes`; exit 1 when a trajectory differs.
With MUJOCO_GL=disable in the environment pictures are cast, which takes longer.
Prints a hash of all physics and joint states of each run and, of two that differ, the first message that does. With
`--faults` messages are dropped, doubled, late and out of order, by the same seed.
"""

import argparse
import sys
import tempfile
import time
from collections.abc import Sequence
from functools import partial
from itertools import zip_longest
from pathlib import Path
from typing import TypeVar

import msgspec
import numpy as np

from bench.determinism.witness import Sight, Trace, WitnessService
from cli.processes.own_robot import own_robot
from cli.processes.plan import Plan
from cli.processes.services import Service
from cli.processes.supervision import Supervision
from cli.processes.up import bring_up
from common.rendering.backend import choose
from evaluation.case import Case
from evaluation.faults.messages import Rule, faulty
from evaluation.node import CASE
from evaluation.stack import Stack
from evaluation.suites.chaos import MISTREATED, TRAFFIC

T = TypeVar("T")
WALL_LIMIT, NODE = 1800.0, "evaluation.node"
"""Wall time [s] for a run, and the module that runs a service with injected faults."""


def in_memory(args: argparse.Namespace) -> Trace:
    """Run every service in this process."""
    harm = rules(args)
    swaps = {rule.service: partial(faulty, rules=harm) for rule in harm}
    robot = Stack(args.scene, args.seed, settings(args), without=tuple(args.without.split(",")), swaps=swaps)
    try:
        witness: WitnessService = robot.join(WitnessService)
        while witness.trace is None:
            robot.tick()
        return witness.trace
    finally:
        robot.close()


def in_processes(args: argparse.Namespace) -> Trace:
    """`tidybot up --speed max` with the witness as one more participant.

    Raises:
        TimeoutError: the run did not end.
    """
    with tempfile.TemporaryDirectory(prefix="tidybot-determinism-") as name:
        directory = Path(name)
        trace = directory / "trace.json"
        supervision = Supervision(directory / "run")
        options = own_robot(
            "twice",
            seed=args.seed,
            without=f"{args.without},dashboard".strip(","),
            settings=[s for s in settings(args) if not s.startswith("witness.")],
            scene=args.scene,
        )
        plan = Plan(options)
        harm = rules(args)
        harmed = {rule.service for rule in harm}
        services = [msgspec.structs.replace(s, module=NODE) if s.name in harmed else s for s in plan.services]
        plan.pace([*services, Service("witness", "bench.determinism.witness")])
        case = directory / "case.json"
        case.write_bytes(msgspec.json.encode(case_of(args, harm)))
        own = {f"TIDYBOT__{k.upper().replace('.', '__')}": v for k, _, v in (s.partition("=") for s in settings(args))}
        plan.environ = {
            **plan.environ,
            **{k: v for k, v in own.items() if k.startswith("TIDYBOT__WITNESS__")},
            "TIDYBOT__WITNESS__TRACE": str(trace),
            "TIDYBOT_STATE_DIR": str(directory / "state"),
            CASE: str(case),
        }
        try:
            bring_up(supervision, plan, lambda text: None)
            end = time.monotonic() + WALL_LIMIT
            while not trace.exists():
                if time.monotonic() > end:
                    raise TimeoutError(f"no end within {WALL_LIMIT:.0f} s")
                time.sleep(0.2)
            return msgspec.json.decode(trace.read_bytes(), type=Trace)
        finally:
            supervision.stop()


def rules(args: argparse.Namespace) -> tuple[Rule, ...]:
    """Faults of messages for `--faults`: of each kind one, on one key of every service that runs."""
    if not args.faults:
        return ()
    rng = np.random.default_rng([args.seed, 14])
    without = args.without.split(",")

    def one_of(several: Sequence[T]) -> T:
        return several[int(rng.integers(len(several)))]

    return tuple(
        Rule(
            service=service, key=one_of(keys), kind=one_of(MISTREATED), skip=int(rng.integers(2)), count=2, chance=0.7,
            seconds=float(rng.uniform(0.2, 1.0)),
        )
        for (service, _), keys in TRAFFIC.items()
        if service not in without and service not in ("sim", "speech")
    )  # fmt: skip


def case_of(args: argparse.Namespace, harm: tuple[Rule, ...]) -> Case:
    return Case(suite="determinism", seed=args.seed, name="harm", command=args.command, lines=(), rules=harm)


def settings(args: argparse.Namespace) -> tuple[str, ...]:
    said = (f"witness.command={args.command}", f"witness.limit={args.limit}")
    # All draw with what this process can draw with: pictures of two libraries differ in their last bits.
    return ("brain.enable_confirmation=false", f"camera.backend={choose('auto')}", *said, *args.set)


def first_difference(a: Trace, b: Trace) -> str:
    """The first tick whose messages differ, and how."""

    def by_tick(trace: Trace) -> dict[int, list[Sight]]:
        found: dict[int, list[Sight]] = {}
        for sight in trace.sights:
            found.setdefault(sight.tick, []).append(sight)
        return found

    one, other = by_tick(a), by_tick(b)
    for tick in sorted({*one, *other}):
        pairs = zip_longest(one.get(tick, []), other.get(tick, []))
        for x, y in pairs:
            if x is None or y is None or (x.key, x.print) != (y.key, y.print):
                return f"tick {tick}:\n    {_shown(x)}\n    {_shown(y)}"
    return ""


def _shown(sight: Sight | None) -> str:
    return f"{sight.key} {sight.text}" if sight is not None else "nothing more"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", default="memory,memory,processes,processes")
    parser.add_argument("--seed", type=int, default=3)
    parser.add_argument("--scene", default="apartment")
    parser.add_argument("--command", default="bring me the red mug")
    parser.add_argument("--limit", type=float, default=300.0, metavar="S", help="robot time (default %(default)s)")
    parser.add_argument("--without", default="", metavar="A,B", help="leave these services out")
    parser.add_argument("--faults", action="store_true", help="with messages mistreated, by the seed")
    parser.add_argument("--set", action="append", default=[], metavar="section.key=value")
    args = parser.parse_args()
    for rule in rules(args):
        print(f"{rule.kind:9} {rule.service}: {rule.key}, {rule.count} after {rule.skip}")
    print(f"{'run':12} {'robot s':>8} {'wall s':>7} {'messages':>9}  {'hash':16}  outcome")
    traces: list[Trace] = []
    for kind in args.runs.split(","):
        began = time.monotonic()
        trace = in_memory(args) if kind == "memory" else in_processes(args)
        traces.append(trace)
        wall, seconds = time.monotonic() - began, trace.ticks / 100
        row = f"{kind:12} {seconds:8.1f} {wall:7.1f} {len(trace.sights):9}  {trace.hash[:16]}  {trace.outcome}"
        print(row, flush=True)
    different = 0
    for n, trace in enumerate(traces[1:], 2):
        if where := first_difference(traces[0], trace):
            moved = trace.hash != traces[0].hash
            different += moved
            print(f"run {n} differs from run 1 in its {'trajectory' if moved else 'messages only'}, first at {where}")
    print(
        "every trajectory is the same" if not different else f"{different} of {len(traces) - 1} differ from the first"
    )
    return int(different > 0)


if __name__ == "__main__":
    sys.exit(main())
