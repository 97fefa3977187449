"""The bus of a single process: the same visibility rules and the same bytes as over Zenoh, no network."""

from collections.abc import Iterable
from typing import Any, TypeVar, Unpack

from common import messages as m
from common.bus import codec
from common.bus.base import IoBase, Setting
from common.bus.mailbox import UNSTAMPED, Mailbox
from common.bus.port import Handler
from common.bus.worker import WorkerJob
from common.topic import Topic

M = TypeVar("M", bound=m.Message)


class MemoryBus:
    """Connects the `MemoryIo`s of one process."""

    def __init__(self) -> None:
        self.ios: dict[str, MemoryIo] = {}
        self.last: dict[str, bytes] = {}
        self.neighbours: dict[str, MemoryBus] = {}
        """The other robots' by name, where there are several."""
        self.handlers: dict[str, Handler] = {}
        self._readers: dict[str, list[Mailbox[Any]]] = {}
        self._taps: dict[str, list[list[bytes]]] = {}

    def attach(self, io: "MemoryIo") -> None:
        self.ios[io.name] = io
        for key, box in io._boxes.items():
            self._readers.setdefault(key, []).append(box)
            if box.topic.latched and not box.topic.command and key in self.last:
                box.put(self.last[key])

    def detach(self, io: "MemoryIo") -> None:
        """Take an io off the bus, as when its process dies: it reads and answers nothing more, its token is gone."""
        self.ios.pop(io.name, None)
        for key, handler in io.served.items():
            if self.handlers.get(key) is handler:
                del self.handlers[key]
        io.served.clear()
        for key, box in io._boxes.items():
            self._readers[key].remove(box)

    def put(self, topic: Topic[Any], payload: bytes, stamp: int = UNSTAMPED) -> None:
        """Deliver raw bytes, as any client can."""
        if topic.latched:
            self.last[topic.key] = payload
        for box in self._readers.get(topic.key, ()):
            box.put(payload, stamp)
        for tap in self._taps.get(topic.key, ()):
            tap.append(payload)

    def send(self, topic: Topic[M], message: M) -> None:
        """Deliver a message, as any client can."""
        self.put(topic, codec.encode(topic, message))

    def tap(self, topic: Topic[Any]) -> list[bytes]:
        """A list that receives every later payload of the topic."""
        tap: list[bytes] = []
        self._taps.setdefault(topic.key, []).append(tap)
        return tap

    def get(self, key: str, payload: bytes = b"") -> bytes | None:
        """What a zenoh `get` on the key would answer first."""
        handler = self.handlers.get(key)
        return handler(payload) if handler else self.last.get(key)


class MemoryIo(IoBase):
    """`Io` over a `MemoryBus`."""

    def __init__(
        self,
        bus: MemoryBus,
        name: str,
        reads: Iterable[Topic[Any]],
        writes: Iterable[Topic[Any]],
        **setting: Unpack[Setting],
    ) -> None:
        super().__init__(name, reads, writes, **setting)
        self.bus = bus
        self.served: dict[str, Handler] = {}
        self.out_stamp: int | None = None
        self._leader: MemoryIo | None = None
        self._followers: list[MemoryIo] = []
        bus.attach(self)

    def beside(self, robot: str) -> "MemoryIo":
        other = MemoryIo(
            self.bus.neighbours[robot], self.name, [box.topic for box in self._open_order], (), household=self.loaded,
            world=self._world, seed=self.seed, lockstep=self.lockstep,
        )  # fmt: skip
        other.clock, other.log, other._writes, other._leader = self.clock, self.log, self._writes, self
        self._followers.append(other)
        return other

    def begin(self, tick: int | None, now: float) -> None:
        super().begin(tick, now)
        for other in self._followers:
            other.begin(tick, now)

    def _send(self, topic: Topic[Any], payload: bytes) -> None:
        leader = self._leader or self
        if not self.lockstep:
            stamp = UNSTAMPED
        else:
            stamp = leader.tick if leader.out_stamp is None else leader.out_stamp
        self.bus.put(topic, payload, stamp)

    def _abroad(self, topic: Topic[Any]) -> dict[str, bytes]:
        return {name: bus.last[topic.key] for name, bus in self.bus.neighbours.items() if topic.key in bus.last}

    def serve(self, key: str, handler: Handler) -> None:
        self.bus.handlers[key] = handler
        self.served[key] = handler

    def ask(self, key: str, request: bytes = b"") -> WorkerJob[bytes | None]:
        answer = self.bus.get(key, request)
        return self.submit(lambda: answer)

    def demand(self, topic: Topic[Any], wanted: bool) -> None:
        """Do nothing: in memory every topic that a service reads is delivered."""

    def peer(self, name: str) -> str | None:
        other = self.bus.ios.get(name)
        return other.epoch if other else None

    def has_subscribers(self, topic: Topic[Any]) -> bool:
        return True
