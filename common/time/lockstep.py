"""Lockstep: the simulation advances only when every participant due at a tick has acknowledged it.

`Barrier` is the simulation's side over any transport; `InProcess` steps the same service objects in one process.
Tick k is the robot time k * DT. The simulation publishes the state of tick k, then `sim/clock` k; participants due at
k step and acknowledge; then comes `sim/clock` k + 1. While they step the simulation already works out the state of
k + 1, from what was sent before k: a command reaches the world one tick after it was sent, as over any field bus.
"""

from collections.abc import Callable, Iterable
from typing import Any, Protocol

from common.bus.memory import MemoryIo
from common.time.clock import ManualClock, monotonic

DT = 0.01
"""A tick [s]: fixed by the interface, 100 Hz."""
HUNG = 120.0
"""Wall time [s] after which a participant is not waited for any longer; chosen: twice what the watchdog gives one that
is stuck. Who is still there then is at work, on a machine that is busy."""


class Stepped(Protocol):
    """A service object that is stepped in lockstep."""

    HZ: int

    def step(self, now: float) -> None: ...


def period_of(hz: float) -> int:
    """Ticks between two steps of a service.

    Raises:
        ValueError: the rate does not divide 100 Hz.
    """
    period = round(1 / (hz * DT))
    if period < 1 or abs(period * hz * DT - 1) > 1e-9:
        raise ValueError(f"a rate of {hz} Hz does not divide {1 / DT:.0f} Hz")
    return period


class Barrier:
    """Who takes part, how often each is due, and whose acknowledgement is missing.

    `next_ack(timeout)` returns the next (name, tick, period) or None; a tick of -1 joins, and so does any other of one
    that does not take part.
    """

    AGAIN = 1.0
    """Wall time [s] after which a tick that somebody has not acknowledged is sent again: a message may be lost."""

    def __init__(
        self,
        next_ack: Callable[[float], tuple[str, int, int] | None],
        wait_for: Iterable[str] = (),
        limit: float = HUNG,
        report: Callable[[str], None] = lambda text: None,
    ) -> None:
        self._next_ack, self._limit, self._report = next_ack, limit, report
        self._expected = set(wait_for)
        self._tick = 0
        self.periods: dict[str, int] = {}
        self._acked: dict[str, int] = {}

    def assemble(self, alive: Callable[[], bool] = lambda: True, going_on: bool = False) -> None:
        """Wait until every expected participant has joined; who has not within the limit is reported.

        A busy machine may take longer to start one than any limit, and a world without it would be another one. Only
        one that is `going_on` does so without those that it lost: they may have been ended for good.
        """
        end = monotonic() + self._limit
        while (missing := ", ".join(sorted(self._expected - self.periods.keys()))) and alive():
            if not self._take(0.05) and monotonic() > end:
                if going_on:
                    self._report(f"lockstep goes on without {missing}")
                    break
                self._report(f"lockstep waits for {missing}")
                end = monotonic() + self._limit

    def wait(self, tick: int, gone: Callable[[str], bool], again: Callable[[], None]) -> None:
        """Return when everyone due at `tick` has acknowledged it or left.

        `gone(name)` says that a participant's liveliness token is lost; `again()` repeats the tick, for one that
        was lost on the way.
        """
        self._tick = tick
        started = repeated = 0.0
        while late := self._late(tick):
            if self._take(0.05):
                continue
            now = monotonic()
            started, repeated = started or now, repeated or now
            if now - repeated > self.AGAIN:
                repeated = now
                again()
            for name in late:
                if gone(name):
                    self._leave(name, f"{name} left the lockstep at tick {tick}: its process is gone")
                elif now - started > self._limit:
                    self._leave(name, f"{name} left the lockstep: no answer to tick {tick} in {self._limit:.0f} s")

    def awaits(self, tick: int) -> bool:
        """True when somebody is due at `tick`."""
        return bool(self._late(tick))

    def drain(self) -> None:
        """Take every acknowledgement that has already arrived."""
        while self._take(0.0):
            pass

    def _late(self, tick: int) -> list[str]:
        return [n for n, p in self.periods.items() if tick % p == 0 and self._acked[n] < tick]

    def _take(self, timeout: float) -> bool:
        ack = self._next_ack(timeout)
        if ack is None:
            return False
        name, tick, period = ack
        if tick < 0 or name not in self._acked:
            # Whoever acknowledges takes part: a process that came back never saw the clock stand still.
            self.periods[name] = max(1, period)
            self._acked[name] = self._tick
        else:
            # A tick that is not reached yet was one of an earlier simulation.
            self._acked[name] = max(self._acked[name], min(tick, self._tick))
        return True

    def _leave(self, name: str, why: str) -> None:
        del self.periods[name], self._acked[name]
        self._report(why)


class InProcess:
    """Runs a simulation and services in one process, in lockstep, with one clock."""

    def __init__(self, sim: Stepped, sim_io: MemoryIo, clock: ManualClock) -> None:
        self.clock = clock
        self.tick = 0
        self._sim, self._sim_io = sim, sim_io
        self._members: list[tuple[Any, MemoryIo, int]] = []
        sim_io.out_stamp = -1

    def add(self, service: Stepped, io: MemoryIo) -> None:
        """Services step in the order added; the order does not change what they see."""
        self._members.append((service, io, period_of(service.HZ)))

    def remove(self, service: Stepped) -> None:
        self._members = [row for row in self._members if row[0] is not service]

    def advance(self) -> float:
        """One tick of the world and of every service due; returns the new robot time."""
        sim_io = self._sim_io
        tick, now = self.tick, self.tick * DT
        sim_io.begin(tick, now)
        sim_io.out_stamp = tick
        self._sim.step(now)
        self.tick = tick = tick + 1
        self.clock.advance(tick * DT - self.clock.now())
        now = self.clock.now()
        for service, io, period in self._members:
            if tick % period == 0:
                io.begin(tick, now)
                service.step(now)
        return now
