"""Slow work of a service, whose result shows at a robot time of its own."""

from concurrent.futures import Future
from typing import Generic, TypeVar

R = TypeVar("R")
WORKER_LIMIT = 600.0
"""Wall time that lockstep waits for work that is due [s]; chosen: loading a model on a busy machine."""
_EPSILON = 1e-6
"""Rounding of robot time [s]: far below a tick."""


class WorkerJob(Generic[R]):
    """A future whose result shows at a fixed robot time in lockstep, or as soon as ready otherwise."""

    def __init__(self, future: "Future[R]", due: float, lockstep: bool) -> None:
        self._future, self._due, self._lockstep = future, due, lockstep

    def poll(self, now: float) -> bool:
        if not self._lockstep:
            return self._future.done()
        if now < self._due - _EPSILON:
            return False
        self._future.exception(timeout=WORKER_LIMIT)
        return True

    def result(self) -> R:
        return self._future.result(timeout=0 if not self._lockstep else WORKER_LIMIT)
