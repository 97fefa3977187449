"""CPU time of whole missions in one process, by service and part: `python -m bench.profile --missions 3`.

Milliseconds of CPU per second of robot time, with worker threads and the threads of libraries. It is CPU time, not
wall time, which on a machine that does other work as well says little. What starting takes is told apart. The parts
exclude each other: what a part calls that is a part itself is counted there.
"""

import argparse
import importlib
import os
import sys
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import msgspec

from bench.profile.meter import NOBODY, Meter
from common.bus.base import IoBase
from common.time.lockstep import InProcess

REST = "rest"
JUDGES = (NOBODY, "watch")
"""Who takes part to judge only."""
SMALL = 0.05
"""Parts below this are not shown [ms per robot second]."""
PARTS = {
    "services.sim.physics:Physics.advance": "physics",
    "services.sim.sensors:Sensors.publish_scan": "lidar",
    "services.sim.sensors:Sensors.publish_state": "joints and wheels",
    "services.sim.base:BaseDriver.advance": "drivers",
    "services.sim.drivers:ArmDriver.advance": "drivers",
    "services.sim.contacts:ContactLog.step": "contact log",
    "common.rendering.renderer:Renderer.load": "state",
    "common.rendering.renderer:Renderer.rgbd": "drawing",
    "common.rendering.renderer:Renderer.band": "drawing",
    "common.rendering.renderer:Renderer.surfaces": "drawing",
    "services.camera.sensor:StereoCamera.expose": "sensor model",
    "services.perception.detect:ClassicalDetector.detect": "detection",
    "services.perception.views.self_filter:RobotModel.mask": "its own body",
    "services.perception.views.self_filter:RobotModel.pose": "its own body",
    "services.perception.views.state_buffer:StateBuffer.update": "robot state",
    "services.navigation.localisation.localise:Localiser.predict": "localisation",
    "services.navigation.localisation.localise:Localiser.correct": "localisation",
    "services.navigation.planning.obstacle_layer:ObstacleLayer.see": "costmap",
    "services.navigation.motion.obstacle_tracker:ObstacleTracker.update": "obstacle tracker",
    "services.navigation.motion.navigator:Navigator.step": "navigator",
    "services.navigation.planning.planner:PathPlanner.field": "planning",
    "services.navigation.planning.planner:PathPlanner.path": "planning",
    "services.navigation.search.search:Search.next": "search",
    "common.bus.codec:encode": "encoding",
    "common.bus.codec:decode": "decoding",
    "common.bus.memory:MemoryBus.put": "delivery",
    "common.rendering.offscreen:Offscreen.__init__": "opening GL",
    "common.rendering.renderer:Renderer.__init__": "its model",
    "services.perception.views.self_filter:RobotModel.__init__": "its model",
}
"""Where the parts are, and what each is called; parts of one name are added up."""


@contextmanager
def probes(meter: Meter) -> Iterator[Callable[[], float]]:
    """Every part of the table and every step and job of a service on the meter, while the context lasts.

    What it gives tells the CPU seconds of the process until the first step.
    """
    began, first = time.process_time(), list[float]()
    replaced: list[tuple[Any, str, Any]] = []

    def put(owner: Any, name: str, value: Any) -> None:
        if isinstance(owner, type):
            owner = next(kind for kind in owner.__mro__ if name in vars(kind))
        replaced.append((owner, name, vars(owner)[name]))
        setattr(owner, name, value)

    for where, part in PARTS.items():
        module, _, path = where.partition(":")
        *outer, name = path.split(".")
        owner = importlib.import_module(module)
        for step in outer:
            owner = getattr(owner, step)
        put(owner, name, meter.probe(getattr(owner, name), part))

    submit, join, add, advance = IoBase.submit, InProcess.__init__, InProcess.add, InProcess.advance

    def follow(service: Any, io: Any) -> None:
        service.step = meter.probe(service.step, REST, io.name)
        io.begin = meter.probe(io.begin, "opening mail", io.name)

    def started(world: InProcess, sim: Any, io: Any, clock: Any) -> None:
        follow(sim, io)
        join(world, sim, io, clock)

    def added(world: InProcess, service: Any, io: Any) -> None:
        follow(service, io)
        add(world, service, io)

    advanced = meter.probe(advance, "clock", "lockstep")

    def stepped(world: InProcess) -> float:
        if not first:
            first.append(time.process_time())
        now: float = advanced(world)
        return now

    def submitted(io: IoBase, job: Callable[..., Any], *args: Any, **named: Any) -> Any:
        return submit(io, meter.probe(job, "worker", io.name), *args, **named)

    put(InProcess, "__init__", started)
    put(InProcess, "add", added)
    put(InProcess, "advance", stepped)
    put(IoBase, "submit", submitted)
    try:
        yield lambda: first[0] - began
    finally:
        for owner, name, value in reversed(replaced):
            setattr(owner, name, value)


def strangers() -> float:
    """CPU seconds of the threads that Python does not know: those of GL and of the networks' runtime."""
    known = {str(thread.native_id) for thread in threading.enumerate()}
    spent = 0.0
    for task in Path("/proc/self/task").iterdir():
        if task.name not in known:
            spent += int((task / "schedstat").read_text().split()[0]) / 1e9
    return spent


class Mission(msgspec.Struct):
    """What one mission took: robot time [s], CPU [s] of its start, and of each service and part after that."""

    seed: int
    outcome: str
    robot_seconds: float
    start: float
    spent: dict[str, dict[str, float]]


def case_of(suite: str, seed: int, settings: tuple[str, ...]) -> tuple[str, float]:
    """A case of a suite: outcome and robot time [s]."""
    from evaluation import runner
    from evaluation.suites.table import cases

    (case,) = cases(suite, 1, seed, settings)
    result = runner.run(case)
    return result.outcome, result.sim_seconds


def measure(suite: str, seed: int, settings: tuple[str, ...]) -> Mission:
    """One mission from the start of its services to their end."""
    meter = Meter()
    before = strangers()
    with probes(meter) as at_first:
        outcome, seconds = case_of(suite, seed, settings)
    parts: dict[str, dict[str, float]] = {}
    for (service, part), spent in meter.take().items():
        parts.setdefault(service, {})[part] = spent
    parts["libraries"] = {"threads": strangers() - before}
    return Mission(seed, outcome, seconds, at_first(), parts)


def table(missions: list[Mission]) -> Iterator[str]:
    """The sums over missions by service, largest first, with their parts."""
    robot_seconds = sum(m.robot_seconds for m in missions)
    total: dict[str, float] = defaultdict(float)
    parts: dict[str, dict[str, float]] = defaultdict(lambda: defaultdict(float))
    for mission in missions:
        for service, spent in mission.spent.items():
            total[service] += 1000 * sum(spent.values()) / robot_seconds
            for part, seconds in spent.items():
                parts[service][part] += 1000 * seconds / robot_seconds

    def by_share(row: tuple[str, float]) -> float:
        return -row[1]

    judge = sum(total.pop(name, 0.0) for name in JUDGES)
    yield f"{'service':14} {'part':22} {'ms of CPU a robot second':>25}"
    for service, milliseconds in sorted(total.items(), key=by_share):
        yield f"{service:14} {'':22} {milliseconds:25.1f}"
        for part, share in sorted(parts[service].items(), key=by_share):
            if share >= SMALL:
                yield f"{'':14} {part:22} {share:25.1f}"
    yield f"{'the robot':14} {'':22} {sum(total.values()):25.1f}"
    yield f"{'judge':14} {'not the robot':22} {judge:25.1f}"
    start = sum(m.start for m in missions) / len(missions)
    yield f"{'start':14} {'once a mission':22} {start:23.1f} s"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--suite", default="fetch", help="of `tidybot eval` (default %(default)s)")
    parser.add_argument("--missions", type=int, default=3, metavar="N", help="(default %(default)s)")
    parser.add_argument("--seed", type=int, default=7, help="of the first (default %(default)s)")
    parser.add_argument("--set", action="append", default=[], metavar="section.key=value")
    parser.add_argument("--json", action="store_true", help="a line for each mission instead of the table")
    args = parser.parse_args()
    missions = []
    for seed in range(args.seed, args.seed + args.missions):
        mission = measure(args.suite, seed, tuple(args.set))
        missions.append(mission)
        if args.json:
            print(msgspec.json.encode(mission).decode(), flush=True)
        else:
            print(f"seed {seed}: {mission.outcome} after {mission.robot_seconds:.1f} s", file=sys.stderr, flush=True)
    if not args.json:
        print("\n".join(table(missions)), flush=True)


if __name__ == "__main__":
    main()
    # Not through the interpreter's own end: threads of the speech and picture libraries do not survive it.
    os._exit(0)
