"""Queries for the object that words mean: answered when enough pictures were looked at and what is printed was read."""

import math
from dataclasses import dataclass

import msgspec

from common import messages as m
from common import topics
from common.bus.port import Io
from common.goal_inbox import GoalInbox
from common.naming.likeness import PLAIN
from common.naming.place_named import is_at
from services.perception.config import PerceptionConfig
from services.perception.grounding import Grounding, as_called, ground, may_be_meant, parsed, possible
from services.perception.naming.naming import Naming
from services.perception.naming.promise import PROMISING
from services.perception.tracking.beliefs import Beliefs
from services.perception.views.picture import jpeg
from services.perception.views.pictures import Pictures
from services.perception.views.state_buffer import StateBuffer
from services.perception.views.view import View


@dataclass
class Reading:
    """A query whose answer waits until the worker has looked at the objects that a picture (`view`) has shown (`seen`).

    `fine`: it waits for a finer picture as well, to read what is printed; `taken`: that has come, or none is needed.
    """

    seen: set[str]
    view: View
    taken: bool = False
    fine: bool = True


class Queries:
    """Takes queries, one at a time, and answers each from the views that were taken for it."""

    def __init__(
        self, config: PerceptionConfig, io: Io, state: StateBuffer, naming: Naming, beliefs: Beliefs, pictures: Pictures
    ) -> None:
        self._config, self._io, self._state = config, io, state
        self._naming, self._beliefs, self._pictures = naming, beliefs, pictures
        self._views = 0
        self._reading: Reading | None = None
        self._inbox: GoalInbox[m.ObjectQuery, m.ObjectPose] = GoalInbox(
            io, (topics.OBJECT_QUERY,), self._begin, self._repeat
        )

    @property
    def open(self) -> bool:
        """A query waits for its answer."""
        return self._inbox.active is not None

    @property
    def reading(self) -> bool:
        """A query waits for what is printed."""
        return self._reading is not None

    @property
    def wants_fine(self) -> bool:
        """The query that reads needs a finer picture."""
        return self._reading is not None and not self._reading.taken

    def receive(self) -> None:
        """Take the queries that have arrived."""
        self._inbox.receive()

    def forget(self) -> None:
        """Another world: what was to be read is not there any more."""
        self._reading = None

    def read(self) -> None:
        """The finer picture has come."""
        if self._reading is not None:
            self._reading.taken = True

    def see(self, view: View, seen: set[str]) -> None:
        """A `view` has shown the objects of those ids: answer the query if it was taken for it and is enough."""
        query = self._inbox.active
        if query is not None and view.t >= query.since:
            self._views += 1
            self._answer(seen, view)

    def finish_reading(self) -> None:
        """Answer the query once the fine picture for it was read."""
        reading = self._reading
        if reading is not None and reading.taken and not self._naming.busy:
            if not reading.fine:
                self._reading = None
            self._answer(reading.seen, reading.view)

    def _begin(self, query: m.ObjectQuery) -> None:
        # A picture that is under way was not taken for this question.
        self._pictures.forget()
        self._views, self._reading = 0, None

    def _repeat(self, query: m.ObjectQuery, answer: m.ObjectPose | None) -> None:
        if answer is not None:
            self._io.publish(topics.OBJECT_POSE, answer)

    def _answer(self, seen: set[str], view: View) -> None:
        query = self._inbox.active
        if query is None:
            return
        if self._naming.busy:
            self._reading = Reading(seen, view, taken=True, fine=self._reading is not None and self._reading.fine)
            return
        result = self._ground(query)
        found, nothing = result.found, result.found is None and not result.candidates
        unseen = nothing or (found is not None and found.id not in seen)
        if unseen and self._views < self._config.query_pictures:
            return
        read = self._reading is not None and self._reading.fine
        if not read and self._naming.unread(query.query, not nothing):
            self._reading = Reading(seen, view)
            return
        if nothing and self._naming.consult(query, self._beliefs.published):
            self._reading = Reading(seen, view, taken=True, fine=read)
            return
        answer = _message(query, result, jpeg(view) if query.since else b"")
        if found is None:
            answer.unsure, answer.unlikely = self._unsure(query.query, result.candidates)
        self._reading = None
        # Kept for a query that is sent again, without what costs memory.
        self._inbox.end(query, msgspec.structs.replace(answer, picture=b""))
        self._io.log.info("asked", query=query.query, found=answer.label, detail=answer.detail)
        self._io.publish(topics.OBJECT_POSE, answer)

    def _unsure(self, query: str, candidates: list[str]) -> tuple[list[str], list[str]]:
        """Labels of objects that have to be seen from nearer to tell whether they are meant, of the `candidates` if
        there are any; and of those of which not much is promised by that."""
        base, seen = self._state.base or (0.0, 0.0, 0.0), self._beliefs.published
        doubtful = self._beliefs.tracker.doubtful()
        if candidates:
            return [o.label for o in seen if o.id in doubtful and o.label in candidates], []
        phrase = parsed(query, self._io.household, self._config.synonyms)
        if phrase.place:
            query, seen = phrase.thing, [o for o in seen if is_at(o, phrase.place, self._io.household)]
        promised = self._naming.unsure(query, seen, base)
        near = [label for share, label in promised if share >= PROMISING]
        later = [label for _, label in promised if label not in near]
        # What is printed is hardly on what looks like none of its kinds, be it from far away.
        blurred = may_be_meant(self._naming.described(query), seen, doubtful, self._io.household, base)
        (later if self._naming.reads(query) else near).extend(o for o in blurred if o not in (*near, *later))
        return near, later

    def _ground(self, query: m.ObjectQuery) -> Grounding:
        base, household, config = self._state.base or (0.0, 0.0, 0.0), self._io.household, self._config
        looks = [o for o in self._beliefs.objects(query.since or -math.inf) if o.id not in query.excluded]
        told = self._beliefs.tracker.told_as(query.meant)
        if meant := next((o for o in looks if o.id == told and not o.held), None):
            self._naming.confirm(query.query, meant.id)
            return Grounding(meant)
        doubtful = self._beliefs.tracker.doubtful()
        objects = [as_called(o) if o.id in doubtful else o for o in looks]
        # What was put down is asked for by its label, whatever it looks like from there.
        least = 0.0 if query.since else PLAIN
        result = ground(query.query, objects, household, base, config.synonyms, self._naming.match, least)
        if result.found or result.candidates:
            return result
        chosen = self._naming.chosen(query, objects)
        if chosen:
            return Grounding(chosen, result.reason, perhaps=[])
        phrase = parsed(query.query, household, config.synonyms)
        read = self._naming.perhaps(query.query, looks)
        taught = self._naming.knows(query.query)
        alike = self._naming.resembling(query.query, looks) if taught else possible(phrase, looks, household)
        named = {p.id for p in read}
        fitting = [*read, *(p for p in alike if p.id not in named)]
        return Grounding(None, result.reason, perhaps=sorted(fitting, key=lambda p: -p.likeness))


def _message(query: m.ObjectQuery, result: Grounding, picture: bytes) -> m.ObjectPose:
    found = result.found
    if found is None:
        detail, candidates = result.reason, result.candidates
        return m.ObjectPose(
            query_id=query.id, found=False, detail=detail, candidates=candidates, perhaps=result.perhaps,
            picture=picture,
        )  # fmt: skip
    return m.ObjectPose(
        query_id=query.id, found=True, label=found.label, confidence=found.confidence, position=found.position,
        orientation=found.orientation, size=found.size, seen_at=found.seen_at,
        detail=f"on the {found.on}" if found.on else "", on=found.on, id=found.id, tilt=found.tilt, picture=picture,
    )  # fmt: skip
