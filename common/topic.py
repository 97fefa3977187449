"""Rows of the table of topics: a key with its payload, writers, readers and delivery; and the four kinds of rows."""

from typing import Any, Generic, Literal, TypeVar

import msgspec

from common import messages as m

M = TypeVar("M", bound=m.Message)
Keep = Literal["latest", "all"]
ANYONE = "*"
"""As a publisher: any client that may command the robot."""
EACH = "each"
"""As a publisher or subscriber: every service, by the runtime that it lives in."""


class Topic(msgspec.Struct, Generic[M], frozen=True, kw_only=True):
    """One key expression.

    `writers` and `readers` are services, `ANYONE` or `EACH`. `rate` is the declared frequency [Hz], 0 for events.
    `latched`: the last value also answers a zenoh `get`. `bulk`: pictures and sound, which a recording keeps as they
    are instead of as JSON. `keep` "latest" means only the newest value matters (dropped under load), "all" means
    reliable, in order, recovered after an outage. `text` names the field that bare text fills. `command`: values from
    before the reader's start are not acted on. `recover`: what a router outage swallowed is sent again. `abroad`:
    services of the other robots on the router that read it (`Io.others`). A `*` in the key of a row of `PER_SERVICE`
    stands for a service's name.
    """

    key: str
    type: type[M]
    writers: tuple[str, ...]
    readers: tuple[str, ...] = ()
    rate: float = 0.0
    latched: bool = False
    keep: Keep = "all"
    binary: bool = False
    bulk: bool = False
    text: str = ""
    command: bool = False
    recover: bool = True
    abroad: tuple[str, ...] = ()

    def __hash__(self) -> int:
        return hash(self.key)

    def of(self, name: str) -> str:
        """The key of one service, for a row of `PER_SERVICE`."""
        return self.key.replace("*", name)


class Query(msgspec.Struct, frozen=True):
    """A question that one service answers. `askers`: the services that ask it; people's tools may ask all but those
    that are for evaluators. `changing`: it changes something, so that an observer may not ask."""

    key: str
    server: str
    askers: tuple[str, ...] = ()
    changing: bool = False


# --- kinds of rows; `by` and `to` name services, separated by blanks
def goal(key: str, type: type[M], *, by: str, to: str, text: str = "", latched: bool = True) -> Topic[M]:
    """A topic of commands: delivered in order, none lost, none from before its reader's start."""
    return row(key, type, by, to, text=text, latched=latched, command=True)


def event(key: str, type: type[M], *, by: str, to: str = "", text: str = "") -> Topic[M]:
    """A topic of events or states: delivered in order, none lost."""
    return row(key, type, by, to, text=text, latched=True)


def stream(
    key: str,
    type: type[M],
    *,
    by: str,
    to: str,
    rate: float,
    binary: bool = True,
    latched: bool = False,
    bulk: bool = False,
) -> Topic[M]:
    """A topic of samples of which only the newest counts."""
    return row(key, type, by, to, rate=rate, binary=binary, latched=latched, bulk=bulk, keep="latest")


def sound(key: str, *, by: str, to: str) -> Topic[m.AudioChunk]:
    """A topic of sound, of which every chunk counts."""
    return row(key, m.AudioChunk, by, to, rate=10.0, binary=True, bulk=True)


def clock(key: str, rate: float) -> Topic[m.SimClockTick]:
    return row(key, m.SimClockTick, "sim", EACH, rate=rate, binary=True, recover=False)


def row(key: str, type: type[M], by: str, to: str, **how: Any) -> Topic[M]:
    return Topic(key=key, type=type, writers=tuple(by.split()), readers=tuple(to.split()), **how)
