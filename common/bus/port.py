"""What a service sees of the outside world: the same protocol over Zenoh and over memory."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any, NamedTuple, Protocol, TypeVar

import numpy as np

from common import messages as m
from common.household import Household
from common.scene import Scene
from common.topic import Topic

M = TypeVar("M", bound=m.Message)
R = TypeVar("R")
R_co = TypeVar("R_co", covariant=True)
Handler = Callable[[bytes], bytes]


class Outside(NamedTuple):
    """`open` opens a session of this service on the robot's router whose keys are not below the robot's `namespace`,
    `beside` one below another robot's."""

    namespace: str
    open: Callable[[], AbstractContextManager[Any]]
    beside: Callable[[str], AbstractContextManager[Any]]


class Log(Protocol):
    def debug(self, event: str, **fields: Any) -> None: ...
    def info(self, event: str, **fields: Any) -> None: ...
    def warning(self, event: str, **fields: Any) -> None: ...
    def error(self, event: str, **fields: Any) -> None: ...


class Job(Protocol[R_co]):
    """Slow work under way in the service's one worker."""

    def poll(self, now: float) -> bool:
        """True once the result may be used."""

    def result(self) -> R_co:
        """The value, or the exception that the work raised."""


class Io(Protocol):
    """A service's bus, worker, randomness and logger. `fresh`: something arrived for this step.

    `household`: what the robot is told of its home, by its file and, in services that read `household/edits`, by people
    since; `loaded`: by its file alone. `world`: what is really there; with a `LookupError` for all but the simulation
    and its judges (`KNOWS_WORLD`). `state_dir`: where a process keeps files that outlive it; None within an evaluation.
    `outside`: what gateways to other wires need of the router; None where there is none.
    `robot`: the namespace, which is the robot's name among others on its router; "" for the only one.
    """

    name: str
    epoch: str
    seed: int
    household: Household
    loaded: Household
    world: Scene
    rng: np.random.Generator
    log: Log
    lockstep: bool
    fresh: bool
    state_dir: Path | None
    outside: Outside | None
    robot: str

    def amend(self, edits: m.HouseholdEdits) -> None:
        """Apply what people have told to `household`: for the service that keeps it."""

    def take_all(self, topic: Topic[M]) -> list[M]:
        """Every message received since the last step, oldest first."""

    def latest(self, topic: Topic[M]) -> M | None:
        """The newest message ever received, None before the first."""

    def age(self, topic: Topic[M], now: float) -> float:
        """Robot seconds since the newest message was received; inf before the first."""

    def others(self, topic: Topic[M]) -> dict[str, M]:
        """The newest message of every other robot on the router, by its name; of topics that name this service in
        `abroad`. A robot that has left stays: the message tells how old it is."""

    def beside(self, robot: str) -> "Io":
        """This service as it is for another robot, in whose namespace it speaks and hears too: for a simulation that
        has several. Steps with this one."""

    def publish(self, topic: Topic[M], message: M) -> None: ...

    def submit(self, fn: Callable[..., R], *args: Any, seconds: float = 0.2) -> Job[R]:
        """Run fn(*args) in the worker; in lockstep its result is visible exactly `seconds` later."""

    def dispose(self, fn: Callable[[], None]) -> None:
        """Run fn() in the worker, behind what it is doing, and wait: for what has to be freed where it was made.

        Nothing happens where the worker never did anything.
        """

    def serve(self, key: str, handler: Handler) -> None:
        """Answer zenoh `get` on `key`; the handler runs in the service's thread before a step."""

    def ask(self, key: str, request: bytes = b"") -> Job[bytes | None]:
        """What a zenoh `get` on the key answers first, asked in the worker; None when nobody does."""

    def peer(self, name: str) -> str | None:
        """The epoch of a live peer process, "" while unknown, None when its token is gone."""

    def has_subscribers(self, topic: Topic[Any]) -> bool:
        """True when somebody subscribes to what this process publishes on the topic."""

    def demand(self, topic: Topic[Any], wanted: bool) -> None:
        """Subscribe, or no longer, to a topic of the service's ON_DEMAND; of a latched one the present value comes.

        Nothing that was published before is delivered, and what an outage swallowed is not sent again.
        """

    def new_id(self, prefix: str) -> str: ...

    def count_drop(self, key: str, reason: str) -> None:
        """Count input that was refused, in the service's health."""
