"""A participant of the lockstep that gives one command and keeps a fingerprint of every message of every tick.

`python -m bench.determinism.witness` is it as a process; parameters as TIDYBOT__WITNESS__<KEY>.
"""

import hashlib
import zlib
from pathlib import Path
from typing import Any

import msgspec

from common import messages as m
from common import topics
from common.bus.port import Io
from common.config import Config
from common.runtime import main
from common.time.lockstep import DT

RANDOM = ("epoch", "world")  # of the process, not of the run
UNTRACED = {t.key for t in topics.CLOCKS} | {
    "sim/ack",
    "camera/head/rgbd",
    "camera/wrist/rgbd",
    "page/status",
    "robot/description",
}
SHOWN = 400
"""Bytes of a payload that are shown."""


class WitnessConfig(Config, frozen=True):
    """Say `command` at robot time `at` [s]; end `after` seconds behind the end of the mission, or at `limit` [s]."""

    command: str = "bring me the red mug"
    at: float = 8.0
    after: float = 1.0
    limit: float = 300.0
    trace: str = ""


class Sight(msgspec.Struct, array_like=True):
    """One message: its tick and key, its fingerprint, and its text unless it is of a stream."""

    tick: int
    key: str
    print: int
    text: str = ""


class Trace(msgspec.Struct):
    """A whole run: a hash of all physics and joint states, and all messages."""

    hash: str
    ticks: int
    outcome: str
    sights: list[Sight]


class WitnessService:
    """Subscribes to everything, a tick after it was published, as every participant does."""

    NAME = "witness"
    HZ = 100
    CONFIG = WitnessConfig
    READS = tuple(t for t in topics.TABLE if t.key not in UNTRACED)
    WRITES = (topics.VOICE_COMMAND,)

    def __init__(self, config: WitnessConfig, io: Io) -> None:
        self._config, self._io = config, io
        self._hash = hashlib.sha256()
        self._sights: list[Sight] = []
        self._said = False
        self._over_at = float("inf")
        self._outcome = ""
        self._began: float | None = None
        self.trace: Trace | None = None

    def step(self, now: float) -> None:
        if self.trace is not None:
            return
        first = self._began is None
        self._began = now if self._began is None else self._began
        tick = round(now / DT)
        for topic in self.READS:
            for message in self._io.take_all(topic):
                if not first:  # which of the messages from before the first tick arrive is chance
                    self._see(tick, topic, message)
        if not self._said and now >= self._config.at:
            self._said = True
            words = m.VoiceCommand(text=self._config.command, id="witness-1", confirmed=True)
            self._io.publish(topics.VOICE_COMMAND, words)
        if now >= min(self._over_at, self._config.limit):
            self._end(tick)

    def _see(self, tick: int, topic: "topics.Topic[Any]", message: m.Message) -> None:
        for field in RANDOM:
            if field in message.__struct_fields__:
                setattr(message, field, "")
        payload = msgspec.json.encode(message)
        if topic.key in ("sim/state", "joint_states"):
            self._hash.update(payload)
        text = payload[:SHOWN].decode("utf-8", "replace")
        self._sights.append(Sight(tick, topic.key, zlib.crc32(payload), text))
        if isinstance(message, m.BrainState) and self._said and message.last is not None:
            self._outcome = f"{message.last.outcome} {message.last.reason}".strip()
            self._over_at = min(self._over_at, tick * DT + self._config.after)

    def _end(self, tick: int) -> None:
        self.trace = Trace(self._hash.hexdigest(), tick, self._outcome or "no outcome", self._sights)
        if self._config.trace:
            # Renamed into place: who waits for the file must not see half of it.
            path = Path(self._config.trace)
            path.with_suffix(".part").write_bytes(msgspec.json.encode(self.trace))
            path.with_suffix(".part").rename(path)


if __name__ == "__main__":
    main(WitnessService)
