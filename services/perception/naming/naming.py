"""Names of objects beside their labels: taught by a person, or read off the objects.

`Naming` is what the perception service has to do with that: it shows it its pictures and believed objects and gets
these back with `names` and `text`.
"""

import math
from collections.abc import Sequence

import msgspec

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Pose2
from common.naming.likeness import LEAST
from common.naming.names import match_object, normalise
from services.perception.config import PerceptionConfig
from services.perception.grounding import Phrase, possible
from services.perception.naming import reader
from services.perception.naming.appearance import Look
from services.perception.naming.consult import Consultant
from services.perception.naming.grounders.load import load_grounder
from services.perception.naming.memory import NameMemory
from services.perception.naming.observer import Observer
from services.perception.naming.promise import promise, unlike, worth_a_look
from services.perception.naming.recognise import TURNED, Evidence, Match, evidence, matches
from services.perception.naming.sights import Sight
from services.perception.naming.teaching import Teacher
from services.perception.naming.text import LIKELY, SURE, likeness, printed_words, shown, traces
from services.perception.naming.vocabulary import COLOURS, common_words, plain_words, printable, taken
from services.perception.views.view import View

HALF_READ, TRACE = 0.5, 0.41
"""Likeness, as `common.naming.likeness` has it, of what reads nearly like the words, and of what shows a part of one
word. Chosen: a person is asked about both when they are seen, about the second rather than about what shows none."""
SOMEWHAT: dict[Evidence, float] = {"same": 0.5, "silent": 0.4, "other": 0.1}
"""Likeness of what looks like the taught thing, by what print says of it. Chosen: a person is asked about the first two
when they are seen, about the last when nothing else was found."""
RESEMBLES = 0.12
"""Most likeness of what has but colour and kind of the taught thing. Chosen: asked about when nothing else is found."""
DOUBTFUL = 0.14
"""Likeness of what looks like the taught thing and was read from fewer than TURNED sides. Chosen: from another its
words are seen."""


class Naming:
    """Taught names and printed words of the objects in sight.

    Raises:
        StartError: the grounder of the configuration cannot be used.
    """

    def __init__(self, io: Io, config: PerceptionConfig) -> None:
        self._io, read = io, config.read
        self._consultant = Consultant(io, load_grounder(config), config.grounder_seconds)
        if read and not reader.installed():
            io.log.warning(reader.MISSING)
        self._reader = reader.Reader() if read and reader.installed() else None
        self._memory = NameMemory(io.state_dir, lambda why: io.log.warning("names", reason=why))
        self.reset()
        self._publish()

    def reset(self) -> None:
        """Another world: no object is known by sight any more; the names are."""
        self._observer = Observer(self._io, self._reader, self._learn)
        self._teacher = Teacher(
            self._io,
            self._memory,
            self._observer,
            lambda n: taken(n, self._io.household),
            self._publish,
        )
        self._matches: dict[str, Match] = {}

    @property
    def wants_picture(self) -> bool:
        """A fine picture is wanted, of what a name is taught for."""
        return self._teacher.wants_picture

    @property
    def busy(self) -> bool:
        """The worker looks at objects, or thinks about a question."""
        return self._observer.busy or self._consultant.busy

    def step(self, now: float) -> bool:
        """Take requests and what the worker has seen; True when objects may have other names or texts than before."""
        changed = self._observer.step(now)
        self._consultant.step(now)
        names = len(self._memory.names), *self._memory.names
        self._teacher.step(now)
        if changed or names != (len(self._memory.names), *self._memory.names):
            by_id, bound = self._observer.sights.by_id, self._teacher.bound
            self._matches = matches(self._memory.names, by_id, bound, self._observer.can_read)
            return True
        return False

    def see(self, view: View, objects: list[m.WorldObject], now: float, base: Pose2, fine: bool = False) -> None:
        """Take a picture and the objects believed in; a `fine` one was asked for to read or to be taught."""
        if view.camera != "head":
            return
        visible = self._observer.see(view, objects)
        if fine or self._memory.names:
            self._observer.look(visible, now, read=fine)
        if fine:
            self._teacher.see(objects, visible, base)

    def annotated(self, objects: list[m.WorldObject]) -> list[m.WorldObject]:
        """The objects with the names they have and the text that was read on them."""
        found = []
        for o in objects:
            sight, match = self._observer.sight(o.id), self._matches.get(o.id, Match())
            text = shown(sight.lines) if sight is not None else ""
            found.append(msgspec.structs.replace(o, names=list(match.names), text=text) if match.names or text else o)
        return found

    # --- questions
    def knows(self, phrase: str) -> bool:
        """It is a name that was taught."""
        return normalise(phrase) in self._memory.names

    def described(self, phrase: str) -> str:
        """A phrase, or colour and kind of what was taught by that name."""
        taught = self._memory.names.get(normalise(phrase))
        return f"{taught.colour} {taught.kind}" if taught is not None else phrase

    def resembling(self, phrase: str, objects: Sequence[m.WorldObject]) -> list[m.PossibleObject]:
        """The objects that have colour and kind of what was taught by that name, and no other words on them."""
        name = normalise(phrase)
        others = {o.id for o in objects if (s := self._observer.sight(o.id)) and self._evidence(name, s) == "other"}
        alike = possible(Phrase(self.described(phrase)), [o for o in objects if o.id not in others], self._io.household)
        return [msgspec.structs.replace(p, likeness=min(p.likeness, RESEMBLES)) for p in alike]

    def reads(self, phrase: str) -> bool:
        """What is printed can tell what is meant."""
        return self._observer.can_read and bool(self._asked_print(phrase))

    def match(self, phrase: str, objects: Sequence[m.WorldObject]) -> list[m.WorldObject]:
        """The objects that a phrase can mean: by their names and words, else by what is printed on them."""
        known = list(objects)
        if found := match_object(phrase, known, self._io.household):
            return found
        words = self._printed(phrase)
        if not words:
            return []
        said = normalise(phrase).split()
        beside = {*said, *COLOURS}
        scores = {o.id: likeness(words, o.text, beside) for o in known}
        best = max(scores.values(), default=0.0)
        # One that reads exactly so is meant rather than one that nearly does.
        read = [o for o in known if scores[o.id] >= max(SURE, min(best, 0.99))]
        # "Green tea" is what has both words on it, where several have "tea".
        others = [w for w in said if w not in words]
        read = [o for o in read if not unlike(o, said, others)]
        hits = {o.id: sum(likeness([w], o.text, beside) >= SURE for w in others) for o in read}
        return [o for o in read if hits[o.id] == max(hits.values())]

    def consult(self, query: m.ObjectQuery, objects: Sequence[m.WorldObject]) -> bool:
        """Ask the configured grounder about the newest picture; True when an answer is to be waited for."""
        return self._consultant.ask(query, self._observer.sights, objects)

    def chosen(self, query: m.ObjectQuery, objects: Sequence[m.WorldObject]) -> m.WorldObject | None:
        """What the grounder has chosen for the query."""
        return self._consultant.chosen(query, objects)

    def unread(self, query: str, answered: bool) -> bool:
        """A look at what is printed could answer the query, or tell a taught thing from one that looks like it."""
        if not self._observer.can_read:
            return False
        name = normalise(query)
        if name in self._memory.names:
            alike = [key for key, match in self._matches.items() if name in (*match.names, *match.perhaps)]
            return any((sight := self._observer.sight(key)) is not None and not sight.read for key in alike)
        return not answered and bool(self._printed(query))

    def unsure(self, query: str, objects: Sequence[m.WorldObject], base: Pose2) -> list[tuple[float, str]]:
        """Labels of objects that could be meant and have to be seen from nearer to tell, each with how much such a look
        promises, 0 to 1; the most promising first, of equal ones that which is nearest to `base`."""
        words, name = self._asked_print(query) if self._observer.can_read else [], normalise(query)
        found: list[tuple[float, float, str]] = []
        for o in objects:
            sight, promised = self._observer.sight(o.id), 0.0
            if name in self._matches.get(o.id, Match()).perhaps:
                # What has other words on it is looked at again when nothing else was found.
                promised = LEAST if sight is not None and self._evidence(name, sight) == "other" else 1.0
            elif words and printable(o):
                promised = promise(name, words, o, sight, self._io.household)
            if worth_a_look(promised) and not o.held:
                found.append((-promised, math.hypot(o.position[0] - base[0], o.position[1] - base[1]), o.label))
        return [(-promised, label) for promised, _, label in sorted(found)]

    def perhaps(self, query: str, objects: Sequence[m.WorldObject]) -> list[m.PossibleObject]:
        """The objects of which a person has to say whether they are meant: their print was half read, or they look
        somewhat like what was taught."""
        words, name = self._asked_print(query), normalise(query)
        said = name.split()
        beside = {*said, *COLOURS}
        found = []
        for o in objects:
            sight, like = self._observer.sight(o.id), 0.0
            if name in self._matches.get(o.id, Match()).perhaps and sight is not None:
                like = SOMEWHAT[self._evidence(name, sight)]
                if like == SOMEWHAT["silent"] and len(sight.read_from) < TURNED:
                    like = DOUBTFUL
            elif words and sight is not None and sight.read and printable(o):
                half = likeness(words, o.text, beside) >= LIKELY and not unlike(o, said, said)
                like = HALF_READ if half else TRACE if traces(words, o.text) >= SURE else 0.0
            if like and not o.held:
                found.append(m.PossibleObject(id=o.id, label=o.label, likeness=like, position=o.position, on=o.on))
        return sorted(found, key=lambda p: -p.likeness)

    def _asked_print(self, query: str) -> list[str]:
        """The words that are worth a nearer look: those that name no listed thing or kind, else any of a print."""
        return self._printed(query, common_words(self._io.household)) or self._printed(query)

    def _printed(self, query: str, common: frozenset[str] | None = None) -> list[str]:
        """The words of a query that may be print, which are not `common`; those of a taught name are not."""
        if self.knows(query):
            return []
        return printed_words(query, plain_words(self._io.household) if common is None else common)

    # --- names
    def confirm(self, phrase: str, key: str) -> None:
        """A person has said that the object with this id is the one that was taught by that name."""
        name = normalise(phrase)
        if name in self._memory.names and self._observer.sight(key) is not None:
            self._teacher.bound[name] = key

    def _evidence(self, name: str, sight: Sight) -> Evidence:
        return evidence(self._memory.names[name], sight)

    def _learn(self, key: str, look: Look) -> None:
        """What was followed since it was taught is known better with each side that it shows."""
        for name, bound in self._teacher.bound.items():
            sight = self._observer.sight(key)
            if bound == key and sight is not None and name in self._memory.names:
                self._memory.learn(name, look, sight.lines)

    def _publish(self) -> None:
        names = [taught.message for taught in self._memory.names.values()]
        self._io.publish(topics.HOUSEHOLD_NAMES, m.TaughtNames(names=names))
