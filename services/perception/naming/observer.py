"""Looks at the objects of a picture in the worker: their appearance always, their print when it is asked for."""

from collections.abc import Callable
from dataclasses import dataclass

from common import messages as m
from common.bus.port import Io, Job
from services.perception.naming.appearance import Look, look_of
from services.perception.naming.crop import Crop
from services.perception.naming.reader import Reader
from services.perception.naming.sights import RENEWED, Sight, Sights
from services.perception.naming.text import Line
from services.perception.views.view import View

LOOK_SECONDS, READ_SECONDS = 0.005, 0.4
"""Robot time [s] that a look and a reading take in lockstep; measured on one core."""
MAX_READ = 8
"""Objects that are read in one go, the nearest first. Chosen: three seconds."""


@dataclass(frozen=True)
class Task:
    """An object's crop that the worker is to look at, and to `read`."""

    key: str
    crop: Crop
    read: bool


@dataclass(frozen=True)
class Seen:
    """What the worker made of a task; `lines` None when it was not to read, or could not."""

    task: Task
    look: Look
    lines: list[Line] | None


class Observer:
    """`reader`: None where nothing can be read. `taken(id, look)` is called for each look at an object."""

    def __init__(self, io: Io, reader: Reader | None, taken: Callable[[str, Look], None]) -> None:
        self._io, self._reader, self._taken = io, reader, taken
        self.sights = Sights()
        self._todo: dict[str, Task] = {}
        self._job: Job[list[Seen]] | None = None

    @property
    def busy(self) -> bool:
        """Something is still to be looked at."""
        return self._job is not None or bool(self._todo)

    @property
    def can_read(self) -> bool:
        return self._reader is not None

    def see(self, view: View, objects: list[m.WorldObject]) -> list[str]:
        """Cut the objects out of a picture; ids of those that it shows."""
        return self.sights.see(view, objects)

    def look(self, keys: list[str], now: float, read: bool = False) -> None:
        """Look at these objects: at those that were not of late, and `read` those that were not from so near."""
        read = read and self._reader is not None
        near = sorted((s.crop.distance, k) for k in keys if (s := self.sights.by_id[k]).crop is not None)
        for n, (_, key) in enumerate(near):
            sight = self.sights.by_id[key]
            crop = sight.crop
            assert crop is not None
            wanted = read and n < MAX_READ and sight.unread_side(crop)
            if wanted or now - sight.looked_at > RENEWED:
                self._todo[key] = Task(key, crop, wanted)

    def step(self, now: float) -> bool:
        """Hand the worker what is to be done; True when it has brought something."""
        finished = self._job is not None and self._job.poll(now)
        if self._job is not None and finished:
            self._take(self._job, now)
            self._job = None
        if self._job is None and self._todo:
            tasks, self._todo = list(self._todo.values()), {}
            seconds = sum(READ_SECONDS if t.read else LOOK_SECONDS for t in tasks)
            self._job = self._io.submit(observe, self._reader, tasks, seconds=seconds)
        return finished

    def _take(self, job: Job[list[Seen]], now: float) -> None:
        for seen in job.result():
            sight = self.sights.by_id.get(seen.task.key)
            if sight is None:  # it is no object any more
                continue
            sight.add(seen.look, now)
            if seen.lines is not None:
                sight.add_lines(seen.lines, seen.task.crop)
            self._taken(seen.task.key, seen.look)
        if self._reader is not None and self._reader.broken:
            self._io.log.warning("nothing can be read", reason=self._reader.broken)
            self._reader = None

    def sight(self, key: str) -> Sight | None:
        return self.sights.by_id.get(key)


def observe(reader: Reader | None, tasks: list[Task]) -> list[Seen]:
    """The worker's part."""
    return [
        Seen(task, look_of(task.crop), reader.read(task.crop) if task.read and reader is not None else None)
        for task in tasks
    ]
