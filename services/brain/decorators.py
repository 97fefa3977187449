"""Decorators of the trees, on the robot's clock."""

from collections.abc import Callable, Iterator

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.decorators import Decorator

from services.brain.context import Context


class Attempts(Decorator):
    """Runs its child again after a failure, at most `retries` times, a settle later, if `again()` agrees."""

    def __init__(self, name: str, ctx: Context, child: Behaviour, retries: int, again: Callable[[], bool]) -> None:
        super().__init__(name=name, child=child)
        self._ctx, self._retries, self._again = ctx, retries, again
        self.used = 0
        self._resume_at = 0.0

    def initialise(self) -> None:
        self.used, self._resume_at, self.feedback_message = 0, 0.0, ""

    def tick(self) -> Iterator[Behaviour]:
        if self.status == Status.RUNNING and self._ctx.now < self._resume_at:
            yield self
            return
        yield from super().tick()

    def update(self) -> Status:
        if self.decorated.status != Status.FAILURE or self.used >= self._retries or not self._again():
            return self.decorated.status
        self.used += 1
        self._resume_at = self._ctx.now + self._ctx.config.settle
        self.feedback_message = f"retry {self.used} of {self._retries}"
        self._ctx.note(f"{self.name}: {self.feedback_message}")
        return Status.RUNNING


class When(Decorator):
    """Runs its child only when the condition holds at the start; ends with `otherwise` if not."""

    def __init__(
        self, name: str, child: Behaviour, condition: Callable[[], bool], otherwise: Status = Status.SUCCESS
    ) -> None:
        super().__init__(name=name, child=child)
        self._condition, self._otherwise = condition, otherwise

    def tick(self) -> Iterator[Behaviour]:
        if self.status != Status.RUNNING and not self._condition():
            self.decorated.stop(Status.INVALID)
            self.stop(self._otherwise)
            yield self
            return
        yield from super().tick()

    def update(self) -> Status:
        return self.decorated.status
