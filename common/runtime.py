"""Runs one service as a process: configuration, bus, clock, health, signals, and the one guard around `step`."""

import argparse
import os
import sys
import traceback
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
import zenoh

from common import bus, codec, config, topics
from common import messages as m
from common.clock import Clock, Pacer, SimClock, WallClock, monotonic
from common.iobase import health_of
from common.lockstep import DT, Barrier, period_of
from common.process import SILENCE, StopSignal, die_with_parent, limit_silence, rss_mb
from common.scene import Scene, SceneError, load_scene
from common.ticks import AckCollector, ClockListener, ClockSpeaker
from common.zenoh_io import ZenohIo

HEALTH_PERIOD = 1.0
MAX_CONSECUTIVE_ERRORS = 10
STALLED = 1.0
"""Wall time [s] without a tick after which a service is told that robot time stands still: a hundred ticks."""
BAD_CONFIGURATION = 2


# A class with NAME, HZ, CONFIG, READS, WRITES, a constructor (config, io) and `step(now)`, which takes its input,
# decides, publishes and never blocks; `now` is robot time [s]. With `stalled(seconds)` it is also told, some ten times
# a second, for how long robot time has stood still [s of wall time]. The simulation also has `paused`, `start_time`
# and `pace()`.
ServiceClass = type[Any]


class Process:
    """One service object with its bus and loop."""

    def __init__(
        self,
        kind: ServiceClass,
        parameters: Any,
        shared: config.RuntimeConfig,
        scene: Scene,
        opened: zenoh.Session,
        clock: Clock,
        stop: StopSignal,
        state_dir: Path,
    ) -> None:
        self._kind, self._session, self._clock, self._stop = kind, opened, clock, stop
        self.io = ZenohIo(
            opened,
            kind.NAME,
            kind.READS,
            kind.WRITES,
            scene=scene,
            seed=shared.seed,
            lockstep=shared.lockstep and isinstance(clock, SimClock),
            clock=clock,
            log_level=shared.log_level,
        )
        self.io.state_dir = state_dir
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
        listener = ClockListener(self._session, period, self.io.drops)
        lockstep = self.io.lockstep
        acks = self._session.declare_publisher(
            topics.LOCKSTEP_ACK.key, congestion_control=zenoh.CongestionControl.BLOCK, express=True
        )

        def acknowledge(tick: int) -> None:
            ack = m.LockstepAck(name=self._kind.NAME, tick=tick, period=period, heard=self.io.heard)
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
        speaker = ClockSpeaker(self._session)
        barrier = Barrier(acks.next, wait_for, report=lambda text: io.log.warning(text))
        if lockstep:
            io.log.info("waiting for participants", names=",".join(wait_for))
            barrier.assemble(self._keep_alive)
        tick = round(getattr(self.service, "start_time", 0.0) / DT)
        pacer = Pacer(DT, speed) if speed else None
        said: m.SimClockTick | None = None
        while not self._stop.is_set():
            if self.service.paused:
                self.housekeeping()
                self._stop.wait(0.02)
                continue
            io.out_tick = tick
            self.step(tick, tick * DT)
            if lockstep and said:
                barrier.wait(tick, self._gone, partial(speaker.say, said))
            tick += 1
            clock.set(tick * DT)
            said = m.SimClockTick(t=tick * DT, tick=tick, epoch=io.epoch, lockstep=lockstep)
            barrier.drain()
            speaker.say(said, not lockstep or barrier.awaits(tick))
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


def main(kind: ServiceClass) -> None:
    """Entry point of `python -m services.<name>`; ends the process with the documented exit status."""
    args = _arguments(kind)
    stop = StopSignal()
    die_with_parent()
    environ = os.environ
    # One link, one task that reads it: a second thread is only woken in vain, at every message.
    environ.setdefault("ZENOH_RUNTIME", "(rx: (worker_threads: 1))")
    try:
        changes = config.overrides(environ, args.set)
        directory = config.config_dir(environ)
        shared = config.load("runtime", config.RuntimeConfig, directory, changes)
        scene = load_scene(shared.scene)
        parameters = config.load(kind.NAME, kind.CONFIG, directory, changes)
        # A service for people keeps their time: it goes on while the simulation pauses, and never holds it up.
        clock_name = getattr(kind, "CLOCK", "") or environ.get("TIDYBOT_CLOCK", "sim")
        if clock_name not in ("sim", "wall"):
            raise config.ConfigError(f"TIDYBOT_CLOCK={clock_name}: expected sim or wall")
        clock: SimClock | WallClock = SimClock() if clock_name == "sim" else WallClock()
        connect = environ.get("TIDYBOT_CONNECT") or bus.default_connect()
        namespace = environ.get("TIDYBOT_NAMESPACE", "")
        with bus.session(connect, namespace, wait=stop.wait, name=kind.NAME) as opened:
            state_dir = config.state_dir(environ, connect, namespace)
            _run(Process(kind, parameters, shared, scene, opened, clock, stop, state_dir), clock)
    except bus.NoRouter:
        sys.exit(0)
    except (config.ConfigError, SceneError, bus.BusError, StartError) as error:
        print(f"{kind.NAME}: {error}", file=sys.stderr)
        sys.exit(BAD_CONFIGURATION)


class StartError(ValueError):
    """A service cannot start as configured; the message says what to change."""


def _run(process: Process, clock: SimClock | WallClock) -> None:
    try:
        if isinstance(clock, WallClock):
            process.run_on_wall_clock()
        elif hasattr(process.service, "paused"):
            speed, wait_for = process.service.pace()
            process.run_simulation(clock, speed, wait_for)
        else:
            process.run_on_sim_clock(clock)
    finally:
        process.close()


def _arguments(kind: ServiceClass) -> argparse.Namespace:
    fields = "\n".join(
        f"  {kind.NAME}.{f.name} = {f.default!r}"
        for f in msgspec.structs.fields(kind.CONFIG)
        if f.default is not msgspec.NODEFAULT
    )
    parser = argparse.ArgumentParser(
        prog=f"python -m services.{kind.NAME}",
        description=(kind.__doc__ or "").strip(),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog=f"parameters (config/{kind.NAME}.toml, TIDYBOT__{kind.NAME.upper()}__<KEY>, --set):\n{fields}\n\n"
        "environment: TIDYBOT_CONNECT, TIDYBOT_NAMESPACE, TIDYBOT_KEYS, TIDYBOT_CONFIG_DIR, TIDYBOT_CLOCK=sim|wall",
    )
    parser.add_argument("--set", action="append", default=[], metavar="section.key=value", help="override a parameter")
    return parser.parse_args()
