"""`tidybot tree`: the brain's behaviour tree as it is now."""

import argparse

import msgspec

from cli.link import Watch, linked, robot_command
from common import messages as m
from common import topics

MARKS = {"SUCCESS": "+", "FAILURE": "x", "RUNNING": "*", "INVALID": "-"}


def drawn(snapshot: m.TreeSnapshot) -> str:
    """One line a node: mark, name, detail; the running path stands out by `*`."""
    lines = [f"{snapshot.t:.2f} s   * running  + success  x failure  - idle"]

    def draw(node: m.TreeNode, depth: int) -> None:
        detail = f"  {node.detail}" if node.detail else ""
        mark = MARKS.get(node.status.rpartition(".")[2].upper(), "?")
        lines.append(f"{'  ' * depth}{mark} {node.name} [{node.type}]{detail}")
        for child in node.children:
            draw(child, depth + 1)

    draw(snapshot.root, 0)
    return "\n".join(lines)


def tree(args: argparse.Namespace) -> int:
    with linked(args) as link:
        watch = Watch(link, topics.BRAIN_TREE)
        snapshot: m.TreeSnapshot | None = watch.first()
        while True:
            if snapshot is not None:
                print(msgspec.json.encode(snapshot).decode() if args.json else drawn(snapshot), flush=True)
            if not args.follow:
                return 0
            snapshot = watch.next(1.0)


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = robot_command(commands, tree, "the brain's behaviour tree as it is now", json=True)
    parser.add_argument("--follow", "-f", action="store_true", help="print it again whenever it changes")
