"""Outcomes of the chaos suite, by service, state and fault: recovered, reported or lost, and in what time."""

from collections.abc import Sequence
from typing import Any

import msgspec
from rich.console import Group
from rich.table import Table

from evaluation.case import Result
from evaluation.report.statistics import percent


class Tally(msgspec.Struct):
    """Counts of cases by outcome; `missed`: the fault never took effect; `lies`: false claims.

    `seconds` of robot time to the mission's next step.
    """

    recovered: int = 0
    reported: int = 0
    lost: int = 0
    missed: int = 0
    dropped: int = 0
    lies: int = 0
    seconds: list[float] = []

    @property
    def hit(self) -> int:
        return self.recovered + self.reported + self.lost


def tally(results: Sequence[Result]) -> Tally:
    """Recovered is a delivery that physics confirms, reported an honest ERROR; everything else is lost."""
    found = Tally()
    for r in results:
        evidence = r.evidence
        things = evidence.get("things", [])
        fell = any(t["drops"] for t in things) if isinstance(things, list) else False
        found.dropped += fell
        found.lies += r.false_claims
        if r.outcome == "not struck":
            found.missed += 1
            continue
        if isinstance(seconds := evidence.get("recovery"), float) and r.delivered:
            found.seconds.append(seconds)
        found.recovered += r.delivered
        found.reported += r.outcome == "reported"
        found.lost += not r.delivered and r.outcome != "reported"
    return found


def chaos_tables(results: Sequence[Result]) -> Group:
    """One table a fault, services by states, and one of all faults."""
    faults = dict.fromkeys(map(_fault, results))
    head = "recovered / honest error / lost, and seconds of robot time from the fault to the mission's next step"
    return Group(head, *(_by_state(f, [r for r in results if _fault(r) == f]) for f in faults), all_faults(results))


def _fault(result: Result) -> str:
    return str(result.evidence.get("fault", ""))


def _by_state(fault: str, results: Sequence[Result]) -> Table:
    cells: dict[tuple[str, str], list[Result]] = {}
    for result in sorted(results, key=lambda r: r.seed):
        service, _, state = result.name.partition(" ")
        cells.setdefault((service, state), []).append(result)
    states = list(dict.fromkeys(state for _, state in cells))
    table = Table("service", *states, title=fault, title_justify="left")
    for service in dict.fromkeys(service for service, _ in cells):
        table.add_row(service, *(cell(cells.get((service, state), [])) for state in states))
    return table


def cell(results: Sequence[Result]) -> str:
    """`1/0/0 3.2 s`; empty where nothing ran, `not struck` where the fault never took effect."""
    if not results:
        return ""
    found = tally(results)
    if not found.hit:
        return "[dim]not struck[/]"
    style = "red" if found.lost or found.lies or found.dropped else "yellow" if found.reported else "green"
    took = f" {max(found.seconds):.1f} s" if found.seconds else ""
    return f"[{style}]{found.recovered}/{found.reported}/{found.lost}[/]{took}"


def all_faults(results: Sequence[Result]) -> Table:
    """One row for each kind of fault: its outcomes with 95 % intervals."""
    heads = ("fault", "hit", "recovered", "honest error", "lost", "not struck", "dropped", "false claims")
    table = Table(*heads, "mean s", "max s", title="all faults", title_justify="left")
    for fault in [*dict.fromkeys(map(_fault, results)), "all"]:
        found = tally([r for r in results if fault in ("all", _fault(r))])
        table.add_row(fault, *_numbers(found))
    return table


def _numbers(found: Tally) -> tuple[str, ...]:
    times: list[Any] = found.seconds
    shares = (f"{n} ({percent(n, found.hit)})" for n in (found.recovered, found.reported, found.lost))
    mean = f"{sum(times) / len(times):.1f}" if times else ""
    rest = (str(n) for n in (found.missed, found.dropped, found.lies))
    return (str(found.hit), *shares, *rest, mean, f"{max(times):.1f}" if times else "")
