"""The panels' contents as HTML; everything from the bus is escaped."""

from collections.abc import Collection, Container, Iterable, Mapping
from html import escape
from typing import Any
from urllib.parse import quote

from common import messages as m
from services.dashboard.bar import under_way
from services.dashboard.history import Line, Path, Row

COLOURS = {"RUNNING": "#1c7ed6", "SUCCESS": "#2b8a3e", "FAILURE": "#c92a2a", "INVALID": "#adb5bd"}
SIGNS = {"RUNNING": "▶", "SUCCESS": "✓", "FAILURE": "✗", "INVALID": "·"}
GOOD, BAD, FAINT = "#2b8a3e", "#c92a2a", "#868e96"
_BOX = "font:12px/1.5 system-ui,sans-serif;padding:0 .6em"


def block(text: str) -> str:
    return f'<div style="{_BOX}">{text}</div>'


Reason = tuple[float, str, str]
_NONE: Mapping[Path, Reason] = {}


def tree(root: m.TreeNode, last: Mapping[Path, Reason] = _NONE) -> str:
    """The behaviour tree; what runs is lit, what was never reached is folded away, reasons beside the nodes."""
    rows: list[str] = []
    spoken = {place[:n] for place in last for n in range(1, len(place) + 1)}
    _node(root, (), rows, last, spoken)
    return block(f'<div class="tree" style="white-space:nowrap;overflow-x:auto">{"".join(rows)}</div>')


def _node(node: m.TreeNode, place: Path, rows: list[str], last: Mapping[Path, Reason], spoken: Container[Path]) -> None:
    colour, sign = COLOURS.get(node.status, FAINT), SIGNS.get(node.status, "·")
    weight = "600" if node.status == "RUNNING" else "400"
    lit = "background:#1c7ed61f;border-radius:3px;" if node.status == "RUNNING" else ""
    reason = escape(node.detail)
    if node.status == "INVALID" and place in last:
        t, status, detail = last[place]
        reason = f"<i>{SIGNS.get(status, '·')} {escape(detail)} ({t:.0f} s)</i>"
    rows.append(
        f'<div style="padding-left:{len(place) * 12}px;{lit}"><span style="color:{colour};font-weight:{weight}">'
        f'{sign} {escape(node.name)}</span> <span style="color:{FAINT}">{reason}</span></div>'
    )
    for n, child in enumerate(node.children):
        below = (*place, f"{n} {child.name}")
        if node.status != "INVALID" or len(place) < 2 or below in spoken:
            _node(child, below, rows, last, spoken)


def running(node: m.TreeNode) -> list[str]:
    """Names from the root to the leaf that runs."""
    if node.status != "RUNNING":
        return []
    below = next((path for child in node.children if (path := running(child))), [])
    return [node.name, *below]


def mission(
    state: m.BrainState | None,
    now: float,
    steps: Iterable[m.PlanStep],
    navigation: m.NavigationFeedback | None,
    manipulation: m.ManipulationStatus | None,
) -> str:
    """State, command, step, timers, plan, and what the legs and the arm are at."""
    if state is None:
        return block(f'<span style="color:{FAINT}">The brain has not been heard yet.</span>')
    rows = [f'<b style="font-size:15px">{escape(state.state)}</b> {escape(state.detail)}']
    if under_way(state):
        rows.append(f"“{escape(state.command)}”")
        step = f"step <b>{escape(state.step)}</b>, " if state.step else ""
        rows.append(f"{step}{max(0.0, now - state.started):.0f} s since the command")
    plan = [f"<li>{_step(s, state.step)}</li>" for s in steps]
    if plan:
        rows.append(f'plan<ol style="margin:0;padding-left:1.6em">{"".join(plan)}</ol>')
    for name, status in (("base", navigation), ("arm", manipulation)):
        if status is not None:
            words = (status.status, getattr(status, "phase", ""), status.code, status.detail)
            rows.append(f"{name}: {escape(' '.join(w for w in words if w))}")
    if state.last is not None and not (under_way(state) and state.last.id == state.mission_id):
        colour = GOOD if state.last.outcome == "delivered" else BAD
        text = f"{state.last.command}: {state.last.outcome}"
        reason = state.last.reason
        why = f" {reason}" if reason.startswith("(") else f" ({reason})" if reason else ""
        rows.append(f'last: <span style="color:{colour}">{escape(text + why)}</span>')
    return block("".join(f"<div>{row}</div>" for row in rows))


def _step(step: m.PlanStep, current: str) -> str:
    """A step of the plan; the one that the brain names now is bold."""
    words = escape(" ".join(w for w in (step.action, step.object, step.target, step.text) if w))
    meant = current.startswith(step.action) and (not step.object or step.object in current)
    return f"<b>{words}</b>" if meant else words


def transcript(lines: Iterable[Line]) -> str:
    """Newest first."""
    looks = {"said": ("robot", "#1c7ed6"), "heard": ("heard", GOOD), "typed": ("typed", GOOD), "robot": ("", FAINT)}
    rows = []
    for line in reversed(list(lines)):
        word, colour = looks.get(line.who, (line.who, FAINT))
        rows.append(
            f'<div><span style="color:{FAINT}">{line.t:.0f} s</span> '
            f'<span style="color:{colour}">{escape(word)}</span> {escape(line.text)}</div>'
        )
    return block("".join(rows) or f'<span style="color:{FAINT}">Nothing has been said yet.</span>')


def services(rows: Iterable[Row], restartable: Collection[str] = (), why: str = "") -> str:
    """A table; what is dead or has trouble stands out. `why`: there are no buttons."""
    head = "".join(f"<th>{h}</th>" for h in ("service", "", "again", "Hz", "MB", "drops", "up s", ""))
    body = []
    rows = list(rows)
    for row in rows:
        colour, word = (GOOD, "alive") if row.alive else (BAD, "gone")
        numbers = (row.restarts, f"{row.hz:.0f}", f"{row.rss_mb:.0f}", row.drops, f"{row.uptime:.0f}")
        cells = "".join(f'<td style="text-align:right">{n}</td>' for n in numbers)
        button = _button(row.name) if row.name in restartable else ""
        body.append(
            f'<tr><td>{escape(row.name)}</td><td style="color:{colour}">{word}</td>{cells}<td>{button}</td></tr>'
        )
        if row.error:
            body.append(f'<tr><td></td><td colspan="7" style="color:{BAD}">{escape(row.error[:120])}</td></tr>')
    for name in sorted(set(restartable) - {row.name for row in rows}):
        body.append(f'<tr><td>{escape(name)}</td><td colspan="6"></td><td>{_button(name)}</td></tr>')
    note = f'<div style="color:{FAINT}">{escape(why)}</div>' if why and not restartable else ""
    return block(f'<table style="width:100%;border-spacing:4px 1px"><tr>{head}</tr>{"".join(body)}</table>{note}')


def _button(name: str) -> str:
    """keys.js hands clicks on it to the page."""
    look = "font:11px system-ui;padding:0 .5em;border:1px solid #ced4da;border-radius:4px;cursor:pointer"
    return f'<button data-restart="{escape(name)}" title="Restart {escape(name)}" style="{look}">restart</button>'


def missions(rows: Iterable[dict[str, Any]]) -> str:
    """Newest first; each leads to its timeline."""
    lines = []
    for row in reversed(list(rows)):
        outcome = str(row.get("outcome") or "under way")
        colour = {"delivered": GOOD, "under way": "#1c7ed6"}.get(outcome, BAD)
        took = f"{row['ended'] - row['started']:.0f} s" if row.get("outcome") else ""
        why = f'<div style="color:{FAINT};padding-left:1em">{escape(str(row["reason"]))}</div>' if row["reason"] else ""
        address = f"/mission/{quote(str(row['id']), safe='')}"
        lines.append(
            f'<div><a href="{address}" target="_blank" rel="noopener">{escape(str(row["command"]))}</a> '
            f'<span style="color:{colour}">{escape(outcome)}</span> {took}</div>{why}'
        )
    return block("".join(lines) or f'<span style="color:{FAINT}">No missions yet.</span>')
