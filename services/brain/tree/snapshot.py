"""The behaviour tree as a message for `brain/tree`."""

from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.decorators import Decorator

from common.messages import TreeNode, TreeSnapshot

Signature = tuple[Any, ...]


def signature(root: Behaviour) -> Signature:
    """A value that changes whenever a snapshot would: status and feedback of every node."""
    nodes = [root]
    for node in nodes:  # not `iterate()`: its nested generators cost more than the whole tick
        nodes.extend(node.children)
    return tuple((node.status, node.feedback_message) for node in nodes)


def node_of(behaviour: Behaviour) -> TreeNode:
    """A behaviour and all below it."""
    kind = "Decorator" if isinstance(behaviour, Decorator) else type(behaviour).__name__
    return TreeNode(
        name=behaviour.name,
        type=kind,
        status=behaviour.status.value,
        detail=behaviour.feedback_message,
        children=[node_of(child) for child in behaviour.children],
    )


def snapshot(root: Behaviour, t: float, tick: int) -> TreeSnapshot:
    """The whole tree at robot time `t` [s] after `tick` ticks."""
    return TreeSnapshot(t=t, root=node_of(root), tick=tick)
