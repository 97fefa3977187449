"""`ZenohIo`: the `Io` of a process of its own, over a Zenoh session."""

import queue
from collections.abc import Callable, Iterable
from contextlib import ExitStack
from typing import Any, Unpack

import msgspec
import zenoh
from zenoh import handlers

from common import messages as m
from common import topics
from common.bus import codec, delivery
from common.bus.base import IoBase, Setting
from common.bus.mailbox import CAPACITY, UNSTAMPED, Mailbox
from common.bus.port import Handler, Outside
from common.bus.worker import WorkerJob
from common.time.clock import unix_time
from common.topic import Topic

_BAD_REQUEST = (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, RecursionError, OSError)


class ZenohIo(IoBase):
    """`Io` over a Zenoh session."""

    def __init__(
        self,
        opened: zenoh.Session,
        name: str,
        reads: Iterable[Topic[Any]],
        writes: Iterable[Topic[Any]],
        on_demand: Iterable[Topic[Any]] = (),
        **setting: Unpack[Setting],
    ) -> None:
        reads, writes, later = tuple(reads), tuple(writes), {t.key for t in on_demand}
        self._session = opened
        self._log_publisher: Any = opened.declare_publisher(topics.LOG.of(name), encoding=codec.JSON)
        super().__init__(name, reads, writes, **setting)
        self._started = unix_time()
        self.out_tick: int | None = None
        self._peers: dict[str, str] = {}
        self._queries: queue.SimpleQueue[tuple[Handler, zenoh.Query]] = queue.SimpleQueue()
        self._kept: list[Any] = []
        self._opened = ExitStack()
        self._outer: Any = None
        self._heard: dict[str, dict[str, bytes]] = {}
        self._streams: list[tuple[Any, Mailbox[Any]]] = []
        self._publishers = {t.key: delivery.Publisher(opened, t, lossless=self.lockstep) for t in writes}
        self._demanded: dict[str, Any] = {}
        for topic in reads:
            if topic.key not in later:
                self._subscribe(topic)
        self._kept.append(delivery.watch_tokens(opened, self._on_token))
        self._kept.append(delivery.listen(opened, topics.HEALTH.key, self._on_health))

    def _subscribe(self, topic: Topic[Any]) -> None:
        box = self._boxes[topic.key]
        if topic.keep == "latest":
            # A stream waits outside Python until the next step: to call into it for every sample costs twice as much.
            waiting: Any = handlers.RingChannel(CAPACITY if self.lockstep else 1)
            self._streams.append((self._session.declare_subscriber(topic.key, waiting), box))
            if topic.latched:
                self._present(topic, box)
            return
        started, stale_key = self._started, f"{topic.key} (stale)"

        def receive(sample: zenoh.Sample) -> None:
            if topic.command and delivery.sent_at(sample) < started:
                self.drops[stale_key] += 1
                return
            _keep(box, sample)

        self._kept.append(delivery.subscribe(self._session, topic, receive))

    def demand(self, topic: Topic[Any], wanted: bool) -> None:
        if wanted == (topic.key in self._demanded):
            return
        if not wanted:
            gone = self._demanded.pop(topic.key)
            self._streams = [(stream, box) for stream, box in self._streams if stream is not gone]
            gone.undeclare()
            return
        box = self._boxes[topic.key]
        if topic.keep == "latest":
            waiting: Any = handlers.RingChannel(CAPACITY if self.lockstep else 1)
            self._demanded[topic.key] = self._session.declare_subscriber(topic.key, waiting)
            self._streams.append((self._demanded[topic.key], box))
        else:
            self._demanded[topic.key] = delivery.listen(self._session, topic.key, lambda sample: _keep(box, sample))
        if topic.latched and not topic.command:
            self._present(topic, box)

    def _present(self, topic: Topic[Any], box: Mailbox[Any]) -> None:
        """Ask for the latched value; the answer comes into the mailbox."""
        self._session.get(topic.key, lambda reply: _keep(box, reply.ok) if reply.ok is not None else None)

    def begin(self, tick: int | None, now: float) -> None:
        for stream, box in self._streams:
            taken = 0
            while (sample := stream.try_recv()) is not None:
                _keep(box, sample)
                taken += 1
            if taken == CAPACITY:
                box.overflow += 1
        super().begin(tick, now)

    # --- peers
    def _on_token(self, name: str, alive: bool) -> None:
        if alive:
            self._peers.setdefault(name, "")
        else:
            self._peers.pop(name, None)

    def _on_health(self, sample: zenoh.Sample) -> None:
        try:
            health = codec.decode_as(m.Health, sample.payload.to_bytes())
        except codec.DecodeError as error:
            self.drops[str(sample.key_expr)] += 1
            self.log.debug("dropped", key=str(sample.key_expr), reason=str(error))
            return
        # Also without a token: that of a dead process may be lost after its successor's was announced.
        self._peers[health.name] = health.epoch

    def peer(self, name: str) -> str | None:
        return self._peers.get(name)

    # --- other robots
    other_robots: Callable[[str], "ZenohIo"] | None = None
    """How this service is there for another robot as well; the process knows."""

    def beside(self, robot: str) -> "ZenohIo":
        if self.other_robots is None:
            raise LookupError(f"{self.name} is one robot's alone")
        return self.other_robots(robot)

    def _abroad(self, topic: Topic[Any]) -> dict[str, bytes]:
        if topic.key not in self._heard:
            self._heard[topic.key] = {}
            if self.outside is not None and self.outside.namespace:
                self._listen_abroad(topic, self._heard[topic.key], self.outside)
        return self._heard[topic.key].copy()

    def _listen_abroad(self, topic: Topic[Any], heard: dict[str, bytes], outside: Outside) -> None:
        """Over a session outside of the namespace, which a robot that is alone on its router does not need."""
        if self._outer is None:
            self._outer = self._opened.enter_context(outside.open())

        def receive(sample: zenoh.Sample) -> None:
            name = str(sample.key_expr).removesuffix(f"/{topic.key}")
            if name != outside.namespace:
                heard[name] = sample.payload.to_bytes()

        self._kept.append(delivery.listen(self._outer, f"**/{topic.key}", receive))

    def shutdown(self) -> None:
        super().shutdown()
        self._opened.close()

    def has_subscribers(self, topic: Topic[Any]) -> bool:
        return self._publishers[topic.key].has_subscribers

    # --- sending
    def _send(self, topic: Topic[Any], payload: bytes) -> None:
        tick = None
        if self.lockstep:
            tick = self.tick if self.out_tick is None else self.out_tick
        self._publishers[topic.key].put(payload, tick)

    def _send_log(self, record: m.LogRecord) -> None:
        self._log_publisher.put(msgspec.json.encode(record))

    # --- queries
    def serve(self, key: str, handler: Handler) -> None:
        self._kept.append(self._session.declare_queryable(key, lambda query: self._queries.put((handler, query))))

    def ask(self, key: str, request: bytes = b"") -> WorkerJob[bytes | None]:
        return self.submit(lambda: next(iter(delivery.fetch(self._session, key, request).values()), None))

    def answer_queries(self) -> None:
        """Run the handlers of waiting queries, in the calling thread."""
        while not self._queries.empty():
            handler, query = self._queries.get()
            payload = query.payload.to_bytes() if query.payload is not None else b""
            with query:
                try:
                    query.reply(query.key_expr, handler(payload), encoding=codec.JSON)
                except _BAD_REQUEST as error:
                    self.count_drop(str(query.key_expr), f"{type(error).__name__}: {error}")
                    query.reply_err(str(error))


def _keep(box: Mailbox[Any], sample: zenoh.Sample) -> None:
    tick = delivery.tick_of(sample)
    box.put(sample.payload.to_bytes(), UNSTAMPED if tick is None else tick)
