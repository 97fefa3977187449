"""Requests of the page to the supervisor and the brain's mission log, made in the worker one at a time."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import msgspec

from common import topics
from common.bus.port import Io, Job
from services.dashboard.supervisor_client import NOBODY, Refused, Supervisor

REFRESH = 5.0
"""Time [s] between two looks at what can be restarted and at the missions; chosen: a person's patience."""
MOST = 30
"""Requests that may wait; chosen: more than a person clicks before the first is answered."""
Report = Callable[[str], None]


@dataclass
class Request:
    """`start` begins it in the worker; `done` gets the finished job."""

    start: Callable[[], Job[Any]]
    done: Callable[[Job[Any]], None]
    job: Job[Any] | None = None


class BackgroundRequests:
    """Keeps the restartable processes and the missions of the log, refreshed while the page is open."""

    def __init__(self, io: Io, supervisor: Supervisor, report: Report) -> None:
        self._io, self._supervisor, self._report = io, supervisor, report
        self._queue: deque[Request] = deque()
        self._due = float("-inf")
        self.restartable: tuple[str, ...] = ()
        self.why = ""
        self.missions: list[dict[str, Any]] | None = None

    def step(self, now: float, watched: bool) -> None:
        """Begin or finish the request whose turn it is; `watched`: the page is open."""
        if watched and now >= self._due:
            self._due = now + REFRESH
            self._add(partial(self._io.submit, self._supervisor.names), self._names)
            self._add(partial(self._io.ask, topics.BRAIN_MISSIONS), self._missions)
        if not self._queue:
            return
        request = self._queue[0]
        if request.job is None:
            request.job = request.start()
        elif request.job.poll(now):
            self._queue.popleft()
            request.done(request.job)

    def restart(self, name: str) -> None:
        """Restart a process as `tidybot restart` does."""
        self._report(f"restarting {name[:40]}")
        self._add(partial(self._io.submit, partial(self._supervisor.restart, name)), partial(self._restarted, name))

    def mission(self, mission_id: str, answer: Callable[[dict[str, Any] | None], None]) -> None:
        """The record of one mission for `answer`, None when there is none."""
        wanted = msgspec.json.encode({"id": mission_id})
        ask = partial(self._io.ask, topics.BRAIN_MISSIONS, wanted)
        self._add(ask, lambda job: answer(_decoded(job.result(), dict)))

    def _add(self, start: Callable[[], Job[Any]], done: Callable[[Job[Any]], None]) -> None:
        if len(self._queue) < MOST:
            self._queue.append(Request(start, done))

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
            self._report(f"{name[:40]} was not restarted: {refused}")
        else:
            self._report(f"{name} was restarted")


def _decoded(payload: bytes | None, kind: type[Any]) -> Any:
    try:
        found = msgspec.json.decode(payload or b"null")
    except msgspec.DecodeError:
        return None
    return found if isinstance(found, kind) else None
