"""How far each case came, with confidence: counts, Wilson intervals, and their bars as SVG. Pure."""

from collections.abc import Sequence
from html import escape
from typing import Any

from evaluation.case import Result
from evaluation.statistics import share, wilson

BUSY = {"PLANNING", "GROUNDING", "NAVIGATING", "GRABBING", "RETURNING", "RELEASING"}
CARRIED = 0.3
STAGES = ("understood", "at the object", "lifted", "carried", "delivered")


def reached(result: Result) -> dict[str, bool]:
    """Which stages a case came to, by physics where physics can tell."""
    states = set(_list(result.evidence.get("states")))
    things = [t for t in _list(result.evidence.get("things")) if isinstance(t, dict)]
    lifted = bool(things) and all(t["lifted"] for t in things)
    return {
        "understood": bool(states & BUSY) or lifted,
        "at the object": "GRABBING" in states or lifted,
        "lifted": lifted,
        "carried": lifted and all(t["carried"] > CARRIED for t in things),
        "delivered": result.delivered,
    }


def by_stage(results: Sequence[Result]) -> list[tuple[str, int, int]]:
    """(stage, cases that came so far, cases) of those in which something was to be delivered."""
    rows = [reached(r) for r in results if r.evidence.get("expected") == "delivered"]
    return [(stage, sum(row[stage] for row in rows), len(rows)) for stage in STAGES]


def bars(rows: Sequence[tuple[str, int, int]], width: int = 640) -> str:
    """A bar for each row with its 95 % interval as a whisker."""
    left, right, line = 150, 150, 34
    span = width - left - right
    parts = []
    for n, (name, good, count) in enumerate(rows):
        low, high = wilson(good, count)
        part, y = (good / count if count else 0.0), n * line + 6
        middle, begin, end = y + 11, left + span * low, left + span * high
        parts.append(
            f'<text x="{left - 8}" y="{middle + 4}" text-anchor="end">{escape(name)}</text>'
            f'<rect x="{left}" y="{y}" width="{span}" height="22" fill="#f1f3f5"/>'
            f'<rect x="{left}" y="{y}" width="{span * part:.1f}" height="22" fill="#69db7c"/>'
            f'<path d="M{begin:.1f} {middle}H{end:.1f}M{begin:.1f} {middle - 5}v10M{end:.1f} {middle - 5}v10" '
            'stroke="#212529" stroke-width="1.5" fill="none"/>'
            f'<text x="{left + span + 8}" y="{middle + 4}">'
            f"{share(good, count)}</text>"
        )
    return _svg(width, len(rows) * line + 8, parts, "success by stage")


def strip(values: Sequence[tuple[float, bool, str]], unit: str, top: float, width: int = 640) -> str:
    """One dot for each (value, good, title) along an axis from 0 to `top`, stacked where dots would overlap."""
    left, right = 30, 30
    span, heights = width - left - right, dict[int, int]()
    places = []
    for value, good, title in sorted(values, key=lambda v: v[0]):
        x = left + span * min(max(value / top, 0.0), 1.0)
        level = heights[round(x / 9)] = heights.get(round(x / 9), -1) + 1
        places.append((x, level, good, title))
    height = 26 + 9 * (1 + max(heights.values(), default=0))
    parts = [f'<line x1="{left}" y1="{height - 18}" x2="{width - right}" y2="{height - 18}" stroke="#adb5bd"/>']
    for n in range(6):
        x = left + span * n / 5
        parts.append(f'<text x="{x:.0f}" y="{height - 4}" text-anchor="middle">{top * n / 5:.3g} {unit}</text>')
    for x, level, good, title in places:
        colour = "#2b8a3e" if good else "#e03131"
        y = height - 24 - 9 * level
        parts.append(f'<circle cx="{x:.1f}" cy="{y}" r="4" fill="{colour}"><title>{escape(title)}</title></circle>')
    return _svg(width, height, parts, unit or "share")


def _svg(width: int, height: int, parts: Sequence[str], label: str) -> str:
    look = f'viewBox="0 0 {width} {height}" style="max-width:{width}px" role="img" aria-label="{label}"'
    return f"<svg {look}>{''.join(parts)}</svg>"


def _list(value: Any) -> list[Any]:
    return value if isinstance(value, list) else []
