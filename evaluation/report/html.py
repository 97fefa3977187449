"""The report of an evaluation as one self-contained HTML file: `tidybot eval --html FILE`."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from common.html.environment import environment
from evaluation.case import Result
from evaluation.report.statistics import share, wilson
from evaluation.report.text import facts

BUSY = {"PLANNING", "GROUNDING", "NAVIGATING", "GRABBING", "RETURNING", "RELEASING"}
CARRIED = 0.3
"""Distance [m] in the hand from which an object counts as carried; chosen: more than a lift moves it."""
WIDTH = 640
"""Width of a chart [px]; chosen: readable, and no wider than the report's page."""
STAGES = ("understood", "at the object", "lifted", "carried", "delivered")
TEMPLATES = Path(__file__).parent / "templates"
AXIS_ENDS = (10, 20, 50, 100, 150, 200, 300, 400, 600, 1000, 2000)
"""Numbers [s] that the axis of times may end at."""


def render(report: dict[str, Any], results: Sequence[Result]) -> str:
    """The whole page of a report and its results; it loads nothing from anywhere else."""
    rows = sorted(results, key=lambda r: r.seed)
    longest = max((r.sim_seconds for r in rows), default=1.0)
    efficient = [(r.spl, r.met, _title(r)) for r in rows if r.evidence.get("expected") == "delivered"]
    causes = [
        (cause, share(number, len(rows)), [r.seed for r in rows if r.cause == cause])
        for cause, number in report["by_cause"].items()
    ]
    return (
        environment(TEMPLATES)
        .get_template("report.html")
        .render(
            title=f"tidybot eval {report['suite']}",
            report=report,
            facts={
                **facts(report),
                "bar": f"{100 * report['bar']:.0f} % as expected: {'met' if report['passed'] else 'not met'}",
            },
            stages=bars([*by_stage(rows), ("as expected", sum(r.met for r in rows), len(rows))]),
            seconds=strip([(r.sim_seconds, r.met, _title(r)) for r in rows], "s", _axis_end(longest)),
            efficiency=strip(efficient, "", 1.0),
            causes=causes,
            failures=[_failure(r) for r in rows if not r.met],
            results=rows,
        )
    )


def _failure(result: Result) -> dict[str, Any]:
    """What the gallery shows of a case that went wrong; evidence that is absent or of another form is left out."""
    evidence = result.evidence
    said, log = evidence.get("said"), evidence.get("timeline")
    return {
        "seed": result.seed, "name": result.name, "command": result.command, "outcome": result.outcome,
        "cause": result.cause,
        "evidence": {
            "picture": evidence.get("picture"), "reason": evidence.get("reason", ""),
            "said": said if isinstance(said, list) else [], "timeline": log if isinstance(log, list) else [],
        },
    }  # fmt: skip


def _title(result: Result) -> str:
    return f"seed {result.seed} {result.command}: {result.outcome}, {result.sim_seconds:.0f} s, SPL {result.spl:.2f}"


def _axis_end(largest: float) -> float:
    return next((s for s in AXIS_ENDS if s >= largest), largest)


# --- how far each case came: counts by stage, and where the charts of the report have their bars and dots. Pure
def reached(result: Result) -> dict[str, bool]:
    """The stages that a case has reached, by physics where physics can tell."""
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


def bars(rows: Sequence[tuple[str, int, int]]) -> dict[str, Any]:
    """Where the chart of (name, successes, cases) has its bars [px], with 95 % intervals from `low` to `high`."""
    margin, line = 150, 34
    span = WIDTH - 2 * margin
    drawn = []
    for n, (name, good, count) in enumerate(rows):
        low, high = wilson(good, count)
        y = n * line + 6
        drawn.append(
            {
                "name": name, "y": y, "middle": y + 11, "width": round(span * good / count, 1) if count else 0.0,
                "low": round(margin + span * low, 1), "high": round(margin + span * high, 1),
                "share": share(good, count),
            }
        )  # fmt: skip
    return {"width": WIDTH, "height": len(rows) * line + 8, "left": margin, "span": span, "bars": drawn}


def strip(values: Sequence[tuple[float, bool, str]], unit: str, top: float) -> dict[str, Any]:
    """Where the dots of (value, good, title) are [px] on an axis from 0 to `top`, stacked where they would overlap."""
    margin, dot, ticks = 30, 9, 5
    span, heights = WIDTH - 2 * margin, dict[int, int]()
    places = []
    for value, good, title in sorted(values, key=lambda v: v[0]):
        x = margin + span * min(max(value / top, 0.0), 1.0)
        level = heights[round(x / dot)] = heights.get(round(x / dot), -1) + 1
        places.append((x, level, good, title))
    height = 26 + dot * (1 + max(heights.values(), default=0))
    return {
        "width": WIDTH, "height": height, "left": margin, "right": WIDTH - margin, "label": unit or "share",
        "ticks": [
            {"x": round(margin + span * n / ticks), "label": f"{top * n / ticks:.3g} {unit}"} for n in range(ticks + 1)
        ],
        "dots": [
            {"x": round(x, 1), "y": height - 24 - dot * level, "good": good, "title": title}
            for x, level, good, title in places
        ],
    }  # fmt: skip


def _list(value: Any) -> list[Any]:
    return value if isinstance(value, list) else []
