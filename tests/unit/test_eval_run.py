"""Workers that die or hang cost one case; the report has the fields of the contract; help and mistakes."""

import os
from collections.abc import Callable
from io import StringIO
from pathlib import Path

import msgspec
import psutil
import pytest
from rich.console import Console

from cli.main import main, parser
from evaluation import lane, report
from evaluation.case import Case, Line, Observed, Result
from evaluation.pool import Progressed, Repeated, evaluate
from evaluation.verdict import judge

FIELDS = [
    "suite", "scenarios", "delivered", "false_success", "by_cause", "spl", "sim_seconds", "wall_seconds", "cases",
]  # fmt: skip


def case_of(seed: int, name: str = "fine") -> Case:
    return Case(suite="fetch", seed=seed, name=name, command=f"do {name}", lines=(Line("do"),))


def pretend(case: Case, progress: Callable[[float, str], None]) -> Result:
    """A case without a robot."""
    progress(1.0, str(os.getpid()) if case.name == "pid" else "WAITING")
    marker = Path(case.command)
    if case.name == "dies" or (case.name == "dies once" and not marker.exists()):
        if case.name == "dies once":
            marker.touch()
        os._exit(7)
    while case.name == "hangs":
        pass
    return judge(case, Observed(claimed="failed", reason="(GRABBING: MISSED: air)", ended=True), 0.1)


def test_a_worker_that_dies_costs_its_case_only() -> None:
    todo = [case_of(0), case_of(1, "dies"), case_of(2), case_of(3)]
    said = list(evaluate(todo, 2, pretend))
    results = {r.seed: r for r in said if isinstance(r, Result)}
    assert sorted(results) == [0, 1, 2, 3]
    assert results[1].outcome == "crashed" and "status 7" in results[1].cause
    assert {results[n].outcome for n in (0, 2, 3)} == {"reported"}
    assert any(isinstance(p, Progressed) and p.state == "WAITING" for p in said)


def test_a_case_without_end_is_given_up() -> None:
    said = list(evaluate([case_of(0, "hangs"), case_of(1)], 1, pretend, limit=3.0))
    assert [r.outcome for r in said if isinstance(r, Result)] == ["crashed", "reported"]
    assert [(r.case.seed, r.why) for r in said if isinstance(r, Repeated)] == [(0, "no result within 3 s of wall time")]


def test_a_process_that_says_nothing_is_hung() -> None:
    said = list(evaluate([case_of(0, "hangs")], 1, pretend, silence=2.0))
    assert [r.cause for r in said if isinstance(r, Result)] == ["crash: no sign of life for 2 s, in each of 2 attempts"]


def test_a_worker_that_dies_once_costs_a_repeat(tmp_path: Path) -> None:
    case = msgspec.structs.replace(case_of(0, "dies once"), command=str(tmp_path / "died"))
    said = list(evaluate([case], 1, pretend))
    assert [r.outcome for r in said if isinstance(r, Result)] == ["reported"]
    assert ["status 7" in r.why for r in said if isinstance(r, Repeated)] == [True]


def test_a_run_that_is_left_ends_its_workers() -> None:
    run = evaluate([case_of(0, "hangs"), case_of(1, "hangs")], 2, pretend)
    assert isinstance(next(run), Progressed)
    run.close()
    children = [p for p in psutil.Process().children(recursive=True) if "evaluation.lane" in p.cmdline()]
    assert not children


def test_a_worker_is_renewed_after_so_many_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lane, "CASES_OF_A_PROCESS", 2)
    said = list(evaluate([case_of(n, "pid") for n in range(3)], 1, pretend))
    first, second, third = (p.state for p in said if isinstance(p, Progressed) and p.t)
    assert first == second != third
    assert [r.outcome for r in said if isinstance(r, Result)] == ["reported"] * 3


def test_the_report_is_that_of_the_contract() -> None:
    results = [judge(case_of(n), Observed(claimed="failed", reason="(GRABBING: MISSED: air)", ended=True), 0.1)
               for n in (2, 1)]  # fmt: skip
    found = report.record("fetch", results, 3.0)
    assert list(found) == FIELDS
    assert [list(c) for c in found["cases"]] == [["seed", "command", "outcome", "evidence", "cause"]] * 2
    assert [c["seed"] for c in found["cases"]] == [1, 2]
    assert found["by_cause"] == {"grasp: MISSED": 2}
    console = Console(record=True, width=120, file=StringIO())
    report.show(console, found, results)
    assert "grasp: MISSED" in console.export_text()


def test_an_empty_run_is_no_division_by_zero() -> None:
    assert report.record("fetch", [], 0.0)["spl"] == 0.0


def test_help_has_examples(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        parser().parse_args(["eval", "--help"])
    assert "tidybot eval --suite seed" in capsys.readouterr().out


def test_a_mistyped_suite_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["eval", "--suite", "fetsh"]) == 1
    assert "fetch" in capsys.readouterr().err
