"""What `tidybot eval` prints and writes."""

from collections import Counter
from collections.abc import Sequence
from typing import Any

from rich.console import Console
from rich.table import Table

from evaluation.case import Result
from evaluation.report.matrix import all_faults, chaos_tables
from evaluation.report.statistics import interval, share

STYLES = {
    "delivered": "green", "declined": "green", "stopped": "green", "reported": "yellow", "false_success": "bold red",
}  # fmt: skip


def record(suite: str, results: Sequence[Result], wall_seconds: float, bar: float = 1.0) -> dict[str, Any]:
    """The report as `--json` writes it; cases by seed.

    `false_success` counts cases with a false claim, `false_claims` the claims, `wrong_thing` cases
    in which something that nobody asked for was in the hand. `intervals`: 95 % Wilson intervals of
    the shares of cases. `bar`: the share of cases that must end as expected; `passed`: they did, without a false claim.
    """
    rows = sorted(results, key=lambda r: r.seed)
    things = [bool(t["delivered"]) for r in rows for t in _things(r)]
    counts = {
        "delivered": sum(r.delivered for r in rows),
        "false_success": sum(r.false_claims > 0 for r in rows),
        "as_expected": sum(r.met for r in rows),
        "wrong_thing": sum(bool(r.evidence.get("wrong")) for r in rows),
    }
    intervals = {name: interval(number, len(rows)) for name, number in counts.items()}
    false = sum(r.false_claims for r in rows)
    return {
        "suite": suite,
        "scenarios": len(rows),
        **counts,
        "false_claims": false,
        "objects": len(things),
        "objects_delivered": sum(things),
        "intervals": {**intervals, "objects_delivered": interval(sum(things), len(things))},
        "bar": bar,
        "passed": passed(counts["as_expected"], len(rows), false, bar),
        "by_cause": dict(Counter(r.cause for r in rows if r.cause).most_common()),
        "spl": round(sum(r.spl for r in rows) / len(rows), 3) if rows else 0.0,
        "sim_seconds": round(sum(r.sim_seconds for r in rows), 1),
        "wall_seconds": round(wall_seconds, 1),
        "cases": [
            {
                "seed": r.seed, "command": r.command, "outcome": r.outcome, "false_claims": r.false_claims,
                "evidence": _words(r), "cause": r.cause,
            }
            for r in rows
        ],
    }  # fmt: skip


def passed(met: int, count: int, false_claims: int, bar: float) -> bool:
    """No false claim, and at least the share `bar` of the cases ended as expected; not so where none has ended."""
    # Shares such as 0.95 have no exact binary form: 19 of 20 are enough for it.
    return bool(count) and not false_claims and met >= bar * count - 1e-9


def _words(result: Result) -> dict[str, object]:
    """The evidence without the picture, which is for the eye."""
    return {k: v for k, v in result.evidence.items() if k != "picture"}


def line(result: Result) -> str:
    """One case as one line of rich markup."""
    style = STYLES.get(result.outcome, "red")
    why = f"  {result.cause}" if result.cause else ""
    false = f"  [bold red]false claims {result.false_claims}[/]" if result.false_claims else ""
    reason = str(result.evidence.get("reason", "")) if not result.met else ""
    return (
        f"[dim]{result.seed:>5}[/] {result.name:16} {result.command:34} [{style}]{result.outcome:13}[/] "
        f"{result.sim_seconds:7.1f} s  spl {result.spl:.2f}{false}{why}  [dim]{reason}[/]"
    )


def show(console: Console, report: dict[str, Any], results: Sequence[Result]) -> None:
    """The summary, the failure causes by stage, and whether the suite's bar is met."""
    count = report["scenarios"]
    table = Table(title=f"suite {report['suite']}, {count} scenarios", title_justify="left", show_header=False)
    for name, text in facts(report).items():
        table.add_row(name, text)
    console.print(table)
    if report["by_cause"]:
        causes = Table(title="failures by stage", title_justify="left", show_header=False)
        for name, number in report["by_cause"].items():
            seeds = " ".join(str(r.seed) for r in results if r.cause == name)
            causes.add_row(name, share(number, count), f"seeds {seeds}")
        console.print(causes)
    if report["suite"] == "faults":
        console.print(all_faults(results))
    if report["suite"] == "chaos":
        console.print(chaos_tables(results))
    verdict = "[green]met[/]" if report["passed"] else "[bold red]not met[/]"
    console.print(f"bar: {100 * report['bar']:.0f} % as expected and no false claim: {verdict}", highlight=False)


def facts(report: dict[str, Any]) -> dict[str, str]:
    """A report in words, every rate with its 95 % interval, as terminal and HTML show it."""
    count, wall = report["scenarios"], max(report["wall_seconds"], 0.1)
    found = {"delivered, by physics": share(report["delivered"], count)}
    if report["objects"] > count:
        found["objects where they belong"] = share(report["objects_delivered"], report["objects"])
    found["as expected of the scenario"] = share(report["as_expected"], count)
    found["scenarios with a wrong thing in the hand"] = share(report["wrong_thing"], count)
    found["scenarios with a false claim"] = share(report["false_success"], count)
    found["false claims"] = str(report["false_claims"])
    found["path efficiency (SPL)"] = f"{report['spl']:.2f}"
    found["robot time"] = f"{report['sim_seconds']:.0f} s, {report['sim_seconds'] / wall:.1f} x real time"
    found["wall time"] = f"{report['wall_seconds']:.0f} s"
    return found


def _things(result: Result) -> list[dict[str, Any]]:
    found = result.evidence.get("things", [])
    return found if isinstance(found, list) else []
