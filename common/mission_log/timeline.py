"""A mission of the log as one self-contained HTML page: bands of states, marks of what was heard, seen and done."""

from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment

from common.html.environment import environment
from common.mission_log.states import OTHER_STATE, STATE_COLOURS, spans

TEMPLATES = Path(__file__).parent / "templates"
WIDTH, LEFT, RIGHT = 1080, 70, 14
"""Of the chart, and its margins [px of the view box]; chosen: within the page's 1100 px, with room for the
lanes' names."""
BAND, LANE, TOP = 34, 26, 8
"""Heights of the band of states and of a lane, and the margin above [px]."""
LETTER = 7
"""Width of a letter of a band's label [px]; chosen: most fonts at 11 px are narrower."""
LANES = {"speech": "#1971c2", "steps": "#2b8a3e", "saw": "#0c8599", "faults": "#e03131"}
"""Lanes of the chart with their colours, from top to bottom."""
LANE_OF = {"heard": "speech", "note": "speech", "planned": "steps", "did": "steps", "saw": "saw", "failed": "faults"}
MOST_TICKS = 12
"""Ticks of the axis; chosen: their labels do not touch."""
STEPS = (1, 2, 5, 10, 20, 30, 60, 120, 300, 600)
"""Distances between the ticks of the axis [s], the first that needs no more than `MOST_TICKS`."""


@cache
def _templates() -> Environment:
    return environment(TEMPLATES)


def page(record: dict[str, Any], frames: Iterable[tuple[float, str, str]] = ()) -> str:
    """The page of one record of the mission log; `frames` are (seconds since it began, caption, JPEG in base64)."""
    outcome = record.get("outcome") or "under way"
    return (
        _templates()
        .get_template("mission.html")
        .render(
            title=f"{record['command']}: {outcome}",
            record=record,
            outcome=outcome,
            outcome_class={"delivered": "good", "under way": "faint"}.get(outcome, "bad"),
            chart=chart(record),
            frames=list(frames),
            colours=STATE_COLOURS,
            other=OTHER_STATE,
        )
    )


def chart(record: dict[str, Any]) -> dict[str, Any]:
    """Positions [px] of everything on the timeline: bands of states, lanes of marks, ticks of the axis."""
    entries, began = record["entries"], float(record["started"])
    last = max((float(e["t"]) for e in entries), default=began)
    ended = max(float(record["ended"]) if record["outcome"] else last, last)
    length = max(ended - began, 1.0)

    def x(seconds: float) -> float:
        return round(LEFT + (WIDTH - LEFT - RIGHT) * min(max(0.0, seconds), length) / length, 1)

    bands = []
    for state, start, end in spans(entries, began, ended):
        width = max(round(x(end) - x(start), 1), 1.0)
        label = state if width > LETTER * len(state) else ""
        title = f"{state} {start:.1f} to {end:.1f} s"
        colour = STATE_COLOURS.get(state, OTHER_STATE)
        bands.append({"x": x(start), "width": width, "colour": colour, "title": title, "label": label})
    lanes = [
        {
            "name": name,
            "colour": colour,
            "y": TOP + BAND + LANE * (n + 1),
            "marks": [{"x": x(e["t"] - began), "title": _title(e)} for e in entries if _lane(e) == name],
        }
        for n, (name, colour) in enumerate(LANES.items())
    ]
    step = next((s for s in STEPS if length / s <= MOST_TICKS), 1800)
    return {
        "width": WIDTH, "height": TOP + BAND + LANE * (len(LANES) + 1) + 14, "left": LEFT, "right": WIDTH - RIGHT,
        "top": TOP, "band": BAND, "band_text": TOP + BAND / 2 + 4, "bands": bands, "lanes": lanes,
        "ticks": [{"x": x(n * step), "label": f"{n * step:g} s"} for n in range(int(length / step) + 1)],
    }  # fmt: skip


def _lane(entry: dict[str, Any]) -> str:
    """The lane of an entry; "" for a note that is no speech."""
    if entry["kind"] == "note" and not entry["cause"].startswith(("asked", "said")):
        return ""
    return LANE_OF.get(entry["kind"], "")


def _title(entry: dict[str, Any]) -> str:
    words = " - ".join(w for w in (entry["cause"], entry["evidence"]) if w)
    return f"{entry['t']:.1f} s {words}"
