"""The behaviour tree as a message for `brain/tree`."""

from collections.abc import Sequence
from functools import cache
from weakref import WeakKeyDictionary

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.decorators import Decorator

from common.messages import TreeNode, TreeSnapshot


class Seen:
    """Status and feedback of nodes as last looked at, to tell whether a snapshot of the tree would be another."""

    def __init__(self) -> None:
        # Weak: the nodes of a mission's plan go with it.
        self._last = WeakKeyDictionary[Behaviour, tuple[Status, str]]()

    def changed(self, root: Behaviour, ticked: Sequence[Behaviour]) -> bool:
        """True when status or feedback of the root, of a node of the last tick or of a child of one is another.

        What is farther from the tick changes only with these: a node that is stopped stops all below it.
        """
        near = {root, *ticked, *(child for node in ticked for child in node.children)}
        now = {node: (node.status, node.feedback_message) for node in near}
        changed = any(self._last.get(node) != shown for node, shown in now.items())
        self._last.update(now)
        return changed


@cache
def _kind(kind: type[Behaviour]) -> str:
    return "Decorator" if issubclass(kind, Decorator) else kind.__name__


def node_of(behaviour: Behaviour) -> TreeNode:
    """A behaviour and all below it."""
    return TreeNode(
        name=behaviour.name,
        type=_kind(type(behaviour)),
        status=behaviour.status.value,
        detail=behaviour.feedback_message,
        children=[node_of(child) for child in behaviour.children],
    )


def snapshot(root: Behaviour, t: float, tick: int) -> TreeSnapshot:
    """The whole tree at robot time `t` [s] after `tick` ticks."""
    return TreeSnapshot(t=t, root=node_of(root), tick=tick)
