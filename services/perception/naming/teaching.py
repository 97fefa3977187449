"""What people teach: `perception/teach` to a kept name, its object found among those in sight."""

import math
from collections.abc import Callable, Sequence

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Pose2, to_frame
from common.goal_inbox import GoalInbox
from common.household import Household
from common.naming.names import match_object, normalise
from services.perception.naming.memory import NameMemory, Taught
from services.perception.naming.observer import Observer
from services.perception.naming.sights import Sight
from services.perception.naming.text import SURE

TIMEOUT = 6.0
"""Time [s] within which a picture for a new name must have come."""
BEFORE, WIDE = 2.0, 0.8
"""Distance [m] and angle [rad] to the heading up to which an object stands before the robot."""
CLEARLY, PER_RADIAN = 0.25, 0.8
"""How much nearer [m] the object meant by "this" must be than the next one, and the distance [m] that counts for a
radian to the side."""
CLICKED = 0.15
"""Distance [m] of a click on the map from the object that it means. Chosen: half a hand's breadth beside a box."""
LONGEST = 40
"""Characters of a name."""


class Teacher:
    """Teaches and forgets names. `taken(name)` says what a name means already; `changed()` is called afterwards."""

    def __init__(
        self,
        io: Io,
        memory: NameMemory,
        observer: Observer,
        taken: Callable[[str], str],
        changed: Callable[[], None],
    ) -> None:
        self._io, self._memory, self._observer, self._taken, self._changed = io, memory, observer, taken, changed
        self._inbox: GoalInbox[m.TeachRequest, m.TeachResult] = GoalInbox(
            io, (topics.TEACH,), self._begin, self._repeat, self._preempt
        )
        self._waiting: m.TeachRequest | None = None
        self._target: m.WorldObject | None = None
        self._deadline = self._now = 0.0
        self.bound: dict[str, str] = {}

    @property
    def wants_picture(self) -> bool:
        """A name waits for a picture of what it is for."""
        return self._waiting is not None and self._target is None

    def step(self, now: float) -> None:
        """Take requests; end the one under way when its object was looked at, or in vain."""
        self._now = now
        self._inbox.receive()
        if self._target is not None and not self._observer.busy:
            self._keep(self._target)
        elif self._waiting is not None and now > self._deadline:
            self._refuse("NOT_SEEN", "no picture has come")

    def see(self, objects: Sequence[m.WorldObject], shown: Sequence[str], base: Pose2) -> None:
        """A picture has come that shows the objects with the ids `shown`."""
        if self._waiting is None or self._target is not None:
            return
        found = meant(self._waiting, objects, shown, base, self._io.household)
        if len(found) > 1:
            labels = sorted(o.label for o in found)
            self._refuse("AMBIGUOUS", f"it could be the {' or the '.join(labels)}", labels)
        elif not found:
            what = f"no {self._waiting.label}" if self._waiting.label else "nothing before me that it could be"
            self._refuse("NOT_SEEN", f"I see {what}")
        else:
            self._target = found[0]

    # --- requests
    def _begin(self, request: m.TeachRequest) -> None:
        name = normalise(request.name)
        self._waiting, self._target = request, None
        self._deadline = self._now + TIMEOUT
        if not name or len(name) > LONGEST:
            self._refuse("NO_NAME", "that is no name" if not name else "that name is too long")
        elif request.forget:
            self._forget(name)
        elif meaning := self._taken(name):
            self._refuse("NAME_TAKEN", f"{name} means {meaning} already")

    def _repeat(self, request: m.TeachRequest, answer: m.TeachResult | None) -> None:
        if answer is not None:
            self._io.publish(topics.TAUGHT, answer)

    def _preempt(self, old: m.TeachRequest, new: m.TeachRequest) -> None:
        self._answer(m.TeachResult(goal_id=old.id, ok=False, name=old.name, code="PREEMPTED", detail="another came"))

    def _forget(self, name: str) -> None:
        if name not in self._memory.names:
            self._refuse("UNKNOWN_NAME", f"I was never told what {name} is")
        elif not self._memory.forget(name):
            self._refuse("NOT_KEPT", "my disk does not take it")
        else:
            self.bound.pop(name, None)
            self._end(m.TeachResult(goal_id="", ok=True, name=name))

    def _keep(self, target: m.WorldObject) -> None:
        assert self._waiting is not None
        sight, name = self._observer.sight(target.id), normalise(self._waiting.name)
        if sight is None or not sight.looks:
            self._refuse("NOT_SEEN", f"I have not seen enough of the {target.label}; put it down before me")
        elif not self._memory.teach(taught(name, target, sight)):
            self._refuse("NOT_KEPT", "my disk does not take it, or there are too many names")
        else:
            self.bound[name] = target.id
            self._end(m.TeachResult(goal_id="", ok=True, name=name, label=target.label))

    def _refuse(self, code: m.TeachCode, detail: str, candidates: Sequence[str] = ()) -> None:
        assert self._waiting is not None
        name = normalise(self._waiting.name)
        result = m.TeachResult(goal_id="", ok=False, name=name, code=code, detail=detail, candidates=list(candidates))
        self._end(result)

    def _end(self, result: m.TeachResult) -> None:
        request = self._waiting
        assert request is not None
        result.goal_id, result.attempt = request.id, request.attempt
        self._waiting = self._target = None
        self._inbox.end(request, result)
        self._answer(result)
        if result.ok:
            self._changed()

    def _answer(self, result: m.TeachResult) -> None:
        self._io.log.info("taught", name=result.name, label=result.label, code=result.code, detail=result.detail)
        self._io.publish(topics.TAUGHT, result)


def meant(
    request: m.TeachRequest, objects: Sequence[m.WorldObject], shown: Sequence[str], base: Pose2, household: Household
) -> list[m.WorldObject]:
    """The object that a request is about; several when it could be each of them, none when there is none."""
    if request.label:
        exact = [o for o in objects if o.label == request.label]
        return exact or match_object(request.label, objects, household)
    if request.position is not None:
        x, y, _ = request.position
        near = sorted(objects, key=lambda o: math.hypot(o.position[0] - x, o.position[1] - y))
        return [o for o in near[:1] if math.hypot(o.position[0] - x, o.position[1] - y) < CLICKED]
    held = [o for o in objects if o.held]
    if held:
        return held
    visible = [o for o in objects if o.id in shown]
    words = set(normalise(request.name).split())
    # "This is my vitamin box": a box, where one is there.
    kin = [o for o in visible if words & {o.kind, *o.colours, o.colour}] or visible
    before = sorted(((c, o.id, o) for o in kin if (c := _aside(o, base)) is not None), key=lambda row: row[:2])
    return [o for cost, _, o in before if cost < before[0][0] + CLEARLY]


def _aside(o: m.WorldObject, base: Pose2) -> float | None:
    """How far [m] it is from what one means by "this", None when it is not before the robot."""
    x, y = to_frame(base, (o.position[0], o.position[1]))
    angle = abs(math.atan2(y, x))
    distance = math.hypot(x, y)
    return distance + PER_RADIAN * angle if distance < BEFORE and angle < WIDE else None


def taught(name: str, o: m.WorldObject, sight: Sight) -> Taught:
    """What is kept of an object for its name."""
    lines = [(line.text, line.confidence) for line in sight.lines if line.confidence >= SURE]
    return Taught(name=name, kind=o.kind, colour=o.colour, size=o.size, looks=list(sight.looks), lines=lines)
