"""A mission from the brain's journal as a picture: bands of states, marks for what was heard, seen, done and failed.

One self-contained HTML page; nothing is asked from outside.
"""

from collections.abc import Iterable, Sequence
from html import escape
from itertools import pairwise
from typing import Any

WIDTH, LEFT, RIGHT = 1080, 70, 14
BAND, LANE, TOP = 34, 26, 8
STATES = {
    "IDLE": "#ced4da", "WAITING": "#ced4da", "LISTENING": "#a5d8ff", "CONFIRMING": "#ffd8a8", "PLANNING": "#d0bfff",
    "GROUNDING": "#99e9f2", "NAVIGATING": "#74c0fc", "GRABBING": "#ffc078", "RETURNING": "#4dabf7",
    "RELEASING": "#ffe066", "COMPLETED": "#8ce99a", "ERROR": "#ff8787",
}  # fmt: skip
LANES = ("speech", "steps", "saw", "faults")
LANE_OF = {"heard": "speech", "note": "speech", "planned": "steps", "did": "steps", "saw": "saw", "failed": "faults"}
COLOURS = {"speech": "#1971c2", "steps": "#2b8a3e", "saw": "#0c8599", "faults": "#e03131"}
STYLE = """
:root { color-scheme: light; }
body { font: 14px/1.45 system-ui, sans-serif; max-width: 1100px; margin: 24px auto; padding: 0 16px; color: #212529; }
h1 { font-size: 20px; margin: 0 0 4px; } h2 { font-size: 16px; margin: 24px 0 6px; }
.faint { color: #868e96; } .good { color: #2b8a3e; } .bad { color: #c92a2a; }
svg { width: 100%; height: auto; display: block; } svg text { font: 11px system-ui, sans-serif; }
table { border-collapse: collapse; width: 100%; } td, th { text-align: left; padding: 3px 8px; vertical-align: top; }
tr { border-top: 1px solid #e9ecef; } td.t { text-align: right; white-space: nowrap; color: #868e96; }
.chip { border-radius: 4px; padding: 0 6px; font-size: 12px; white-space: nowrap; }
.frames { display: grid; grid-template-columns: repeat(auto-fill, minmax(220px, 1fr)); gap: 10px; margin-top: 12px; }
.frames figure { margin: 0; font-size: 12px; }
.failed td { background: #fff5f5; } img { max-width: 100%; border-radius: 4px; }
"""


def document(title: str, body: str, style: str = "") -> str:
    """A whole page around `body`."""
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f'<link rel="icon" href="data:,"><style>{STYLE}{style}</style></head><body>\n{body}\n</body></html>\n'
    )


def page(record: dict[str, Any], frames: Iterable[tuple[float, str, str]] = ()) -> str:
    """The page of one mission; `frames` are (seconds since it began, caption, JPEG in base64)."""
    outcome = record.get("outcome") or "under way"
    colour = {"delivered": "good", "under way": "faint"}.get(outcome, "bad")
    reason = f": {escape(str(record['reason']))}" if record.get("reason") else ""
    took = f" after {record['ended'] - record['started']:.1f} s, {record['steps']} goals" if record["outcome"] else ""
    body = (
        f"<h1>“{escape(str(record['command']))}”</h1>"
        f'<div><span class="{colour}">{escape(outcome)}</span>{took}{reason} '
        f'<span class="faint">mission {escape(str(record["id"]))}</span></div>'
        f"{picture(record)}{strip(frames)}<h2>What happened</h2>{table(record)}"
    )
    return document(f"{record['command']}: {outcome}", body)


def strip(frames: Iterable[tuple[float, str, str]]) -> str:
    """Key frames side by side."""
    shown = "".join(
        f'<figure><img alt="{escape(words)}" src="data:image/jpeg;base64,{jpeg}">'
        f'<figcaption><span class="faint">{t:.1f} s</span> {escape(words)}</figcaption></figure>'
        for t, words, jpeg in frames
    )
    return f'<div class="frames">{shown}</div>' if shown else ""


def spans(entries: Sequence[dict[str, Any]], began: float, ended: float) -> list[tuple[str, float, float]]:
    """(state, from, to) in seconds since the mission began, one after the other."""
    found: list[tuple[str, float, float]] = []
    changes = [(e["state"], min(max(0.0, e["t"] - began), ended - began)) for e in entries]
    changes.append(("", ended - began))
    for (state, start), (_, end) in pairwise(changes):
        if found and found[-1][0] == state:
            found[-1] = (state, found[-1][1], end)
        elif state:
            found.append((state, start, end))
    return found


def picture(record: dict[str, Any]) -> str:
    """The timeline as inline SVG."""
    entries = record["entries"]
    began = float(record["started"])
    last = max((float(e["t"]) for e in entries), default=began)
    ended = max(float(record["ended"] if record["outcome"] else record.get("until", last)), last)
    length = max(ended - began, 1.0)

    def x(seconds: float) -> float:
        return LEFT + (WIDTH - LEFT - RIGHT) * min(max(0.0, seconds), length) / length

    parts = [_text(4, TOP + BAND / 2 + 4, "state")]
    for state, start, end in spans(entries, began, ended):
        wide = max(x(end) - x(start), 1.0)
        parts.append(
            f'<rect x="{x(start):.1f}" y="{TOP}" width="{wide:.1f}" height="{BAND}" '
            f'fill="{STATES.get(state, "#dee2e6")}" stroke="#fff"><title>{escape(state)} {start:.1f} to {end:.1f} s'
            "</title></rect>"
        )
        if wide > 7 * len(state):
            parts.append(_text(x(start) + 4, TOP + BAND / 2 + 4, state))
    y = TOP + BAND + LANE
    for lane in LANES:
        parts.append(_text(4, y + 4, lane))
        parts.append(f'<line x1="{LEFT}" y1="{y}" x2="{WIDTH - RIGHT}" y2="{y}" stroke="#e9ecef"/>')
        parts += [_mark(x(e["t"] - began), y, lane, e) for e in entries if _lane(e) == lane]
        y += LANE
    step = _step(length)
    for n in range(int(length / step) + 1):
        at = x(n * step)
        parts.append(f'<line x1="{at:.1f}" y1="{TOP + BAND}" x2="{at:.1f}" y2="{y - 8}" stroke="#f1f3f5"/>')
        parts.append(_text(at - 4, y + 8, f"{n * step:g} s"))
    return f'<svg viewBox="0 0 {WIDTH} {y + 14}" role="img" aria-label="timeline">{"".join(parts)}</svg>'


def _lane(entry: dict[str, Any]) -> str:
    lane = LANE_OF.get(entry["kind"], "")
    if entry["kind"] == "note" and not entry["cause"].startswith(("asked", "said")):
        return ""
    return lane


def _mark(x: float, y: float, lane: str, entry: dict[str, Any]) -> str:
    words = escape(" - ".join(w for w in (entry["cause"], entry["evidence"]) if w))
    if lane == "faults":
        shape = f'<path d="M{x - 5:.1f} {y - 5}l10 10m0 -10l-10 10" stroke="{COLOURS[lane]}" stroke-width="3"'
    else:
        shape = f'<circle cx="{x:.1f}" cy="{y}" r="5" fill="{COLOURS[lane]}"'
    kind = "path" if lane == "faults" else "circle"
    return f"{shape}><title>{entry['t']:.1f} s {words}</title></{kind}>"


def _text(x: float, y: float, words: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="#495057">{escape(words)}</text>'


def _step(length: float) -> float:
    """Seconds between the marks of an axis, about ten of them."""
    return next((s for s in (1, 2, 5, 10, 20, 30, 60, 120, 300, 600) if length / s <= 12), 1800)


def table(record: dict[str, Any], extra: Iterable[str] = ()) -> str:
    """Every entry of the journal as a row."""
    rows = []
    state = ""
    for e in record["entries"]:
        shown = e["state"] if e["state"] != state else ""
        state = e["state"]
        chip = f'<span class="chip" style="background:{STATES.get(state, "#dee2e6")}">{escape(shown)}</span>'
        mark = ' class="failed"' if e["kind"] == "failed" else ""
        rows.append(
            f'<tr{mark}><td class="t">{max(0.0, e["t"] - record["started"]):.1f} s</td><td>{chip if shown else ""}</td>'
            f"<td>{escape(e['kind'] if e['kind'] != 'state' else '')}</td><td>{escape(e['cause'])}"
            f'<div class="faint">{escape(e["evidence"])}</div></td></tr>'
        )
    return f"<table>{''.join((*rows, *extra))}</table>"
