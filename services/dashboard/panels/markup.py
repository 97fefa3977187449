"""The panels' contents as HTML, from the templates beside this module; whatever comes from the bus is escaped."""

from collections.abc import Collection, Container, Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment

from common import messages as m
from common.html.environment import environment
from common.language.offers import offered
from common.mission_log.states import limb_words, under_way
from common.mission_log.transcript import Line
from common.process.health_records import ServiceRow
from services.dashboard.panels.history_buffers import NodePath

TEMPLATES = Path(__file__).parent / "templates"
GOOD, BAD, FAINT = "#2b8a3e", "#c92a2a", "#868e96"
COLOURS = {"RUNNING": "#1c7ed6", "SUCCESS": GOOD, "FAILURE": BAD, "INVALID": "#adb5bd"}
SIGNS = {"RUNNING": "▶", "SUCCESS": "✓", "FAILURE": "✗", "INVALID": "·"}
SPEAKERS = {"said": ("robot", "#1c7ed6"), "heard": ("heard", GOOD), "typed": ("typed", GOOD), "robot": ("", FAINT)}
"""Word and colour of a transcript line by who said it."""
UNFOLDED = 2
"""Levels of the tree that are shown though they were never reached."""

Reason = tuple[float, str, str]
"""Time [s], status and detail of a tree node."""
_NONE: Mapping[NodePath, Reason] = {}


@cache
def _templates() -> Environment:
    made = environment(TEMPLATES)
    made.globals.update(good=GOOD, bad=BAD, faint=FAINT)
    return made


def _render(name: str, **values: Any) -> str:
    return _templates().get_template(name).render(**values)


def tree(root: m.TreeNode, last: Mapping[NodePath, Reason] = _NONE) -> str:
    """The behaviour tree: running nodes are lit, branches never reached are folded, `last` reasons beside the nodes."""
    reported = {path[:n] for path in last for n in range(1, len(path) + 1)}
    return _render("tree.html", rows=_rows(root, (), last, reported))


def _rows(
    node: m.TreeNode, path: NodePath, last: Mapping[NodePath, Reason], reported: Container[NodePath]
) -> Iterator[dict[str, Any]]:
    past = node.status == "INVALID" and path in last
    detail = node.detail
    if past:
        t, status, words = last[path]
        detail = f"{SIGNS.get(status, '·')} {words} ({t:.0f} s)"
    yield {
        "depth": len(path), "name": node.name, "status": node.status, "past": past, "detail": detail,
        "colour": COLOURS.get(node.status, FAINT), "sign": SIGNS.get(node.status, "·"),
    }  # fmt: skip
    for n, child in enumerate(node.children):
        below = (*path, f"{n} {child.name}")
        if node.status != "INVALID" or len(path) < UNFOLDED or below in reported:
            yield from _rows(child, below, last, reported)


def mission(
    state: m.BrainState | None,
    now: float,
    steps: Iterable[m.PlanStep],
    navigation: m.NavigationFeedback | None,
    manipulation: m.ManipulationStatus | None,
) -> str:
    """State, command, step, plan, status of base and arm at robot time `now` [s], and the last outcome."""
    busy, last = under_way(state), state.last if state is not None else None
    if last is not None and state is not None and busy and last.id == state.mission_id:
        last = None
    both = (("base", navigation), ("arm", manipulation))
    limbs = [(name, limb_words(status)) for name, status in both if status is not None]
    now_at = state.plan_step if state is not None else 0
    # The plan of a mission that has ended is in its timeline.
    shown = [(step.words, number == now_at) for number, step in enumerate(steps, 1)] if busy else []
    return _render("mission.html", state=state, now=now, busy=busy, steps=shown, limbs=limbs, last=last)


def transcript(lines: Iterable[Line]) -> str:
    """Who said what, newest first."""
    return _render("transcript.html", lines=list(lines)[::-1], looks=SPEAKERS)


def services(rows: Iterable[ServiceRow], restartable: Collection[str] = (), why: str = "") -> str:
    """The table of services with buttons for the `restartable` ones; `why` there are no buttons."""
    rows = list(rows)
    silent = sorted(set(restartable) - {row.name for row in rows})
    return _render("services.html", rows=rows, restartable=restartable, silent=silent, why=why)


def missions(rows: Iterable[dict[str, Any]]) -> str:
    """The missions of the log, newest first; each leads to its timeline."""
    return _render("missions.html", rows=list(rows)[::-1])


# --- the status bar at the top of the page: the mission under way; between missions how the last one ended
def resumable(state: m.BrainState | None) -> str:
    """The command of the last mission when it can be resumed; "" otherwise."""
    if state is None or state.last is None or under_way(state):
        return ""
    return state.last.command if state.last.resumable else ""


def status_bar(state: m.BrainState | None, sim: m.SimStatus | None, t: float) -> dict[str, Any]:
    """What the status bar shows at robot time `t` [s], as plain values for JSON."""
    asking = state is not None and state.state == "CONFIRMING"
    busy = under_way(state)
    mission: dict[str, Any] | None = None
    if state is not None and busy:
        # A question has its own place, beside the buttons that answer it.
        step = "" if asking else state.step
        mission = {"command": state.command, "step": step, "seconds": max(0, int(t - state.started))}
    return {
        "state": state.state if state is not None else "",
        "detail": state.detail if state is not None else "",
        "mission": mission,
        "last": state.last if state is not None and not busy else None,
        "asking": asking,
        "question": state.step if state is not None and asking else "",
        "offered": offered(state.step) if state is not None and asking else [],
        "stopped": sim is not None and sim.state == "stopped",
        "left": resumable(state),
    }
