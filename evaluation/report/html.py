"""The report of an evaluation as one self-contained HTML file: `tidybot eval --html FILE`."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from common.html.environment import environment
from evaluation.case import Result
from evaluation.report.stages import bars, by_stage, strip
from evaluation.report.statistics import share
from evaluation.report.text import rates

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
            facts=_facts(report),
            stages=bars([*by_stage(rows), ("as expected", sum(r.met for r in rows), len(rows))]),
            seconds=strip([(r.sim_seconds, r.met, _title(r)) for r in rows], "s", _axis_end(longest)),
            efficiency=strip(efficient, "", 1.0),
            causes=causes,
            failures=[_failure(r) for r in rows if not r.met],
            results=rows,
        )
    )


def _facts(report: dict[str, Any]) -> dict[str, str]:
    wall = max(report["wall_seconds"], 0.1)
    return {
        **rates(report),
        "bar": f"{100 * report['bar']:.0f} % as expected: {'met' if report['passed'] else 'not met'}",
        "path efficiency (SPL)": f"{report['spl']:.2f}",
        "robot time": f"{report['sim_seconds']:.0f} s, {report['sim_seconds'] / wall:.1f} x real time",
        "wall time": f"{report['wall_seconds']:.0f} s",
    }


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
