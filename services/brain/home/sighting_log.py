"""What was seen where, kept over the days in one file of bounded size."""

import re
from collections.abc import Sequence

from common import messages as m
from common import topics
from common.bus.port import Io
from common.files.stored_file import StoredFile, home_file
from common.time.clock import unix_time
from common.whereabouts import decayed

MAX_ROWS = 400
"""Things and surfaces on which they were seen [count]: 60 KB; chosen: 100 things on four surfaces each."""
VISIT = 600.0
"""Time [s] after which a thing that is seen on the same surface counts again; chosen: a look at another time of day."""
SURE = 0.5
"""Confidence from which a thing counts as seen; chosen: what perception tells apart from its neighbours."""
SAVE, TELL = 30.0, 5.0
"""Time [s] from one save, and one message, to the next; a kill loses the visits of the last half minute."""
_NUMBER = re.compile(r" \d+$")
"""What tells two things of the same looks apart within one run."""


class SightingLog:
    """Counts visits on which each thing was seen on each surface; the least ones are dropped beyond MAX_ROWS."""

    def __init__(self, io: Io) -> None:
        self._io = io
        path = home_file(io.state_dir, "sightings", io.loaded.name)
        self._file = StoredFile(
            path, m.Sightings, lambda why: io.log.warning("sightings", reason=why), durable=False, folder=True
        )
        kept = self._file.load()
        self._rows: dict[tuple[str, str], m.Sighting] = {}
        for s in kept.sightings if kept is not None else ():
            self._take_up(s)
        self._seen: dict[str, float] = {}
        self._counted: dict[tuple[str, str], float] = {}
        self.date = 0.0
        self._saved = self._told = float("-inf")
        self._changed = self._untold = bool(self._rows)

    def step(self, now: float) -> None:
        """Take what perception reports; `now` is robot time [s]."""
        # Days count by the calendar; within an evaluation a seed has to repeat, and there are no days.
        self.date = date = unix_time() if self._io.state_dir is not None else now
        for report in self._io.take_all(topics.WORLD_OBJECTS):
            for o in report.objects:
                self._note(o, now, date)
        if self._untold and now - self._told >= TELL:
            self._told, self._untold = now, False
            self._io.publish(topics.SIGHTINGS, m.Sightings(t=date, sightings=list(self._rows.values())))
        if self._changed and now - self._saved >= SAVE:
            self.save(now)

    def save(self, now: float) -> None:
        """Write what has changed."""
        if self._changed and self._file.save(m.Sightings(t=self.date, sightings=list(self._rows.values()))):
            self._changed = False
        self._saved = now

    def _take_up(self, s: m.Sighting) -> None:
        """A row of an earlier process, on the surface that is there now: a home may have been mapped again since."""
        surface = self._io.loaded.resting_place(s.position)
        s.part = surface.name if surface is not None else s.part
        other = self._rows.get((s.thing, s.part))
        if other is not None:
            s.weight += other.weight
        self._rows[s.thing, s.part] = s

    def _note(self, o: m.WorldObject, now: float, date: float) -> None:
        """Count a thing once a visit, under its label and the names that people gave it."""
        if o.held or o.confidence < SURE or self._seen.get(o.id) == o.seen_at or not o.label:
            return
        if len(self._seen) > MAX_ROWS:
            self._seen.clear()
        self._seen[o.id] = o.seen_at
        part = self._part(o.on)
        for thing in (_NUMBER.sub("", o.label), *o.names):
            self._count(thing, part, o, now, date)

    def _count(self, thing: str, part: str, o: m.WorldObject, now: float, date: float) -> None:
        row = self._rows.get((thing, part))
        before = self._counted.get((thing, part), float("-inf"))
        again = not 0.0 <= now - before < VISIT
        weight = (decayed(row, date) if row is not None else 0.0) + again
        if again:
            self._counted[thing, part] = now
        self._rows[thing, part] = m.Sighting(
            thing=thing, kind=o.kind, colour=o.colour, part=part, weight=round(weight, 3), last=date,
            position=(round(o.position[0], 2), round(o.position[1], 2), round(o.position[2], 2)),
        )  # fmt: skip
        self._changed = self._untold = True
        if len(self._rows) > MAX_ROWS:
            least = min(self._rows.values(), key=lambda s: (decayed(s, date), s.last))
            del self._rows[least.thing, least.part]
            self._counted.pop((least.thing, least.part), None)

    def _part(self, on: str) -> str:
        """The surface, or the furniture, as the household file calls it, whatever it is called now."""
        home = self._io.household
        surface = home.receptacle(on) if on else None
        return self._io.loaded.receptacles[home.receptacles.index(surface)].name if surface is not None else on

    @property
    def rows(self) -> Sequence[m.Sighting]:
        """All that is kept."""
        return list(self._rows.values())
