"""A service on a bus: its `Io`, its health and its liveliness token, in the namespace of one robot."""

import os
from collections.abc import Iterable
from contextlib import ExitStack
from typing import Any

import msgspec
import zenoh

from common import messages as m
from common import topics
from common.bus import codec
from common.bus.zenoh_io import ZenohIo
from common.process.host import rss_mb
from common.time.clock import monotonic


class Presence:
    """A service as others see it on a bus. `clear` publishes that it is there; `stack` closes its session."""

    def __init__(self, session: zenoh.Session, io: ZenohIo, stack: ExitStack | None = None) -> None:
        self.session, self.io = session, io
        self._stack = stack or ExitStack()
        self._health = session.declare_publisher(topics.HEALTH.of(io.name), encoding=codec.JSON)
        self._last = b""
        self._queryable = session.declare_queryable(self._health.key_expr, self._answer)
        self._started = monotonic()
        self._token: Any = None

    def announce(self) -> None:
        """Show that the service is ready, by its liveliness token."""
        self._token = self.session.liveliness().declare_token(topics.ALIVE_KEY.format(name=self.io.name))
        self.tell(0.0)

    def _answer(self, query: zenoh.Query) -> None:
        with query:
            if self._last:
                query.reply(self._health.key_expr, self._last, encoding=codec.JSON)

    def tell(self, hz: float) -> None:
        """Publish a health record; `hz`: steps a second since the last."""
        io = self.io
        record = m.Health(
            name=io.name, epoch=io.epoch, t=io.clock.now(), uptime=monotonic() - self._started, hz=hz,
            drops=sum(io.drops.values()), rss_mb=rss_mb(), pid=os.getpid(), last_error=io.log.last_error,
            by_key=dict(io.drops),
        )  # fmt: skip
        self._last = msgspec.json.encode(record)
        self._health.put(self._last)

    def close(self) -> None:
        self.io.shutdown()
        self._stack.close()


def answer_queries(presences: Iterable[Presence]) -> None:
    """Run the handlers of queries that wait."""
    for presence in presences:
        presence.io.answer_queries()
