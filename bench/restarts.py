"""Leaks of services that are killed again and again: `python -m bench.restarts --restarts 1000`.

A whole robot under its supervisor. Half of the services is killed with SIGKILL, all at once, until each has come back
N times, while the others live on; then the other half. Before and after each half everything that could have leaked
is counted: processes, sockets, liveliness tokens, shared memory, and file handles and memory of those that lived on.
Exit 1 when something did, or when somebody did not come back.
"""

import argparse
import os
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import msgspec
import psutil  # type: ignore[import-untyped]

from cli.link import Link
from cli.processes.own_robot import own_robot
from cli.processes.plan import Plan
from cli.processes.ports import free_port
from cli.processes.services import SERVICES
from cli.processes.supervision import Supervision
from cli.processes.up import bring_up
from common.bus.session import open_session

PATIENCE, CALM, TRIES = 180.0, 8.0, 10
"""Times [s] for a restart and between two of them, and how often each is tried."""
HALVES = (("speech", "planner", "perception", "camera"), ("sim", "navigation", "manipulation", "brain", "dashboard"))
HANDLES, SHARE, MEGABYTES = 4, 0.2, 25.0
"""What a survivor may hold more of at the end: handles; of its memory a share, and so many MB."""


class Count(msgspec.Struct):
    """A count of what can leak: handles and memory [MB] by process, everything else in sum."""

    processes: int = 0
    strays: int = 0
    listening: int = 0
    connections: int = 0
    half_closed: int = 0
    shared: int = 0
    tokens: list[str] = []
    handles: dict[str, int] = {}
    memory: dict[str, float] = {}


class Robot:
    """The processes of one run, by name."""

    def __init__(self, supervision: Supervision, link: Link, names: Sequence[str]) -> None:
        self.supervision, self.link, self.names = supervision, link, tuple(names)
        self.tokens = {s.name for s in SERVICES if s.token and s.name in names}

    def kill(self, names: Sequence[str]) -> float:
        """SIGKILL to all of them; seconds until every one is alive again as another process.

        Raises:
            TimeoutError: somebody did not come back.
        """
        before = self.supervision.running()
        began = time.monotonic()
        for name in names:
            os.kill(before[name], signal.SIGKILL)
        eventually(lambda: self._back(names, before), f"{', '.join(names)} come back", self.supervision)
        return time.monotonic() - began

    def _back(self, names: Sequence[str], before: dict[str, int]) -> bool:
        now = self.supervision.running()
        if any(now.get(n, 0) in (0, before[n]) for n in names):
            return False
        health = self.link.health()
        return self.tokens <= self.link.alive() and all(n in health and health[n].pid == now[n] for n in names)

    def count(self) -> Count:
        """Sample at everything of this run on the host; once more when one of them ended meanwhile."""
        for _ in range(TRIES):
            try:
                return self._count()
            except psutil.NoSuchProcess:
                time.sleep(1.0)
        return self._count()

    def _count(self) -> Count:
        parent = psutil.Process(self.supervision.pid())
        tree = [parent, *parent.children(recursive=True)]
        found = Count(processes=len(tree), tokens=sorted(self.link.alive()))
        found.shared = sum("zenoh" in p.name for p in Path("/dev/shm").iterdir())
        pids = {p.pid for p in tree} | {os.getpid()}
        found.strays = sum(p.pid not in pids for p in psutil.process_iter() if self._ours(p))
        labels = {pid: name for name, pid in self.supervision.running().items()} | {parent.pid: "supervisor"}
        for p in tree:
            sockets = p.net_connections(kind="tcp")
            found.listening += sum(c.status == psutil.CONN_LISTEN for c in sockets)
            found.connections += sum(c.status == psutil.CONN_ESTABLISHED for c in sockets)
            found.connections += len(p.net_connections(kind="unix"))
            found.half_closed += sum(c.status in (psutil.CONN_CLOSE_WAIT, psutil.CONN_FIN_WAIT2) for c in sockets)
            name = labels.get(p.pid, "watchdog" if "cli.processes.watchdog" in p.cmdline() else "child")
            found.handles[name] = found.handles.get(name, 0) + p.num_fds()
            found.memory[name] = found.memory.get(name, 0.0) + p.memory_info().rss / 1e6
        return found

    def _ours(self, process: Any) -> bool:
        try:
            return bool(process.environ().get("TIDYBOT_RUN_DIR") == str(self.supervision.directory))
        except psutil.Error:
            return False


def eventually(probe: Callable[[], bool], what: str, supervision: Supervision) -> None:
    end = time.monotonic() + PATIENCE
    while not probe():
        failed = [p.name for p in supervision.processes() if p.state == "failed"]
        if failed or time.monotonic() > end:
            raise TimeoutError(f"did not happen: {what}" + (f"; failed: {', '.join(failed)}" if failed else ""))
        time.sleep(0.1)


def leaks(before: Count, after: Count, killed: Sequence[str]) -> list[str]:
    """What has grown between two counts; handles and memory only of processes that lived on."""
    found = [
        f"{field}: {was} -> {now}"
        for field in ("processes", "strays", "listening", "connections", "half_closed", "shared", "tokens")
        if (now := getattr(after, field)) != (was := getattr(before, field))
    ]
    for name in sorted({*before.handles} - {*killed}):
        if after.handles.get(name, 0) > before.handles[name] + HANDLES:
            found.append(f"{name}: {before.handles[name]} -> {after.handles[name]} file handles")
        if after.memory.get(name, 0.0) > before.memory[name] * (1 + SHARE) + MEGABYTES:
            found.append(f"{name}: {before.memory[name]:.0f} -> {after.memory[name]:.0f} MB")
    return found


def show(before: Count, after: Count, killed: Sequence[str]) -> None:
    print(f"  {'':14} {'before':>8} {'after':>8}")
    for field in ("processes", "strays", "listening", "connections", "half_closed", "shared"):
        print(f"  {field:14} {getattr(before, field):8} {getattr(after, field):8}")
    print(f"  {'tokens':14} {len(before.tokens):8} {len(after.tokens):8}")
    print(f"  {'lived on':14} {'handles':>17} {'MB':>17}")
    for name in sorted({*before.handles} - {*killed}):
        handles = f"{before.handles[name]} -> {after.handles.get(name, 0)}"
        print(f"  {name:14} {handles:>17} {f'{before.memory[name]:.0f} -> {after.memory.get(name, 0.0):.0f}':>17}")


def settled(robot: Robot, killed: Sequence[str], before: Count | None = None) -> Count:
    """A count taken once connections and tokens of the dead are gone, or after waiting too long for that."""
    end = time.monotonic() + 4 * CALM
    time.sleep(CALM)
    while True:
        found = robot.count()
        if before is None or not leaks(before, found, killed) or time.monotonic() > end:
            return found
        time.sleep(1.0)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--restarts", type=int, default=50, metavar="N", help="of each service (default %(default)s)")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="stop earlier, half of it for each half")
    args = parser.parse_args()
    # Meant to be killed often: not a crash loop.
    os.environ["TIDYBOT_CRASHES"] = str(10 * args.restarts)
    with tempfile.TemporaryDirectory(prefix="tidybot-restarts-") as directory:
        supervision = Supervision(Path(directory) / "run")
        os.environ["TIDYBOT_STATE_DIR"] = str(Path(directory) / "state")
        plan = Plan(own_robot("restarts", speed="realtime", seed=1, settings=[f"dashboard.port={free_port()}"]))
        try:
            bring_up(supervision, plan, lambda text: None)
            with open_session(plan.connect, plan.namespace) as session:
                return run(Robot(supervision, Link(session, plan.connect), plan.names), args.restarts, args.seconds)
        finally:
            supervision.stop()


def run(robot: Robot, restarts: int, seconds: float) -> int:
    """Kill both halves of the services in turn; the exit status."""
    wrong: list[str] = []
    for half in HALVES:
        robot.kill(half)  # once before counting: the first start of all is another one
        before, times = settled(robot, half), list[float]()
        end = time.monotonic() + seconds / len(HALVES)
        try:
            while len(times) < restarts and time.monotonic() < end:
                times.append(robot.kill(half))
                if len(times) % 50 == 0:
                    print(f"  {len(times)} of {restarts} times {', '.join(half)}", file=sys.stderr, flush=True)
        except TimeoutError as error:
            wrong.append(str(error))
        after = settled(robot, half, before)
        took = f"{sum(times) / len(times):.1f} s on average, {max(times):.1f} s at most" if times else "never"
        print(f"{len(times)} x SIGKILL to {', '.join(half)}; back after {took}")
        show(before, after, half)
        wrong += leaks(before, after, half)
    print("nothing leaked" if not wrong else "leaked:", *wrong, sep="\n  ")
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
