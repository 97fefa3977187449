"""A grounder of one's own is asked once for a query that words, names and print did not answer."""

from collections.abc import Sequence

from common.bus.port import Io, Job
from common.messages import ObjectQuery, WorldObject
from services.perception.naming.grounders.grounder import Candidate, Choice, Grounder, GrounderError, Question
from services.perception.naming.sights import Sights

MAX_CANDIDATES = 20
"""Objects among which one is chosen, the nearest ones. Chosen: more marks cover the picture."""


class Consultant:
    """`grounder`: None where there is none; `seconds`: robot time [s] that an answer takes in lockstep."""

    def __init__(self, io: Io, grounder: Grounder | None, seconds: float) -> None:
        self._io, self._grounder, self._seconds = io, grounder, seconds
        self._job: Job[Choice] | None = None
        self._asked = ""
        self._choice = Choice()

    @property
    def busy(self) -> bool:
        """It thinks about a question."""
        return self._job is not None

    def ask(self, query: ObjectQuery, sights: Sights, objects: Sequence[WorldObject]) -> bool:
        """True when the question is under way now; False for one that was asked before, or with nobody to ask."""
        question = None if self._asked == query.id or self.busy else question_of(query.query, sights, objects)
        if self._grounder is None or question is None:
            return False
        self._asked, self._choice = query.id, Choice()
        self._job = self._io.submit(self._grounder.choose, question, seconds=self._seconds)
        return True

    def step(self, now: float) -> None:
        """Take the answer."""
        if self._job is None or not self._job.poll(now):
            return
        try:
            self._choice = self._job.result()
            self._io.log.info("grounder", detail=self._choice.detail, confidence=self._choice.confidence)
        except GrounderError as error:
            self._io.log.warning("the grounder does not answer", reason=str(error))
        self._job = None

    def chosen(self, query: ObjectQuery, objects: Sequence[WorldObject]) -> WorldObject | None:
        """The object that was chosen for the query; None when none was."""
        key = self._choice.key if self._asked == query.id else ""
        return next((o for o in objects if key and o.id == key), None)


def question_of(phrase: str, sights: Sights, objects: Sequence[WorldObject]) -> Question | None:
    """The question about the newest picture; None when it shows no object."""
    labels = {o.id: o.label for o in objects if not o.held}
    crops = [(s.crop, k) for k in sights.shown if k in labels and (s := sights.by_id.get(k)) and s.crop is not None]
    near = sorted(crops, key=lambda row: row[0].distance)[:MAX_CANDIDATES]
    if sights.view is None or not near:
        return None
    candidates = tuple(Candidate(key, labels[key], crop.box) for crop, key in near)
    return Question(phrase, sights.view.rgb, candidates)
