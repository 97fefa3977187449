"""The lockstep clock over Zenoh: ticks that the simulation publishes, and the acknowledgements of participants."""

import queue
from collections import Counter
from typing import Any

import zenoh

from common import messages as m
from common import topics
from common.bus import codec
from common.bus.delivery import listen
from common.time.clock import monotonic


class ClockPublisher:
    """Publishes each tick on `sim/clock`, and every n-th on the slower clocks."""

    def __init__(self, opened: zenoh.Session) -> None:
        def publisher(key: str, express: bool) -> zenoh.Publisher:
            block = zenoh.CongestionControl.BLOCK
            return opened.declare_publisher(key, congestion_control=block, express=express)

        # A tick that nobody waits for may share a packet with the next one.
        self._lazy = publisher(topics.SIM_CLOCK.key, False)
        self._now = publisher(topics.SIM_CLOCK.key, True)
        self._slower = {period: publisher(topic.key, True) for period, topic in topics.SLOWER_CLOCKS.items()}

    def publish(self, tick: m.SimClockTick, at_once: bool = True) -> None:
        """`at_once`: somebody waits for it on `sim/clock`."""
        message = codec.encode(topics.SIM_CLOCK, tick)
        (self._now if at_once else self._lazy).put(message)
        for period, clock in self._slower.items():
            if tick.tick % period == 0:
                clock.put(message)


class ClockSubscriber:
    """Ticks that a participant is due at.

    They come on the clock of its own rate. Until the first of them, and when they stay away, it follows `sim/clock`,
    which is all that a stand-in for the simulation has to publish.
    """

    SILENCE = 1.0
    """Wall time [s] without a slower clock's tick after which the fast one is followed: ten ticks of the slowest."""

    def __init__(self, opened: zenoh.Session, period: int, drops: Counter[str]) -> None:
        self._opened, self._period, self._drops = opened, period, drops
        self._ticks: queue.SimpleQueue[tuple[m.SimClockTick, bool]] = queue.SimpleQueue()
        self.seen = float("-inf")
        own = topics.SLOWER_CLOCKS.get(period)
        self._own = listen(opened, own.key, lambda sample: self._receive(sample, True)) if own else None
        self._every = self._follow_every_tick()

    def _follow_every_tick(self) -> Any:
        return listen(self._opened, topics.SIM_CLOCK.key, lambda sample: self._receive(sample, False))

    def _receive(self, sample: zenoh.Sample, own: bool) -> None:
        try:
            tick = codec.decode(topics.SIM_CLOCK, sample.payload.to_bytes())
        except codec.DecodeError:
            self._drops[str(sample.key_expr)] += 1
            return
        if tick.tick < 0:
            tick.tick = round(tick.t * 100)
        if tick.tick % self._period == 0:
            self._ticks.put((tick, own))

    def next(self, timeout: float, newest: bool) -> m.SimClockTick | None:
        """The next due tick, or with `newest` the last of those waiting; None after `timeout` seconds."""
        try:
            tick, own = self._ticks.get(timeout=timeout)
        except queue.Empty:
            if self._every is None and monotonic() - self.seen > self.SILENCE:
                self._every = self._follow_every_tick()
            return None
        while newest and not self._ticks.empty():
            tick, own = self._ticks.get()
        if own and self._every is not None:
            self._every.undeclare()
            self._every = None
        self.seen = monotonic()
        return tick


class AckCollector:
    """Acknowledgements on `sim/ack`, for the simulation's barrier."""

    def __init__(self, opened: zenoh.Session, drops: Counter[str]) -> None:
        self._drops = drops
        self._acks: queue.SimpleQueue[tuple[str, int, int]] = queue.SimpleQueue()
        self._kept = listen(opened, topics.LOCKSTEP_ACK.key, self._receive)

    def _receive(self, sample: zenoh.Sample) -> None:
        try:
            ack = codec.decode(topics.LOCKSTEP_ACK, sample.payload.to_bytes())
        except codec.DecodeError:
            self._drops[topics.LOCKSTEP_ACK.key] += 1
            return
        self._acks.put((ack.name, ack.tick, ack.period))

    def next(self, timeout: float) -> tuple[str, int, int] | None:
        try:
            return self._acks.get(timeout=timeout) if timeout > 0 else self._acks.get_nowait()
        except queue.Empty:
            return None
