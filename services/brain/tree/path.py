"""A place in the behaviour tree as data: ids of nodes from the root down, which survive other names and other siblings.

The ids named here are the ones that the resume policy knows. They are on disk: whoever changes one raises `FORMAT` in
`journal/records.py`.
"""

import itertools
from collections.abc import Sequence

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Composite
from py_trees.decorators import Decorator

from services.brain.journal.records import PathNode

MISSION, REPORT_FAILURE = "mission", "report_failure"
DO = "do"
"""What carries a mission out; its other child of the mission reports why that failed."""
AS_ASKED = "as_asked"
"""The fetch pipeline's part after the command was understood."""
PLANS = ("execute", "go_and_look")
"""Nodes that carry out a plan; their children are the plan's steps."""
PLAN_STEP = "step"
GRAB = "grab"


class PathNotFound(ValueError):
    """The tree has no such path: it is of another version or another configuration."""


def tip(root: Behaviour) -> Behaviour:
    """The deepest running node between two ticks."""
    node = root
    while True:
        below = node.decorated if isinstance(node, Decorator) else getattr(node, "current_child", None)
        if below is None or below.status != Status.RUNNING:
            return node
        node = below


def path_to(node: Behaviour) -> list[PathNode]:
    """The path from the root to a node, without the root."""
    path: list[PathNode] = []
    while node.parent is not None:
        name, siblings = _id(node), node.parent.children
        ordinal = sum(_id(child) == name for child in siblings[: siblings.index(node)])
        path.append(PathNode(name, ordinal, getattr(node, "used", 0)))
        node = node.parent
    return path[::-1]


def plan_step(node: Behaviour | None) -> int:
    """Number from 1 of the plan's step that a node belongs to; 0 when it belongs to none."""
    while node is not None and node.parent is not None:
        if _id(node.parent) in PLANS:
            return 1 + int(node.parent.children.index(node))
        node = node.parent
    return 0


def start_at(root: Behaviour, path: Sequence[PathNode]) -> Behaviour:
    """Make the next tick begin at the end of the path, as if all before it had just been done; the node there.

    Raises:
        PathNotFound: the tree is as it was.
    """
    nodes = [root]
    for step in path:
        unfold = getattr(nodes[-1], "unfold", None)
        if unfold is not None:
            unfold()
        alike = _alike(nodes[-1], step.node)
        if step.ordinal >= len(alike):
            raise PathNotFound(f"no {step} below {_id(nodes[-1])!r}")
        nodes.append(alike[step.ordinal])
    root.stop(Status.INVALID)
    for node, below in itertools.pairwise(nodes):
        node.status = Status.RUNNING
        if isinstance(node, Composite):
            node.current_child = below
    for node, step in zip(nodes[1:], path, strict=True):
        if hasattr(node, "used"):
            node.used = step.used
            if node is nodes[-1]:
                node.status = Status.RUNNING
    return nodes[-1]


def _id(node: Behaviour) -> str:
    return str(getattr(node, "node_id", ""))


def _alike(parent: Behaviour, node_id: str) -> list[Behaviour]:
    """The children of that id, in order."""
    return [child for child in parent.children if _id(child) == node_id]
