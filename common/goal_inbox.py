"""The goals that a service receives: none is carried out twice, a newer one pre-empts the one under way."""

from collections import OrderedDict
from collections.abc import Callable, Sequence
from typing import Any, Generic, Protocol, TypeVar

from common.bus.port import Io
from common.topic import Topic


class Identified(Protocol):
    """A goal or query with the id that its sender gave it, "" when it gave none."""

    id: str


Goal = TypeVar("Goal", bound=Identified)
Answer = TypeVar("Answer")
CAPACITY = 256
"""Goals remembered (chosen: a sender repeats the one it waits for, a restarted brain the few of its mission)."""


class GoalInbox(Generic[Goal, Answer]):
    """Receives the goals on `topics` and remembers the newest by (id, attempt), each with its final answer.

    `begin(goal)` is called once for every goal, `repeat(goal, answer)` for one that was sent again, with None while it
    has no answer, and `preempt(old, new)` before `begin(new)` while `old` is under way. A goal without an id gets one.
    """

    def __init__(
        self,
        io: Io,
        topics: Sequence[Topic[Any]],
        begin: Callable[[Goal], None],
        repeat: Callable[[Goal, Answer | None], None],
        preempt: Callable[[Goal, Goal], None] = lambda old, new: None,
        capacity: int = CAPACITY,
    ) -> None:
        self._io, self._topics, self._capacity = io, topics, capacity
        self._begin, self._repeat, self._preempt = begin, repeat, preempt
        self._goals: OrderedDict[tuple[str, int], Answer | None] = OrderedDict()
        self.active: Goal | None = None

    def receive(self) -> None:
        """Take what has arrived since the last call, in order; once a step."""
        for topic in self._topics:
            for goal in self._io.take_all(topic):
                goal.id = goal.id or self._io.new_id(self._io.name)
                self._take(goal)

    def end(self, goal: Goal, answer: Answer | None) -> None:
        """Keep the final answer of a goal; it is under way no more. One that is forgotten stays so."""
        if _key(goal) in self._goals:
            self._goals[_key(goal)] = answer
        if self.active is not None and _key(self.active) == _key(goal):
            self.active = None

    def _take(self, goal: Goal) -> None:
        if _key(goal) in self._goals:
            self._repeat(goal, self._goals[_key(goal)])
            return
        self._goals[_key(goal)] = None
        while len(self._goals) > self._capacity:
            self._goals.popitem(last=False)
        if self.active is not None:
            self._preempt(self.active, goal)
        self.active = goal
        self._begin(goal)


def _key(goal: Identified) -> tuple[str, int]:
    """Identity of a goal; those without attempts are told apart by their id alone."""
    return goal.id, getattr(goal, "attempt", 0)
