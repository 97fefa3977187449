"""What is tried after a failure: a recovery says which failures it mends and builds the subtree that tries to."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from services.brain.mission.context import Context
from services.brain.tree.composites import Condition, Selector

Subtree = Callable[[], Behaviour]
"""Makes a fresh subtree at every call: a node has one parent."""


def _none() -> Behaviour:
    raise LookupError("a step of this kind has no such part")


@dataclass(frozen=True)
class Task:
    """The object that a failed step was about, as the plan names it, and the parts to try again with.

    `find` looks for it, `approach` drives up to it, `grab` closes the hand around it, `grasp` is both with their
    recoveries, `carry_back` drives to where it is put down, `put_down` lets go of it and looks.
    """

    item: str
    find: Subtree = _none
    approach: Subtree = _none
    grab: Subtree = _none
    grasp: Subtree = _none
    carry_back: Subtree = _none
    put_down: Subtree = _none
    in_place: Subtree = _none


@dataclass(frozen=True)
class Recovery:
    """`mends(ctx)`: the failure at hand is one that this helps against; `build(ctx, task)`: the subtree that tries."""

    node_id: str
    mends: Callable[[Context], bool]
    build: Callable[[Context, Task], Behaviour]


def with_recoveries(
    node_id: str, ctx: Context, first: Behaviour, recoveries: Sequence[Recovery], task: Task, name: str = ""
) -> Selector:
    """`first`; when it fails, each recovery that mends the failure, in order, until one succeeds."""
    others = [Condition(r.node_id, r.build(ctx, task), partial(r.mends, ctx), Status.FAILURE) for r in recoveries]
    return Selector(node_id, first, *others, name=name)
