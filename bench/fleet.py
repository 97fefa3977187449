"""One router with the traffic of 1, 5 and 20 robots: its CPU time, what goes through it, and what arrives when.

The traffic is that of a mission, recorded from the services in one process and replayed in real time, robot by robot in
a namespace of its own: one session publishes, one for each service subscribes to what that service reads. Rates and
bytes are of payloads; delays are of `navigation/pose`, from one session to another. The players need more CPU time than
the router: where the machine has none left, delays and losses are theirs too. Meetings are `bench.encounters`.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np
import psutil  # type: ignore[import-untyped]
import zenoh
from zenoh import handlers

from cli.fleet.radio import thinning
from cli.processes.services import NAMES, OPTIONAL
from common import messages as m
from common import topics
from common.bus import codec
from common.bus.session import open_session
from common.security.access import FLEET_READS
from common.time.clock import unix_time
from common.time.lockstep import DT
from evaluation.site import Site, eventually, site
from evaluation.stack import Stack

PROBE = topics.POSE
"""The topic by which arrivals are counted: a stream of some size that several read."""
ROBOTS_A_PROCESS = 5
"""Robots that one player plays [count]; chosen: Python's part in them is far below a core."""
ITEM, LEAD = "red mug", 1.0
"""What the recorded mission is for, and time [s] for all players to begin together."""
READERS = tuple(name for name in NAMES if name != "router" and name not in OPTIONAL)


class Sent(NamedTuple):
    """A message at `t` [s] from the beginning."""

    t: float
    key: str
    payload: bytes


def record(seconds: float) -> list[Sent]:
    """What the services send in the first `seconds` of driving in a mission, with the clock that processes need."""
    robot = Stack(seed=0, settings=("brain.pipeline=fetch",), without=("planner",))
    found: list[Sent] = []
    put = robot.bus.put

    def noted(topic: topics.Topic[Any], payload: bytes, *rest: Any) -> None:
        found.append(Sent(robot.now, topic.key, payload))
        put(topic, payload, *rest)

    robot.bus.put = noted  # type: ignore[method-assign, assignment]
    while robot.state().state != "LISTENING":
        robot.tick()
    del found[:]
    robot.bus.send(topics.SPEECH_TEXT, m.TypedText(text=f"bring me the {ITEM}"))
    while not any(s.key == topics.NAVIGATION_GOAL.key for s in found):
        robot.advance(0.1)
    robot.advance(seconds)
    spoken = next(s.t for s in found if s.key == topics.NAVIGATION_GOAL.key)
    kept = [s._replace(t=s.t - spoken) for s in found if 0 <= s.t - spoken < seconds]
    robot.close()
    return sorted((*kept, *_clock(seconds)), key=lambda s: s.t)


def _clock(seconds: float) -> Iterator[Sent]:
    for tick in range(round(seconds / DT)):
        due = [topics.SIM_CLOCK, *(row for period, row in topics.SLOWER_CLOCKS.items() if tick % period == 0)]
        for row in due:
            yield Sent(tick * DT, row.key, codec.encode(row, m.SimClockTick(t=tick * DT, tick=tick, epoch="e")))


def play(connect: str, file: Path, first: int, number: int) -> None:
    """Play `number` robots from the Unix time given on stdin; prints the number and delays [s] of probes as JSON."""
    script = msgspec.json.decode(file.read_bytes(), type=list[Sent])
    late: list[float] = []

    def arrived(sample: zenoh.Sample) -> None:
        assert sample.attachment is not None
        late.append(unix_time() - float(sample.attachment.to_string()))

    with ExitStack() as stack:
        kept: list[Any] = []
        publishers: list[dict[str, Any]] = []
        for robot in range(first, first + number):
            space = f"robot-{robot}"
            for service in READERS:
                session = stack.enter_context(open_session(connect, space, patience=60))
                clocks = () if service == "sim" else (topics.SIM_CLOCK_20HZ,)
                for topic in (*topics.subscribed(service), *clocks):
                    kept.append(session.declare_subscriber(topic.key, handlers.RingChannel(1)))
            witness = stack.enter_context(open_session(connect, space, patience=60))
            kept.append(witness.declare_subscriber(PROBE.key, handlers.Callback(arrived, indirect=False)))
            speaker = stack.enter_context(open_session(connect, space, patience=60))
            publishers.append({key: speaker.declare_publisher(key) for key in {s.key for s in script}})
        print("ready", flush=True)
        start = float(sys.stdin.readline())
        for sent in script:
            time.sleep(max(0.0, start + sent.t - unix_time()))
            for keys in publishers:
                keys[sent.key].put(sent.payload, attachment=f"{unix_time():.6f}")
        time.sleep(1.0)
        probes = number * sum(s.key == PROBE.key for s in script)
        print(json.dumps({"sent": probes, "late": late}), flush=True)


def measure(here: Site, router: int, file: Path, robots: int, seconds: float) -> str:
    """One row of the table."""
    players = []
    for first in range(0, robots, ROBOTS_A_PROCESS):
        number = min(ROBOTS_A_PROCESS, robots - first)
        words = ["--play", str(file), "--connect", here.connect, "--robots", f"{first},{number}"]
        environ = {**os.environ, "ZENOH_RUNTIME": "(rx: (worker_threads: 1))"}
        command = [sys.executable, "-m", "bench.fleet", *words]
        pipe = subprocess.PIPE
        players.append(subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True, env=environ))
    for player in players:
        assert player.stdout is not None and player.stdout.readline() == "ready\n"
    start = unix_time() + LEAD
    for player in players:
        assert player.stdin is not None
        player.stdin.write(f"{start}\n")
        player.stdin.flush()
    process = psutil.Process(router)
    time.sleep(max(0.0, start - unix_time()))
    before, began = process.cpu_times(), time.perf_counter()
    time.sleep(seconds - 1.0)
    after, wall = process.cpu_times(), time.perf_counter() - began
    answers = [json.loads(player.communicate()[0]) for player in players]
    cpu = (after.user + after.system - before.user - before.system) / wall
    late = np.array([value for answer in answers for value in answer["late"]])
    share = len(late) / sum(answer["sent"] for answer in answers)
    delays = np.percentile(late, [50, 95]) * 1e3 if len(late) else (np.nan, np.nan)
    return f"{100 * cpu:10.0f} % {100 * share:8.1f} % {delays[0]:9.1f} {delays[1]:9.1f}"


def flow(script: list[Sent], seconds: float) -> tuple[float, float, float, float]:
    """Messages a second and Mbit/s of one robot, to the router and from it to all who read."""
    readers = {t.key: sum(t in topics.subscribed(name) for name in READERS) for t in topics.TABLE}
    readers |= {topics.SIM_CLOCK_20HZ.key: len(READERS) - 1, PROBE.key: readers[PROBE.key] + 1}
    sizes = [(len(s.payload), readers.get(s.key, 0)) for s in script]
    to, away = sum(size for size, _ in sizes), sum(size * n for size, n in sizes)
    return (
        len(sizes) / seconds,
        to * 8e-6 / seconds,
        sum(n for _, n in sizes) / seconds,
        away * 8e-6 / seconds,
    )


def over_radio(script: list[Sent], seconds: float, keys: Iterable[str]) -> tuple[float, float]:
    """Messages a second and Mbit/s of these keys that one robot lets out by `tidybot fleet radio`."""
    (rules,) = thinning()
    limits = {rule["key_expr"].removeprefix("**/"): rule["freq"] for rule in rules["rules"]}
    count, bits = 0.0, 0.0
    for key in keys:
        sizes = [len(s.payload) for s in script if s.key == key]
        passed = min(float(len(sizes)), limits.get(key, np.inf) * seconds)
        count += passed
        bits += passed * 8 * float(np.mean(sizes)) if sizes else 0.0
    return count / seconds, bits * 1e-6 / seconds


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--counts", default="1,5,20", help="robots on the router, one row each (default %(default)s)")
    parser.add_argument("--seconds", type=float, default=15.0, help="of replay for each row (default %(default)s)")
    parser.add_argument("--play", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--connect", help=argparse.SUPPRESS)
    parser.add_argument("--robots", help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.play:
        first, number = (int(v) for v in args.robots.split(","))
        play(args.connect, args.play, first, number)
        return
    script = record(args.seconds)
    rate, to, rate_away, away = flow(script, args.seconds)
    print(
        f"one robot: {rate:.0f} messages/s, {to:.2f} Mbit/s to the router; {rate_away:.0f}/s, {away:.2f} Mbit/s from it"
    )
    desk = (*(t.key for t in FLEET_READS if t is not topics.COSTMAP), *(f"service/{n}/health" for n in READERS))
    for who, keys in (("one who reads everything", {s.key for s in script}), ("the fleet's desk", desk)):
        count, bits = over_radio(script, args.seconds, keys)
        print(f"over a radio link, to {who}: {count:.0f} messages/s, {bits:.2f} Mbit/s")
    print(f"{'robots':>6} {'router, core':>12} {'arrived':>10} {'p50 ms':>9} {'p95 ms':>9}", flush=True)
    for count in (int(v) for v in args.counts.split(",")):
        with tempfile.TemporaryDirectory() as folder, site(Path(folder)) as here:
            file = Path(folder) / "script.json"
            file.write_bytes(msgspec.json.encode(script))
            eventually(here.listening, "the router listens")
            row = measure(here, here.processes[0].pid, file, count, args.seconds)
        print(f"{count:6d} {row}", flush=True)


if __name__ == "__main__":
    main()
