"""History buffers of the page: reasons of the tree's nodes, and curves of the last minute."""

from collections import deque
from collections.abc import Iterator

import numpy as np

from common import messages as m
from common.geometry import Array

NodePath = tuple[str, ...]
"""A node of the tree: names from the root, each with its place among its siblings."""


def places(node: m.TreeNode, path: NodePath = ()) -> Iterator[tuple[NodePath, m.TreeNode]]:
    """All nodes below a node, each with its path."""
    for n, child in enumerate(node.children):
        place = (*path, f"{n} {child.name}")
        yield place, child
        yield from places(child, place)


class TreeReasons:
    """The last (time [s], status, detail) that each node of the tree gave."""

    def __init__(self) -> None:
        self.last: dict[NodePath, tuple[float, str, str]] = {}

    def take(self, tree: m.TreeSnapshot) -> None:
        """Note the reasons of a snapshot; nodes that are gone are forgotten."""
        now = dict(places(tree.root))
        self.last = {place: said for place, said in self.last.items() if place in now}
        for place, node in now.items():
            said = (node.status, node.detail)
            # A node that is only reset keeps saying why it ended.
            reset = node.status == "INVALID" and place in self.last
            if node.detail and not reset and self.last.get(place, (0.0, "", ""))[1:] != said:
                self.last[place] = (tree.t, *said)


class Curves:
    """Several values over time, at most one sample each `spacing` seconds, the last `seconds` of them."""

    def __init__(self, names: tuple[str, ...], seconds: float = 60.0, spacing: float = 0.1) -> None:
        self.names, self._spacing = names, spacing
        self._t: deque[float] = deque(maxlen=round(seconds / spacing))
        self._values = {name: deque[float](maxlen=self._t.maxlen) for name in names}

    def add(self, t: float, **values: float) -> None:
        """Samples too close to the last one are left out, unless they are larger: peaks are what one looks for."""
        if self._t and t - self._t[-1] < self._spacing:
            for name, value in values.items():
                self._values[name][-1] = max(self._values[name][-1], value)
            return
        self._t.append(t)
        for name in self.names:
            self._values[name].append(values.get(name, 0.0))

    def arrays(self) -> tuple[Array, ...]:
        """Age of each sample [s] (0: now), then the values of each name."""
        if not self._t:
            return (np.zeros(1), *(np.zeros(1) for _ in self.names))
        t = np.array(self._t)
        return (t - t[-1], *(np.array(self._values[name]) for name in self.names))


class Jitter:
    """Differences between a stream's steps on its own clock and the steps that passed here [s]."""

    def __init__(self) -> None:
        self._before: tuple[float, float] | None = None

    def late(self, stamped: float, now: float) -> float:
        """The difference [s] for a message stamped `stamped` that came at `now` [s]; 0 for the first."""
        before, self._before = self._before, (stamped, now)
        return abs((stamped - before[0]) - (now - before[1])) if before is not None else 0.0
