"""Faults of the host for a stack in one process: the router is unreachable, the disk is full."""

import resource
import tempfile
from typing import Any

from common.bus.mailbox import UNSTAMPED
from common.bus.memory import MemoryBus, MemoryIo
from common.topic import Topic


class OutageBus(MemoryBus):
    """A bus in memory that can be cut, as when the router is unreachable.

    As over Zenoh then: streams are lost, everything else is kept by its publisher and delivered in order afterwards.
    Outsiders, such as who observes the run, go on hearing.
    """

    def __init__(self) -> None:
        super().__init__()
        self.away = False
        self.outsiders: list[MemoryIo] = []
        self._kept: list[tuple[Topic[Any], bytes, int]] = []

    def put(self, topic: Topic[Any], payload: bytes, stamp: int = UNSTAMPED) -> None:
        if not self.away:
            super().put(topic, payload, stamp)
            return
        for io in self.outsiders:
            if topic.key in io._boxes:
                io._boxes[topic.key].put(payload, stamp)
        for tap in self._taps.get(topic.key, ()):
            tap.append(payload)
        if topic.keep == "all":
            self._kept.append((topic, payload, stamp))

    def back(self) -> None:
        """Reconnect, as when the router is reachable again."""
        self.away = False
        heard = {id(box) for io in self.outsiders for box in io._boxes.values()}
        kept, self._kept = self._kept, []
        for topic, payload, stamp in kept:
            if topic.latched:
                self.last[topic.key] = payload
            for box in self._readers.get(topic.key, ()):
                if id(box) not in heard:
                    box.put(payload, stamp)


class FullDisk:
    """While `full`, every write that makes a file of this process longer fails, as on a disk without room."""

    def __init__(self) -> None:
        self._before = resource.getrlimit(resource.RLIMIT_FSIZE)

    def full(self, yes: bool) -> bool:
        """True when a write indeed fails now."""
        soft, hard = self._before
        resource.setrlimit(resource.RLIMIT_FSIZE, (0 if yes else soft, hard))
        try:
            with tempfile.TemporaryFile() as file:
                file.write(b"x")
        except OSError:
            return True
        return False
