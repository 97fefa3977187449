"""The panels' contents as HTML; everything from the bus is escaped."""

from collections.abc import Iterable
from html import escape

from common import messages as m
from services.dashboard.history import Line, Row

COLOURS = {"RUNNING": "#1c7ed6", "SUCCESS": "#2b8a3e", "FAILURE": "#c92a2a", "INVALID": "#adb5bd"}
SIGNS = {"RUNNING": "▶", "SUCCESS": "✓", "FAILURE": "✗", "INVALID": "·"}
GOOD, BAD, FAINT = "#2b8a3e", "#c92a2a", "#868e96"
_BOX = "font:12px/1.5 system-ui,sans-serif;padding:0 .6em"


def block(text: str) -> str:
    return f'<div style="{_BOX}">{text}</div>'


def tree(root: m.TreeNode) -> str:
    """The behaviour tree; what runs is lit, finished branches are folded away, reasons beside the nodes."""
    rows: list[str] = []
    _node(root, 0, rows)
    return block(f'<div class="tree" style="white-space:nowrap;overflow-x:auto">{"".join(rows)}</div>')


def _node(node: m.TreeNode, depth: int, rows: list[str]) -> None:
    colour, sign = COLOURS.get(node.status, FAINT), SIGNS.get(node.status, "·")
    weight = "600" if node.status == "RUNNING" else "400"
    lit = "background:#1c7ed61f;border-radius:3px;" if node.status == "RUNNING" else ""
    detail = f' <span style="color:{FAINT}">{escape(node.detail)}</span>' if node.detail else ""
    rows.append(
        f'<div style="padding-left:{depth * 12}px;{lit}"><span style="color:{colour};font-weight:{weight}">'
        f"{sign} {escape(node.name)}</span>{detail}</div>"
    )
    if node.status != "INVALID" or depth < 2:
        for child in node.children:
            _node(child, depth + 1, rows)


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
    navigation: m.NavigationStatus | None,
    manipulation: m.ManipulationStatus | None,
) -> str:
    """State, command, step, timers, plan, and what the legs and the arm are at."""
    if state is None:
        return block(f'<span style="color:{FAINT}">The brain has not been heard yet.</span>')
    rows = [f'<b style="font-size:15px">{escape(state.state)}</b> {escape(state.detail)}']
    ended = state.last.id if state.last else ""
    if state.command and state.mission_id not in ("", ended):
        rows.append(f"“{escape(state.command)}”")
        rows.append(f"step <b>{escape(state.step)}</b>, {max(0.0, now - state.started):.0f} s since the command")
    plan = [f"<li>{_step(s, state.step)}</li>" for s in steps]
    if plan:
        rows.append(f'plan<ol style="margin:0;padding-left:1.6em">{"".join(plan)}</ol>')
    for name, status in (("base", navigation), ("arm", manipulation)):
        if status is not None:
            words = (status.status, getattr(status, "phase", ""), status.code, status.detail)
            rows.append(f"{name}: {escape(' '.join(w for w in words if w))}")
    if state.last is not None:
        colour = GOOD if state.last.outcome == "delivered" else BAD
        text = f"{state.last.command}: {state.last.outcome}"
        why = f" ({state.last.reason})" if state.last.reason else ""
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


def services(rows: Iterable[Row]) -> str:
    """A table; what is dead or has trouble stands out."""
    head = "".join(f"<th>{h}</th>" for h in ("service", "", "restarts", "Hz", "MB", "drops", "up s"))
    body = []
    for row in rows:
        colour, word = (GOOD, "alive") if row.alive else (BAD, "gone")
        numbers = (row.restarts, f"{row.hz:.0f}", f"{row.rss_mb:.0f}", row.drops, f"{row.uptime:.0f}")
        cells = "".join(f'<td style="text-align:right">{n}</td>' for n in numbers)
        body.append(f'<tr><td>{escape(row.name)}</td><td style="color:{colour}">{word}</td>{cells}</tr>')
        if row.error:
            body.append(f'<tr><td></td><td colspan="6" style="color:{BAD}">{escape(row.error[:120])}</td></tr>')
    return block(f'<table style="width:100%;border-spacing:6px 1px"><tr>{head}</tr>{"".join(body)}</table>')
