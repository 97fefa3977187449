"""A service as a process: its bus, clock and health, and the one guard around `step`."""

import os
import traceback
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
import zenoh

from common import config, topics
from common import messages as m
from common.bus import codec
from common.bus.base import health_of
from common.bus.port import Outside
from common.bus.zenoh_io import ZenohIo
from common.household import Household
from common.process import SILENCE, StopSignal, limit_silence, rss_mb
from common.scene import Scene
from common.time.clock import Clock, Pacer, SimClock, monotonic
from common.time.clock_transport import AckCollector, ClockPublisher, ClockSubscriber
from common.time.lockstep import DT, Barrier, period_of

HEALTH_PERIOD = 1.0
"""Wall time between two health records [s]; fixed by the interface, 1 Hz."""
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
        self.io = ZenohIo(
            opened,
            kind.NAME,
            kind.READS,
            kind.WRITES,
            household=household,
            world=world,
            seed=shared.seed,
            lockstep=shared.lockstep and isinstance(clock, SimClock),
            clock=clock,
            log_level=shared.log_level,
            on_demand=getattr(kind, "ON_DEMAND", ()),
        )
        self.io.state_dir = state_dir
        self.io.outside = outside
        self.io.robot = outside.namespace if outside is not None else ""
        self._health = opened.declare_publisher(topics.HEALTH.of(kind.NAME), encoding=codec.JSON)
        self._last_health = b""
        self._health_queryable = opened.declare_queryable(self._health.key_expr, self._answer_health)
        self._started = self._health_at = monotonic()
        self._steps = 0
        self._errors = 0
        self.service = kind(parameters, self.io)
        self._token = opened.liveliness().declare_token(topics.ALIVE_KEY.format(name=kind.NAME))
        self._publish_health(0.0)
        self.io.log.info("started", epoch=self.io.epoch, pid=os.getpid(), hz=kind.HZ)

    def _answer_health(self, query: zenoh.Query) -> None:
        with query:
            if self._last_health:
                query.reply(self._health.key_expr, self._last_health, encoding=codec.JSON)

    def _publish_health(self, hz: float) -> None:
        record = health_of(self.io, monotonic() - self._started, hz, rss_mb(), os.getpid())
        self._last_health = msgspec.json.encode(record)
        self._health.put(self._last_health)

    def housekeeping(self) -> None:
        """Health at 1 Hz of wall time, waiting queries."""
        self.io.answer_queries()
        elapsed = monotonic() - self._health_at
        if elapsed >= HEALTH_PERIOD:
            self._publish_health(self._steps / elapsed)
            self._health_at += elapsed
            limit_silence(SILENCE)
            self._steps = 0

    def step(self, tick: int | None, now: float) -> None:
        """One step behind the guard: an unexpected error is logged and counted, many in a row end the process."""
        self.io.begin(tick, now)
        self.io.answer_queries()
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
        acks = AckCollector(self._session, self.io.drops)
        speaker = ClockPublisher(self._session)
        barrier = Barrier(acks.next, wait_for, report=lambda text: io.log.warning(text))
        if lockstep:
            io.log.info("waiting for participants", names=",".join(wait_for))
            barrier.assemble(self._keep_alive)
        tick = round(getattr(self.service, "start_time", 0.0) / DT)
        pacer = Pacer(DT, speed) if speed else None
        published: m.SimClockTick | None = None
        while not self._stop.is_set():
            if self.service.paused:
                self.housekeeping()
                self._stop.wait(0.02)
                continue
            io.out_tick = tick
            self.step(tick, tick * DT)
            if lockstep and published:
                barrier.wait(tick, self._gone, partial(speaker.publish, published))
            tick += 1
            clock.set(tick * DT)
            published = m.SimClockTick(t=tick * DT, tick=tick, epoch=io.epoch, lockstep=lockstep)
            barrier.drain()
            speaker.publish(published, not lockstep or barrier.awaits(tick))
            if pacer:
                pacer.wait()
            self.housekeeping()

    def _gone(self, name: str) -> bool:
        """Asked while the world waits for `name`: a slow participant does not make the simulation look dead."""
        self.housekeeping()
        return self.io.peer(name) is None

    def _keep_alive(self) -> bool:
        self.housekeeping()
        return not self._stop.is_set()

    def close(self) -> None:
        close = getattr(self.service, "close", None)
        if close:
            close()
        self.io.log.info("stopped")
        self.io.shutdown()
