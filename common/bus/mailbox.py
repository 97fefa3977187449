"""The received messages of one topic, as a service's steps may see them."""

from collections import deque
from typing import Generic, TypeVar

from common import messages as m
from common.bus import codec
from common.topic import Topic

M = TypeVar("M", bound=m.Message)
UNSTAMPED = -(2**62)
"""Stamp [ticks] of a message that carries none: earlier than any step."""
CAPACITY = 1024
"""Waiting messages of a topic [count]; chosen: 10 s of the fastest, 100 Hz, before any is dropped and counted."""


class Mailbox(Generic[M]):
    """Received payloads of one topic. `put` may be called from another thread than the rest."""

    def __init__(self, topic: Topic[M], lockstep: bool) -> None:
        self.topic = topic
        keep_one = topic.keep == "latest" and not lockstep
        self._inbox: deque[tuple[int, bytes]] = deque(maxlen=1 if keep_one else CAPACITY)
        self.waiting = self._inbox
        self._keep_one = keep_one
        self._ready: list[bytes] = []
        self._last: bytes | None = None
        self._decoded: M | None = None
        self.received_at = float("-inf")
        self.overflow = 0

    def put(self, payload: bytes, stamp: int = UNSTAMPED) -> None:
        if not self._keep_one and len(self._inbox) == CAPACITY:
            self.overflow += 1
        self._inbox.append((stamp, payload))

    def open(self, tick: int | None, now: float) -> int:
        """Make visible what the step of `tick` may see (None: everything); returns how many payloads had no stamp."""
        inbox, unstamped = self._inbox, 0
        latest_only = self.topic.keep == "latest"
        while inbox and (tick is None or inbox[0][0] < tick):
            stamp, payload = inbox.popleft()
            unstamped += stamp == UNSTAMPED
            self.received_at = now
            self._last, self._decoded = payload, None
            if latest_only:
                self._ready = [payload]
            elif len(self._ready) < CAPACITY:
                self._ready.append(payload)
            else:
                self.overflow += 1
        return unstamped

    def take(self) -> list[bytes]:
        ready = self._ready
        if ready:
            self._ready = []
        return ready

    def newest(self) -> M | None:
        """The newest message, decoded once for each payload.

        Raises:
            codec.DecodeError: the newest payload is bad; the one before it stays the newest.
        """
        if self._last is not None and self._decoded is None:
            try:
                self._decoded = codec.decode(self.topic, self._last)
                self._good, self._good_at = self._decoded, self.received_at
            except codec.DecodeError:
                self._last, self.received_at = None, self._good_at
                raise
        return self._decoded if self._decoded is not None else self._good

    @property
    def sound(self) -> bool:
        """True when the newest payload was good; `newest` shows an older one otherwise."""
        return self._decoded is not None

    _good: M | None = None
    _good_at = float("-inf")
