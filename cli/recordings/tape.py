"""Recording of the bus: a queue of everything that arrives, and the writer that empties it."""

import contextlib
import queue
from typing import Any

from common import messages as m
from common import topics
from common.bus import codec, delivery
from common.recording import Recorder
from common.time.clock import unix_time
from common.time.lockstep import DT

FLUSH, BATCH = 1.0, 2000
"""Time [s] after which what was recorded goes to disk, and messages that are written at a time."""
# The brain asks whether anybody subscribes to these before it counts on the service that reads them, so the
# recorder listens only while that service is there: a recording must not change what it records.
READERS = {t: t.readers[0] for t in topics.TABLE if t.command and t.latched and "brain" in t.writers}
Arrival = tuple[str, bytes, int | None, float]


class Listener:
    """Subscriptions to everything; arrivals wait in one queue, in the order they came."""

    def __init__(self, session: Any) -> None:
        self._session = session
        self.inbox: queue.SimpleQueue[Arrival] = queue.SimpleQueue()
        self.tokens: queue.SimpleQueue[tuple[str, bool]] = queue.SimpleQueue()
        self._gated: dict[str, Any] = {}
        # The slower clocks say nothing that `sim/clock` does not.
        marks = (topics.SIM_CLOCK, topics.LOCKSTEP_ACK)
        others = {t.key for t in (*READERS, *topics.SLOWER_CLOCKS.values(), *marks)}
        self._kept = [delivery.subscribe(session, t, self._receive) for t in topics.TABLE if t.key not in others]
        self._kept += [delivery.listen(session, key, self._receive) for key in (row.key for row in topics.PER_SERVICE)]
        self._kept.append(delivery.watch_tokens(session, lambda name, alive: self.tokens.put((name, alive))))
        # What says that a step is over, last here and first in `close`: of a step so recorded, everything was heard.
        self._marks = [delivery.subscribe(session, t, self._receive) for t in marks]

    def _receive(self, sample: Any) -> None:
        self.inbox.put(
            (str(sample.key_expr), sample.payload.to_bytes(), delivery.tick_of(sample), delivery.sent_at(sample))
        )

    def gate(self, alive: set[str]) -> None:
        """Listen to the goals of services that are there, and to no others."""
        for topic, reader in READERS.items():
            if reader in alive and topic.key not in self._gated:
                self._gated[topic.key] = delivery.subscribe(self._session, topic, self._receive)
            elif reader not in alive and topic.key in self._gated:
                self._gated.pop(topic.key).undeclare()

    def close(self) -> None:
        for subscriber in (*self._marks, *self._kept, *self._gated.values()):
            subscriber.undeclare()


class Tape:
    """Writes what arrives, with its robot time."""

    def __init__(self, recorder: Recorder, listener: Listener, wall_clock: bool) -> None:
        self._recorder, self._listener, self._wall_clock = recorder, listener, wall_clock
        self.now = 0.0
        self.alive: set[str] = set()
        self.lockstep = False
        self.status: m.SimStatus | None = None

    def go_on(self, recorder: Recorder) -> None:
        """Write to another file from now on, which begins with who is there."""
        self._recorder = recorder
        for name in sorted(self.alive):
            recorder.presence(name, True, self.now, unix_time())

    def write(self) -> int:
        """Take what is waiting, at most a batch; the number taken."""
        self._tokens()
        for taken in range(BATCH):
            try:
                key, payload, tick, wall = self._listener.inbox.get_nowait()
            except queue.Empty:
                return taken
            self._one(key, payload, tick, wall)
        return BATCH

    def _one(self, key: str, payload: bytes, tick: int | None, wall: float) -> None:
        if self._wall_clock:
            self.now = wall
        elif key == topics.SIM_CLOCK.key:
            self._clock(payload)
        if key == topics.SIM_STATUS.key:
            with contextlib.suppress(codec.DecodeError):
                self.status = codec.decode(topics.SIM_STATUS, payload)
        self._recorder.write(key, payload, self.now if tick is None else tick * DT, wall, tick)

    def _clock(self, payload: bytes) -> None:
        try:
            tick = codec.decode(topics.SIM_CLOCK, payload)
        except codec.DecodeError:
            return
        self.now, self.lockstep = tick.t, tick.lockstep

    def _tokens(self) -> None:
        """Who is there, as messages: `service/<name>/alive`."""
        while not self._listener.tokens.empty():
            name, alive = self._listener.tokens.get()
            (self.alive.add if alive else self.alive.discard)(name)
            self._listener.gate(self.alive)
            self._recorder.presence(name, alive, self.now, unix_time())


def progress(recorder: Recorder, tape: Tape, waiting: int) -> str:
    """How a recording stands, in a line."""
    counts = recorder.counts
    text = f"{tape.now:8.1f} s  {sum(counts.values())} messages on {len(counts)} keys  {recorder.size / 1e6:.1f} MB"
    return text + (f"  {waiting} waiting" if waiting > BATCH else "")
