"""Faults of real processes: SIGKILL, SIGSTOP, a killed router, a full disk.

Whoever supervises the run (supervisord, and the watchdog for what hangs) brings back what was hit, as on a robot.
"""

import contextlib
import os
import resource
import select
import signal
from collections.abc import Callable
from pathlib import Path

from cli.processes.supervision import WORLD, Supervision
from common.process.host import stat_of
from common.time.clock import monotonic
from evaluation.case import Case, TimedFault
from evaluation.faults.reports import FaultReport, Reporter

DEAD = 5.0
"""Wall time [s] for the kernel to end a killed process: a thread in a disk write takes longest, by far under 1 s."""


def unavailable(case: Case) -> str:
    """Why the case cannot be run as processes; "" when it can."""
    if any(s.jump for s in case.timed_faults):
        return "a clock jump: robot time is the simulation's count of steps, which no signal can make leap"
    if case.showing is not None:
        return "a showing before the case, which is in one process"
    if case.explores:
        return "exploring before the case, which is in one process; `tidybot map` explores with processes"
    return ""


class ProcessFaultInjector:
    """Injects the faults of a case into a supervised run, each in its state of the brain, and reports them."""

    def __init__(
        self, supervision: Supervision, faults: tuple[TimedFault, ...], state_dir: Path, report: Reporter
    ) -> None:
        self._supervision, self._waiting, self._report = supervision, list(faults), report
        self._since: dict[str, float] = {}
        self._frozen: list[tuple[float, int]] = []
        self._full: FullDisks | None = None
        self._world = state_dir / WORLD

    def step(self, now: float, state: str) -> None:
        """Inject what is due at robot time `now` with the brain in `state`."""
        self._since.setdefault(state, now)
        for fault in [s for s in self._waiting if now >= self._since.get(s.state, float("inf")) + s.after]:
            self._waiting.remove(fault)
            self._inject(fault, now)
        for row in [r for r in self._frozen if now >= r[0]]:
            self._frozen.remove(row)
            _send(row[1], signal.SIGCONT)
            os.close(row[1])
        if self._full is not None:
            self._full.step(now, self._pids)
            if now >= self._full.until:
                self._end_full(now)

    def finish(self, now: float) -> None:
        """End every fault that still lasts: the case is over."""
        if self._full is not None:
            self._end_full(now)
        for _, process in self._frozen:
            os.close(process)
        self._frozen = []

    def _inject(self, timed: TimedFault, now: float) -> None:
        where = f"in {timed.state}, {timed.after:.2f} s after it began"
        pids = self._pids()
        if timed.full:
            self._full = FullDisks(self._world, now + timed.full)
            self._full.step(now, self._pids)
        pid = pids.get(timed.service)
        if pid is None:
            return
        process = os.pidfd_open(pid)
        if timed.seconds and timed.service != "router":
            if _send(process, signal.SIGSTOP) and _stopped(pid):
                self._report(FaultReport(round(now, 2), "hang", f"{timed.service} (pid {pid}) stopped {where}"))
            self._frozen.append((now + timed.seconds, process))
            return
        if _send(process, signal.SIGKILL) and select.select([process], [], [], DEAD)[0]:
            fault = "router loss" if timed.service == "router" else "kill"
            self._report(FaultReport(round(now, 2), fault, f"{timed.service} (pid {pid}) killed {where}"))
        os.close(process)

    def _pids(self) -> dict[str, int]:
        return {p.name: p.pid for p in self._supervision.processes() if p.pid}

    def _end_full(self, now: float) -> None:
        full, self._full = self._full, None
        assert full is not None
        if full.took_effect():
            self._report(FaultReport(round(now, 2), "disk full", "the simulation could not save its world"))
        full.end(self._pids())


class FullDisks:
    """Full disks: no process of the run can make a file longer, nor can those that start meanwhile.

    A process is limited at the first look after its start: what it writes before that still finds room.
    """

    PERIOD = 0.5
    """Robot time [s] between looks for new processes: the simulation saves its world as often."""

    def __init__(self, world: Path, until: float) -> None:
        self.until, self._world = until, world
        self._next = float("-inf")
        self._saved = -1
        self._before: dict[int, tuple[int, int]] = {}

    def step(self, now: float, pids: Callable[[], dict[str, int]]) -> None:
        if now < self._next:
            return
        if self._before:
            # A write that was under way when the limits came may have ended after them.
            self._saved = self._saved if self._saved >= 0 else _modified(self._world)
        self._next = now + self.PERIOD
        for pid in set(pids().values()) - self._before.keys():
            with contextlib.suppress(ProcessLookupError):
                _, hard = before = resource.prlimit(pid, resource.RLIMIT_FSIZE)
                resource.prlimit(pid, resource.RLIMIT_FSIZE, (0, hard))
                self._before[pid] = before

    def took_effect(self) -> bool:
        """True when the simulation's checkpoint, saved twice a second, was not saved any more."""
        return _modified(self._world) == self._saved

    def end(self, pids: dict[str, int]) -> None:
        for pid in set(pids.values()) & self._before.keys():
            with contextlib.suppress(ProcessLookupError):
                resource.prlimit(pid, resource.RLIMIT_FSIZE, self._before[pid])


def _modified(path: Path) -> int:
    try:
        return path.stat().st_mtime_ns
    except OSError:
        return 0


def _send(process: int, number: signal.Signals) -> bool:
    """Send a signal to the very process that the descriptor was opened for; False when it has ended."""
    try:
        signal.pidfd_send_signal(process, number)
    except ProcessLookupError:
        return False
    return True


def _stopped(pid: int) -> bool:
    """The system says so; every thread stops within a moment of the signal."""
    end = monotonic() + DEAD
    while monotonic() < end and (words := stat_of(pid)):
        if words[0] == "T":
            return True
    return False
