"""Composites and decorators of the trees. Every node has an id that stays when what is shown of it changes.

`node_id` is what the journal keeps of a node (`tree/path.py`); `name` is what people see, by default the id in words.
"""

from collections.abc import Callable, Iterator

from py_trees import composites, decorators
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from services.brain.mission.context import Context


def shown(node_id: str, name: str = "") -> str:
    """The name that people see of a node: `name`, or its id in words."""
    return name or node_id.replace("_", " ")


class Sequence(composites.Sequence):
    """Ticks its children in order until one fails; goes on at the running one."""

    def __init__(self, node_id: str, *children: Behaviour, name: str = "") -> None:
        super().__init__(name=shown(node_id, name), memory=True, children=list(children))
        self.node_id = node_id


class Selector(composites.Selector):
    """Fallback: ticks its children in order until one succeeds; goes on at the running one."""

    def __init__(self, node_id: str, *children: Behaviour, name: str = "") -> None:
        super().__init__(name=shown(node_id, name), memory=True, children=list(children))
        self.node_id = node_id


class Retry(decorators.Decorator):
    """Runs its child again after a failure, at most `retries` times, a settle later, if `again()` agrees.

    `free()`: the failure at hand was no try, and counts for none. `at_once`: there is nothing to wait for, as after a
    look that has shown nothing.
    """

    def __init__(
        self,
        node_id: str,
        ctx: Context,
        child: Behaviour,
        retries: int,
        again: Callable[[], bool],
        name: str = "",
        free: Callable[[], bool] = lambda: False,
        at_once: bool = False,
    ) -> None:
        super().__init__(name=shown(node_id, name), child=child)
        self.node_id = node_id
        self._ctx, self._retries, self._again, self._free = ctx, retries, again, free
        self._pause = 0.0 if at_once else ctx.config.settle
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
        if self.decorated.status != Status.FAILURE:
            return self.decorated.status
        free = self._free()
        if (self.used >= self._retries and not free) or not self._again():
            return self.decorated.status
        self.used += not free
        self._resume_at = self._ctx.now + self._pause
        self.feedback_message = f"retry {self.used} of {self._retries}"
        self._ctx.note(f"{self.name}: {self.feedback_message}")
        return Status.RUNNING


class Condition(decorators.Decorator):
    """Runs its child only if the condition holds when the child would start; ends with `otherwise` if it does not."""

    def __init__(
        self,
        node_id: str,
        child: Behaviour,
        condition: Callable[[], bool],
        otherwise: Status = Status.SUCCESS,
        name: str = "",
    ) -> None:
        super().__init__(name=shown(node_id, name), child=child)
        self.node_id = node_id
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
