"""Which goals a service has taken already, so that none is carried out twice however often it is sent."""

from collections import OrderedDict
from typing import Generic, TypeVar

Answer = TypeVar("Answer")
CAPACITY = 256
"""Goals remembered: a sender repeats the one it waits for, a restarted brain those of its mission, never older ones."""


class GoalRegister(Generic[Answer]):
    """The newest goals by (id, attempt), each with the answer that it got."""

    def __init__(self, capacity: int = CAPACITY) -> None:
        self._goals: OrderedDict[tuple[str, int], Answer | None] = OrderedDict()
        self._capacity = capacity

    def is_new(self, goal_id: str, attempt: int) -> bool:
        """True the first time, and from then on that goal is known."""
        if (goal_id, attempt) in self._goals:
            return False
        self._goals[goal_id, attempt] = None
        while len(self._goals) > self._capacity:
            self._goals.popitem(last=False)
        return True

    def answer(self, goal_id: str, attempt: int, answer: Answer) -> None:
        """Keep what a known goal was answered; one that is forgotten stays so."""
        if (goal_id, attempt) in self._goals:
            self._goals[goal_id, attempt] = answer

    def answered(self, goal_id: str, attempt: int) -> Answer | None:
        """What a goal was answered; None while it was not."""
        return self._goals.get((goal_id, attempt))
