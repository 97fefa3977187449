"""Slow errands of the page, one at a time in the worker: the supervisor, and the brain's journal."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import msgspec

from common import topics
from common.bus.port import Io, Job
from services.dashboard.restart import NOBODY, Refused, Supervisor

LOOK, MOST = 5.0, 30
Told = Callable[[str], None]


@dataclass
class Errand:
    """`job` starts it; `done` gets its result, or what it raised."""

    start: Callable[[], Job[Any]]
    done: Callable[[Job[Any]], None]
    job: Job[Any] | None = None


class Care:
    """What can be restarted and what missions there were, as far as known; refreshed while somebody looks."""

    def __init__(self, io: Io, supervisor: Supervisor, told: Told) -> None:
        self._io, self._supervisor, self._told = io, supervisor, told
        self._queue: deque[Errand] = deque()
        self._due = float("-inf")
        self.restartable: tuple[str, ...] = ()
        self.why = ""
        self.missions: list[dict[str, Any]] | None = None

    def step(self, now: float, watched: bool) -> None:
        if watched and now >= self._due:
            self._due = now + LOOK
            self._add(partial(self._io.submit, self._supervisor.names), self._names)
            self._add(partial(self._io.ask, topics.BRAIN_MISSIONS), self._missions)
        if not self._queue:
            return
        errand = self._queue[0]
        if errand.job is None:
            errand.job = errand.start()
        elif errand.job.poll(now):
            self._queue.popleft()
            errand.done(errand.job)

    def restart(self, name: str) -> None:
        """As `tidybot restart`."""
        self._told(f"restarting {name[:40]}")
        self._add(partial(self._io.submit, partial(self._supervisor.restart, name)), partial(self._restarted, name))

    def mission(self, mission_id: str, answer: Callable[[dict[str, Any] | None], None]) -> None:
        """The record of one mission for `answer`, None when there is none."""
        request = msgspec.json.encode({"id": mission_id})
        self._add(
            partial(self._io.ask, topics.BRAIN_MISSIONS, request), lambda job: answer(_decoded(job.result(), dict))
        )

    def _add(self, start: Callable[[], Job[Any]], done: Callable[[Job[Any]], None]) -> None:
        if len(self._queue) < MOST:
            self._queue.append(Errand(start, done))

    def _names(self, job: Job[tuple[str, ...]]) -> None:
        self.restartable = job.result()
        self.why = "" if self.restartable else NOBODY

    def _missions(self, job: Job[bytes | None]) -> None:
        found = _decoded(job.result(), list)
        if found is not None:
            self.missions = [
                row for row in found if isinstance(row, dict) and {"id", "command", "reason"} <= row.keys()
            ]

    def _restarted(self, name: str, job: Job[None]) -> None:
        try:
            job.result()
        except Refused as refused:
            self._told(f"{name[:40]} was not restarted: {refused}")
        else:
            self._told(f"{name} was restarted")


def _decoded(payload: bytes | None, kind: type[Any]) -> Any:
    try:
        found = msgspec.json.decode(payload or b"null")
    except msgspec.DecodeError:
        return None
    return found if isinstance(found, kind) else None
