"""`tidybot watch`: state, tree, plan, speech and services in the terminal, for those on ssh; space stops the robot."""

import argparse
import contextlib
import select
import sys
import termios
import tty
from collections.abc import Iterator
from typing import Any

from rich.console import Console, Group
from rich.layout import Layout
from rich.live import Live
from rich.panel import Panel
from rich.table import Table
from rich.text import Text
from rich.tree import Tree

from cli.link import Link, Subscription, linked, robot_command
from common import messages as m
from common import topics
from common.mission_log.states import limb_words, under_way
from common.mission_log.transcript import PEOPLE, Transcript
from common.process.health_records import HealthRecords
from common.time.clock import monotonic
from common.topic import Topic

COLOURS = {"RUNNING": "bold blue", "SUCCESS": "green", "FAILURE": "red", "INVALID": "bright_black"}
GOOD, BAD, FAINT = "green", "bold red", "bright_black"
SERVICES_EVERY = 1.0
"""Time [s] between two looks at the processes."""
LINES = 12
"""Lines of the transcript."""
KEYS = "space stop, r resume, y/n, q"


class Picture:
    """What the screen shows; `update` takes the messages that have arrived."""

    def __init__(self, link: Link) -> None:
        self._link = link
        self._watches: dict[str, Subscription[Any]] = {
            t.key: Subscription(link, t)
            for t in (
                topics.BRAIN_STATE, topics.BRAIN_TREE, topics.ACTION_PLAN, topics.SIM_STATUS, topics.SPEECH_STATUS,
                topics.SPEECH_GOAL, topics.SPEECH_RESULT, topics.VOICE_COMMAND, topics.NAVIGATION_FEEDBACK,
                topics.MANIPULATION_STATUS,
            )
        }  # fmt: skip
        self.now: dict[str, Any] = {}
        self.said, self.health = Transcript(), HealthRecords()
        self.alive: set[str] = set()
        self._asked = float("-inf")

    def update(self) -> None:
        for key, watch in self._watches.items():
            for message in watch.drain():
                self.now[key] = message
                self.hear(message)
        if monotonic() - self._asked >= SERVICES_EVERY:
            self._asked = monotonic()
            self.alive = self._link.alive()
            for record in self._link.health().values():
                self.health.take(record)

    def hear(self, message: m.Message) -> None:
        """Note what is said in a message, in either direction."""
        if isinstance(message, m.SpeechGoal):
            self.said.add_goal(monotonic(), message)
        elif isinstance(message, m.SpeechResult):
            self.said.add_result(monotonic(), message)
        elif isinstance(message, m.VoiceCommand):
            self.said.add_command(monotonic(), message)

    def get(self, topic: Topic[Any]) -> Any:
        return self.now.get(topic.key)


def mission(picture: Picture) -> Group:
    """State, command, step, plan, base, arm, last outcome."""
    state, sim = picture.get(topics.BRAIN_STATE), picture.get(topics.SIM_STATUS)
    rows: list[Any] = []
    if sim is not None and sim.state == "stopped":
        rows.append(Text("STOPPED: the brake is on", style=BAD))
    if state is None:
        return Group(*rows, Text("the brain has not been heard", style=FAINT))
    head = Text(state.state, style="bold")
    head.append(f"  {state.detail}", style=FAINT)
    rows.append(head)
    if state.command and under_way(state):
        rows.append(Text(f"“{state.command}”  step {state.step}  for {max(0.0, state.t - state.started):.0f} s"))
    plan = picture.get(topics.ACTION_PLAN)
    if plan is not None and state.pipeline == "vla":
        for n, step in enumerate(plan.steps, 1):
            rows.append(Text(f"  {n}. {step.words}"))
    for name, topic in (("base", topics.NAVIGATION_FEEDBACK), ("arm", topics.MANIPULATION_STATUS)):
        status = picture.get(topic)
        if status is not None:
            rows.append(Text(f"{name}: {limb_words(status)}"))
    if state.last is not None:
        why = f" ({state.last.reason})" if state.last.reason else ""
        style = GOOD if state.last.outcome == "delivered" else BAD
        rows.append(Text(f"last: {state.last.command}: {state.last.outcome}{why}", style=style))
    return Group(*rows)


def tree(snapshot: m.TreeSnapshot | None, whole: bool = False) -> Tree | Text:
    """The behaviour tree; what neither runs nor failed is folded below the first levels, unless `whole`."""
    if snapshot is None:
        return Text("no tree yet", style=FAINT)

    def label(node: m.TreeNode) -> Text:
        text = Text(node.name, style=COLOURS.get(status(node), FAINT))
        return text.append(f"  {node.detail}", style=FAINT) if node.detail else text

    def status(node: m.TreeNode) -> str:
        return node.status.rpartition(".")[2].upper()

    def grow(node: m.TreeNode, onto: Tree, depth: int) -> None:
        for child in node.children:
            branch = onto.add(label(child))
            if whole or status(child) in ("RUNNING", "FAILURE") or depth < 1:
                grow(child, branch, depth + 1)

    root = Tree(label(snapshot.root), guide_style=FAINT)
    grow(snapshot.root, root, 0)
    return root


def services(picture: Picture) -> Table:
    table = Table(box=None, pad_edge=False, padding=(0, 1, 0, 0))
    for n, name in enumerate(("", "service", "died", "Hz", "MB", "drops", "up s")):
        table.add_column(name, justify="right" if n > 1 else "left", no_wrap=True)
    rows = {row.name: row for row in picture.health.rows(lambda name: name in picture.alive)}
    for name in sorted(rows.keys() | picture.alive):
        word = Text("●", style=GOOD) if name in picture.alive else Text("✗", style=BAD)
        row = rows.get(name)
        if row is None:
            table.add_row(word, name)
            continue
        numbers = (row.restarts, row.hz, row.rss_mb, row.drops, row.uptime)
        table.add_row(word, name, *(f"{n:.0f}" for n in numbers))
        if row.error:
            table.add_row("", Text(row.error[:60], style=BAD))
    return table


def drawn(picture: Picture, tree_alone: bool = False) -> Layout | Tree | Text:
    """The whole screen: mission, tree, speech, services; or every node of the tree."""
    if tree_alone:
        return tree(picture.get(topics.BRAIN_TREE), whole=True)
    talk = Text()
    for line in list(picture.said.lines)[-LINES:]:
        people = line.who in PEOPLE
        talk.append(f"{line.who}: " if people else "robot: ", style=FAINT if people else "blue").append(
            f"{line.text}\n"
        )
    layout = Layout()
    # 80 columns are enough for the table of services.
    layout.split_row(Layout(name="left", ratio=4), Layout(name="right", ratio=5))
    layout["left"].split_column(
        Layout(Panel(mission(picture), title="mission"), ratio=3), Layout(Panel(talk, title="speech"), ratio=2)
    )
    layout["right"].split_column(
        Layout(Panel(tree(picture.get(topics.BRAIN_TREE)), title="tree"), ratio=3),
        Layout(Panel(services(picture), title="services", subtitle=KEYS), ratio=2),
    )
    return layout


@contextlib.contextmanager
def keyboard() -> Iterator[bool]:
    """Single key presses while inside; False when nobody types here."""
    if not sys.stdin.isatty():
        yield False
        return
    before = termios.tcgetattr(sys.stdin)
    try:
        tty.setcbreak(sys.stdin)
        yield True
    finally:
        termios.tcsetattr(sys.stdin, termios.TCSADRAIN, before)


def press(link: Link, key: str) -> bool:
    """Carry out a key press; False for the key that leaves."""
    if key == " ":
        link.send(topics.ROBOT_STOP, m.RobotStop(reason="space bar", source="tidybot watch"))
    elif key == "r":
        link.send(topics.ROBOT_RESUME, m.RobotResume(source="tidybot watch"))
    elif key in ("y", "n"):
        link.send(topics.VOICE_COMMAND, m.VoiceCommand(text={"y": "yes", "n": "no"}[key], confirmed=True))
    return key != "q"


def watch(args: argparse.Namespace) -> int:
    console = Console()
    with linked(args) as link:
        picture = Picture(link)
        picture.update()
        if args.once:
            console.print(drawn(picture, args.tree), height=None if args.tree else args.height)
            return 0
        shown = drawn(picture, args.tree)
        with keyboard() as typing, Live(shown, console=console, screen=True, auto_refresh=False) as live:
            while True:
                waiting = select.select([sys.stdin] if typing else [], [], [], 0.2)[0]
                if waiting and not press(link, sys.stdin.read(1)):
                    return 0
                picture.update()
                live.update(drawn(picture, args.tree), refresh=True)


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = robot_command(commands, watch, "state, tree, plan, speech and services in the terminal; space stops")
    parser.add_argument("--once", action="store_true", help="print one picture and leave")
    parser.add_argument("--tree", action="store_true", help="only the behaviour tree, with every node of it")
    parser.add_argument("--height", type=int, default=40, help="lines of that picture (default %(default)s)")
