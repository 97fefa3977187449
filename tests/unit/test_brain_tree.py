"""When the tree is shown: whenever a snapshot would be another, and only then."""

import gc
import random
import weakref
from collections.abc import Iterator

import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status
from py_trees.composites import Parallel, Selector, Sequence

from services.brain.tree.snapshot import Seen, node_of


class Leaf(Behaviour):
    """Ends as the dice say, with a remark or without."""

    def __init__(self, name: str, dice: random.Random) -> None:
        super().__init__(name)
        self._dice = dice

    def update(self) -> Status:
        self.feedback_message = self._dice.choice(("", "", "on its way"))
        return self._dice.choice((Status.RUNNING, Status.RUNNING, Status.SUCCESS, Status.FAILURE))


def grown(dice: random.Random, depth: int, names: Iterator[int]) -> Behaviour:
    if depth == 0:
        return Leaf(f"leaf {next(names)}", dice)
    below = [grown(dice, dice.randrange(depth), names) for _ in range(dice.randint(1, 3))]
    name = f"node {next(names)}"
    kind = dice.choice(("sequence", "selector", "parallel"))
    if kind == "parallel":
        return Parallel(name, policy=ParallelPolicy.SuccessOnOne(), children=below)
    composite = Sequence if kind == "sequence" else Selector
    return composite(name, memory=dice.random() < 0.8, children=below)


@pytest.mark.parametrize("seed", range(30))
def test_a_snapshot_is_due_when_it_would_be_another(seed: int) -> None:
    dice = random.Random(seed)
    root = grown(dice, 4, iter(range(10_000)))
    seen, before = Seen(), None
    for _ in range(200):
        if dice.random() < 0.05:
            root.stop(Status.INVALID)
        ticked = list(root.tick()) if dice.random() < 0.9 else []
        now = node_of(root)
        assert seen.changed(root, ticked) == (now != before)
        before = now


def test_nodes_of_a_plan_that_is_over_are_not_kept() -> None:
    seen, leaf = Seen(), Leaf("leaf", random.Random(1))
    seen.changed(leaf, list(leaf.tick()))
    gone = weakref.ref(leaf)
    del leaf
    gc.collect()
    assert gone() is None
