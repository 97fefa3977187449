"""Kills processes that hang, so that the supervisor restarts them; a program of each run.

A service shows twice that it lives: by its liveliness token, which a frozen process loses after the router's lease,
and by `service/<name>/health` once a second, which a loop that never returns leaves out.
"""

import os
import sys
from queue import Empty, SimpleQueue
from typing import Any

from cli.errors import CliError
from cli.link import Link, use_keys
from cli.processes.services import SERVICES
from cli.processes.supervision import ProcessState, Supervision, run_dir
from common import messages as m
from common import topics
from common.bus import codec
from common.bus.session import BusError, open_session
from common.process.host import StopSignal, stat_of
from common.security.keys import OFF
from common.time.clock import monotonic, unix_time

FROZEN, STUCK = 2.0, 60.0
"""Silence [s] after which a process without a token is frozen, and one with a token stuck: in lockstep a step may wait
for slow work, such as the first picture on a busy machine."""
IDLE = 1.0
"""Time [s] without processor time: one that still gets some is starved by others, not frozen."""
LOOK = 0.25
"""Period [s] of the watchdog."""


class Pulse:
    """Keeps when each process was last heard and decides whether it hangs. Pure."""

    def __init__(self) -> None:
        self._heard: dict[str, tuple[int, float]] = {}
        self._frozen: dict[int, float] = {}
        self._at_work: dict[str, tuple[int, float, float]] = {}

    def hear(self, name: str, pid: int, now: float) -> None:
        """Note when a health record of a process came."""
        self._heard[name] = pid, now

    def hangs(self, name: str, pid: int, token: bool, stopped: bool, worked: float, now: float) -> str:
        """Why the process `pid` of a service counts as hung; "" while it does not.

        `token`: its liveliness token is there; `stopped`: the system says that it was stopped by a signal;
        `worked`: processor time it has had [s].
        """
        if self._at_work.get(name, ())[:2] != (pid, worked):
            self._at_work[name] = pid, worked, now
        if not stopped:
            self._frozen.pop(pid, None)
        elif now - self._frozen.setdefault(pid, now) >= FROZEN:
            return f"stopped by a signal for {now - self._frozen[pid]:.1f} s"
        known, last = self._heard.get(name, (0, 0.0))
        # Before its first record a process is starting.
        if known != pid:
            return ""
        silent = now - last
        if not token and silent >= FROZEN and now - self._at_work[name][2] >= IDLE:
            return f"frozen: no token, silent for {silent:.1f} s"
        return f"stuck: silent for {silent:.1f} s" if silent >= STUCK else ""


def look(pid: int) -> tuple[bool, float]:
    """Whether a signal has stopped the process, and the processor time it has had [s]."""
    words = stat_of(pid)
    if not words:
        return False, 0.0
    return words[0] == "T", (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def watch(supervision: Supervision, stop: StopSignal) -> None:
    """Kill processes that hang, until told to stop."""
    info, pulse = supervision.info(), Pulse()
    tokens = {s.name for s in SERVICES if s.token}
    use_keys(info.keys or OFF)
    with open_session(info.connect, info.namespace, wait=stop.wait) as session:
        link, records = Link(session, info.connect), SimpleQueue[bytes]()
        kept: Any = session.declare_subscriber(topics.HEALTH.key, lambda s: records.put(s.payload.to_bytes()))
        while not stop.wait(LOOK):
            now = monotonic()
            try:
                while True:
                    record = codec.decode_as(m.Health, records.get_nowait())
                    pulse.hear(record.name, record.pid, now)
            except (Empty, codec.DecodeError):
                pass
            processes = [p for p in supervision.processes() if p.state == "running" and p.pid]
            alive = link.alive()
            for p in processes:
                here = p.name in alive or p.name not in tokens
                if why := pulse.hangs(p.name, p.pid, here, *look(p.pid), now):
                    _end(supervision, p, why)
        kept.undeclare()


def _end(supervision: Supervision, process: ProcessState, why: str) -> None:
    print(f"{unix_time():.1f} {process.name} (pid {process.pid}) is ended: {why}", flush=True)
    supervision.call("supervisor.signalProcess", process.name, "KILL")


def main() -> int:
    stop = StopSignal()
    supervision = Supervision(run_dir(os.environ))
    while not stop.is_set():
        try:
            watch(supervision, stop)
        except (CliError, BusError) as error:
            print(f"{unix_time():.1f} {error}", flush=True)
            stop.wait(LOOK)
    return 0


if __name__ == "__main__":
    sys.exit(main())
