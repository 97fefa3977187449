"""What `tidybot eval` prints and writes."""

from collections import Counter
from collections.abc import Sequence
from typing import Any

from rich.console import Console
from rich.table import Table

from evaluation.case import Result
from evaluation.matrix import chaos_tables

STYLES = {
    "delivered": "green", "declined": "green", "stopped": "green", "reported": "yellow", "false_success": "bold red",
}  # fmt: skip


def record(suite: str, results: Sequence[Result], wall_seconds: float) -> dict[str, Any]:
    """The report as `--json` writes it; cases by seed."""
    rows = sorted(results, key=lambda r: r.seed)
    return {
        "suite": suite,
        "scenarios": len(rows),
        "delivered": sum(r.delivered for r in rows),
        "false_success": sum(r.outcome == "false_success" for r in rows),
        "by_cause": dict(Counter(r.cause for r in rows if r.cause).most_common()),
        "spl": round(sum(r.spl for r in rows) / len(rows), 3) if rows else 0.0,
        "sim_seconds": round(sum(r.sim_seconds for r in rows), 1),
        "wall_seconds": round(wall_seconds, 1),
        "cases": [
            {"seed": r.seed, "command": r.command, "outcome": r.outcome, "evidence": _words(r), "cause": r.cause}
            for r in rows
        ],
    }


def _words(result: Result) -> dict[str, object]:
    """The evidence without the picture, which is for the eye."""
    return {k: v for k, v in result.evidence.items() if k != "picture"}


def line(result: Result) -> str:
    """One case as one line of rich markup."""
    style = STYLES.get(result.outcome, "red")
    why = f"  {result.cause}" if result.cause else ""
    reason = str(result.evidence.get("reason", "")) if not result.met else ""
    return (
        f"[dim]{result.seed:>5}[/] {result.name:16} {result.command:34} [{style}]{result.outcome:13}[/] "
        f"{result.sim_seconds:7.1f} s  spl {result.spl:.2f}{why}  [dim]{reason}[/]"
    )


def show(console: Console, report: dict[str, Any], results: Sequence[Result]) -> None:
    """The summary, and the failure causes by stage."""
    count = report["scenarios"]
    things = [t for r in results for t in _things(r)]
    table = Table(title=f"suite {report['suite']}, {count} scenarios", title_justify="left", show_header=False)
    table.add_row("delivered, by physics", _share(report["delivered"], count))
    if len(things) > count:
        table.add_row("objects where they belong", _share(sum(bool(t["delivered"]) for t in things), len(things)))
    table.add_row("as expected of the scenario", _share(sum(r.met for r in results), count))
    table.add_row("false success claims", str(report["false_success"]))
    table.add_row("path efficiency (SPL)", f"{report['spl']:.2f}")
    wall = max(report["wall_seconds"], 0.1)
    table.add_row("robot time", f"{report['sim_seconds']:.0f} s, {report['sim_seconds'] / wall:.1f} x real time")
    table.add_row("wall time", f"{report['wall_seconds']:.0f} s")
    console.print(table)
    if report["by_cause"]:
        causes = Table(title="failures by stage", title_justify="left", show_header=False)
        for name, number in report["by_cause"].items():
            seeds = " ".join(str(r.seed) for r in results if r.cause == name)
            causes.add_row(name, str(number), f"seeds {seeds}")
        console.print(causes)
    if report["suite"] == "faults":
        console.print(by_fault(results))
    if report["suite"] == "chaos":
        console.print(chaos_tables(results))


def by_fault(results: Sequence[Result]) -> Table:
    """Rows of fault kinds: recovered, honestly reported, lost, and the mean time."""
    table = Table("fault", "cases", "recovered", "reported", "lost", "robot s", title="by fault", title_justify="left")
    for fault in sorted({str(r.evidence.get("fault", "")) for r in results}):
        rows = [r for r in results if r.evidence.get("fault") == fault]
        good, told = sum(r.delivered for r in rows), sum(r.outcome == "reported" for r in rows)
        mean = sum(r.sim_seconds for r in rows) / len(rows)
        table.add_row(fault, *(str(n) for n in (len(rows), good, told, len(rows) - good - told)), f"{mean:.0f}")
    return table


def _things(result: Result) -> list[dict[str, Any]]:
    found = result.evidence.get("things", [])
    return found if isinstance(found, list) else []


def _share(part: int, whole: int) -> str:
    return f"{part} of {whole} ({100 * part / whole:.0f} %)" if whole else "0 of 0"
