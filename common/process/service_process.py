"""A service as a process: its bus, clock and health, and the one guard around `step`."""

import os
import traceback
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import Any

import zenoh

from common import config, topics
from common import messages as m
from common.bus import codec
from common.bus.port import Outside
from common.bus.zenoh_io import ZenohIo
from common.household import Household
from common.process.host import SILENCE, StopSignal, limit_silence, return_memory
from common.process.presence import Presence, answer_queries
from common.scene import Scene
from common.time.clock import Clock, Pacer, SimClock, monotonic
from common.time.clock_transport import AckCollector, ClockPublisher, ClockSubscriber
from common.time.lockstep import DT, Barrier, period_of

HEALTH_PERIOD = 1.0
"""Wall time between two health records [s]; fixed by the interface, 1 Hz."""
TRIM_PERIOD = 10.0
"""Wall time between two times that memory is given back [s]; chosen: what pictures take and leave in pieces goes back
soon, and the millisecond that it takes is not noticed."""
MAX_CONSECUTIVE_ERRORS = 10
"""Steps in a row that may raise [count] before the process ends; chosen: half a second at 20 Hz."""
STALLED = 1.0
"""Wall time [s] without a tick after which a service is told that robot time stands still: a hundred ticks."""


# A class with NAME, HZ, CONFIG, READS, WRITES, a constructor (config, io) and `step(now)`, which takes its input,
# decides, publishes and never blocks; `now` is robot time [s]. With `stalled(seconds)` it is also told, some ten times
# a second, for how long robot time has stood still [s of wall time]. Topics in ON_DEMAND, which are also in READS, are
# subscribed to when the service says so (`Io.demand`). The simulation also has `paused`, `start_time` and `pace()`.
# With `KNOWS_WORLD` it is given the world as it really is: the simulation, and judges.
ServiceClass = type[Any]


class Process:
    """One service object with its bus and loop."""

    def __init__(
        self,
        kind: ServiceClass,
        parameters: Any,
        shared: config.RuntimeConfig,
        household: Household,
        opened: zenoh.Session,
        clock: Clock,
        stop: StopSignal,
        state_dir: Path,
        world: Scene | None = None,
        outside: Outside | None = None,
    ) -> None:
        self._kind, self._session, self._clock, self._stop = kind, opened, clock, stop
        self._shared, self._household, self._world = shared, household, world
        self.io = self._io(opened)
        self.io.state_dir = state_dir
        self.io.outside = outside
        self.io.robot = outside.namespace if outside is not None else ""
        self.io.other_robots = self._beside
        self._presences = [Presence(opened, self.io)]
        self._health_at = self._trimmed_at = monotonic()
        self._steps = 0
        self._errors = 0
        self.service = kind(parameters, self.io)
        for presence in self._presences:
            presence.announce()
        self.io.log.info("started", epoch=self.io.epoch, pid=os.getpid(), hz=kind.HZ)

    def _io(self, opened: zenoh.Session) -> ZenohIo:
        kind, shared = self._kind, self._shared
        return ZenohIo(
            opened,
            kind.NAME,
            kind.READS,
            kind.WRITES,
            household=self._household,
            world=self._world,
            seed=shared.seed,
            lockstep=shared.lockstep and isinstance(self._clock, SimClock),
            clock=self._clock,
            log_level=shared.log_level,
            on_demand=getattr(kind, "ON_DEMAND", ()),
        )

    def _beside(self, robot: str) -> ZenohIo:
        """The same service in the namespace of another robot, over a session of its own."""
        if self.io.outside is None:
            raise LookupError("there is no router")
        stack = ExitStack()
        opened = stack.enter_context(self.io.outside.beside(robot))
        self._presences.append(Presence(opened, self._io(opened), stack))
        return self._presences[-1].io

    def housekeeping(self) -> None:
        """Health at 1 Hz of wall time, waiting queries."""
        answer_queries(self._presences)
        elapsed = monotonic() - self._health_at
        if elapsed >= HEALTH_PERIOD:
            for presence in self._presences:
                presence.tell(self._steps / elapsed)
            self._health_at += elapsed
            limit_silence(SILENCE)
            self._steps = 0
            if self._health_at - self._trimmed_at >= TRIM_PERIOD:
                self._trimmed_at = self._health_at
                return_memory()

    def step(self, tick: int | None, now: float) -> None:
        """One step behind the guard: an unexpected error is logged and counted, many in a row end the process."""
        for presence in self._presences:
            presence.io.begin(tick, now)
        answer_queries(self._presences)
        self._guarded(self.service.step, now)
        self._steps += 1

    def _guarded(self, act: Callable[[float], None], value: float) -> None:
        try:
            act(value)
            self._errors = 0
        except Exception as error:
            self._errors += 1
            where = traceback.format_exc(limit=-4)
            self.io.log.error("step failed", error=f"{type(error).__name__}: {error}", where=where)
            if self._errors >= MAX_CONSECUTIVE_ERRORS:
                raise

    # --- loops
    def run_on_wall_clock(self) -> None:
        period = 1 / self._kind.HZ
        due = monotonic()
        while not self._stop.is_set():
            self.step(None, self._clock.now())
            self.housekeeping()
            due = max(due + period, monotonic() - period)
            self._stop.wait(max(0.0, due - monotonic()))

    def run_on_sim_clock(self, clock: SimClock) -> None:
        """Follow `sim/clock`; in lockstep, join, and acknowledge every due tick."""
        period = period_of(self._kind.HZ)
        listener = ClockSubscriber(self._session, period, self.io.drops)
        lockstep = self.io.lockstep
        acks = self._session.declare_publisher(
            topics.LOCKSTEP_ACK.key, congestion_control=zenoh.CongestionControl.BLOCK, express=True
        )

        def acknowledge(tick: int) -> None:
            ack = m.LockstepAck(name=self._kind.NAME, tick=tick, period=period, heard=self.io.unstamped)
            acks.put(codec.encode(topics.LOCKSTEP_ACK, ack))

        stalled: Callable[[float], None] | None = getattr(self.service, "stalled", None)
        began = monotonic()
        done = -1
        epoch = ""
        joined_at = float("-inf")
        while not self._stop.is_set():
            tick = listener.next(0.1, newest=not lockstep)
            if tick is None:
                self.housekeeping()
                if stalled is not None and (silent := monotonic() - max(began, listener.seen)) > STALLED:
                    self._guarded(stalled, silent)
                if lockstep and monotonic() - max(joined_at, listener.seen) > 1.0:
                    acknowledge(-1 if done < 0 else done)
                    joined_at = monotonic()
                continue
            if tick.epoch != epoch:
                epoch, done = tick.epoch, -1
            if tick.tick > done:
                clock.set(max(clock.now(), tick.t) if not lockstep else tick.t)
                self.step(tick.tick, clock.now())
                done = tick.tick
            if lockstep:
                acknowledge(done)
            self.housekeeping()

    def run_simulation(self, clock: SimClock, speed: float | None, wait_for: tuple[str, ...]) -> None:
        """The simulation's own loop: it makes the time that the others follow. `speed` None: as fast as possible."""
        lockstep, io = self.io.lockstep, self.io
        speakers = [ClockPublisher(p.session) for p in self._presences]
        acks = [AckCollector(p.session, p.io.drops) for p in self._presences]
        barriers = [Barrier(a.next, wait_for, report=lambda text: io.log.warning(text)) for a in acks]
        tick = round(getattr(self.service, "start_time", 0.0) / DT)
        if lockstep:
            io.log.info("waiting for participants", names=",".join(wait_for))
            # Other robots of this world join when somebody starts them, which may wait for this one.
            barriers[0].assemble(self._keep_alive, going_on=tick > 0)
        pacer = Pacer(DT, speed) if speed else None
        published: m.SimClockTick | None = None
        while not self._stop.is_set():
            if self.service.paused:
                self.housekeeping()
                self._stop.wait(0.02)
                continue
            for presence in self._presences:
                presence.io.out_tick = tick
            self.step(tick, tick * DT)
            if lockstep and published:
                for barrier, speaker, presence in zip(barriers, speakers, self._presences, strict=True):
                    barrier.wait(tick, partial(self._gone, presence), partial(speaker.publish, published))
            tick += 1
            clock.set(tick * DT)
            published = m.SimClockTick(t=tick * DT, tick=tick, epoch=io.epoch, lockstep=lockstep)
            for barrier, speaker in zip(barriers, speakers, strict=True):
                barrier.drain()
                speaker.publish(published, not lockstep or barrier.awaits(tick))
            if pacer:
                pacer.wait()
            self.housekeeping()

    def _gone(self, presence: Presence, name: str) -> bool:
        """Asked while the world waits for `name`: a slow participant does not make the simulation look dead."""
        self.housekeeping()
        return presence.io.peer(name) is None

    def _keep_alive(self) -> bool:
        self.housekeeping()
        return not self._stop.is_set()

    def close(self) -> None:
        close = getattr(self.service, "close", None)
        if close:
            close()
        self.io.log.info("stopped")
        for presence in reversed(self._presences):
            presence.close()
