"""The behaviour tree as a message for `brain/tree`, and its place as data for the journal."""

from collections.abc import Sequence
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Composite
from py_trees.decorators import Decorator

from common.messages import TreeNode, TreeSnapshot
from services.brain.journal import Place

Signature = tuple[Any, ...]


def signature(root: Behaviour) -> Signature:
    """Equal for two moments that look the same."""
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
    return TreeSnapshot(t=t, root=node_of(root), tick=tick)


# --- the place in the tree
class Moved(ValueError):
    """The tree is not the one of the path: another version or another configuration."""


def tip(root: Behaviour) -> Behaviour:
    """The deepest node at work between two ticks."""
    node = root
    while True:
        below = node.decorated if isinstance(node, Decorator) else getattr(node, "current_child", None)
        if below is None or below.status != Status.RUNNING:
            return node
        node = below


def path_to(node: Behaviour) -> list[Place]:
    """The way from the root to a node, the root left out."""
    path: list[Place] = []
    while node.parent is not None:
        path.append(Place(node.parent.children.index(node), node.name, getattr(node, "used", 0)))
        node = node.parent
    return path[::-1]


def path_by_name(root: Behaviour, *names: str) -> list[Place]:
    """The way down from the root along children of these names.

    Raises:
        Moved: one of them is not there.
    """
    path: list[Place] = []
    node = root
    for name in names:
        index = next((i for i, child in enumerate(node.children) if child.name == name), None)
        if index is None:
            raise Moved(f"no {name!r} below {node.name!r}")
        path.append(Place(index, name))
        node = node.children[index]
    return path


def put(root: Behaviour, path: Sequence[Place]) -> Behaviour:
    """Make the next tick begin at the end of the path, as if all before it had just been done; the node there.

    A place without a name fits whatever the node at its index is called.

    Raises:
        Moved: there is no such path; the tree is as it was.
    """
    nodes = [root]
    for place in path:
        unfold = getattr(nodes[-1], "unfold", None)
        if unfold is not None:
            unfold()
        below = nodes[-1].children
        if place.index >= len(below) or below[place.index].name != (place.name or below[place.index].name):
            raise Moved(f"no {place.name!r} below {nodes[-1].name!r}")
        nodes.append(below[place.index])
    root.stop(Status.INVALID)
    for node, place in zip(nodes, path, strict=False):
        node.status = Status.RUNNING
        if isinstance(node, Composite):
            node.current_child = node.children[place.index]
    for node, place in zip(nodes[1:], path, strict=True):
        if hasattr(node, "used"):
            node.used = place.used
            if node is nodes[-1]:
                node.status = Status.RUNNING
    return nodes[-1]
