"""Workers that die or hang cost one case; the report has the fields of the contract; help and mistakes."""

import contextlib
import sys
from collections.abc import Iterator
from io import StringIO
from pathlib import Path

import msgspec
import psutil
import pytest
from rich.console import Console

from cli.errors import CliError
from cli.main import main, parser
from evaluation import __main__ as evaluation_main
from evaluation.case import Observed, Result
from evaluation.report import text as report
from evaluation.suites.table import SUITES, WORLD_BAR
from evaluation.verdict import judge
from evaluation.workers import cluster, lane
from evaluation.workers.pool import Progressed, Repeated, evaluate
from judge.claims import Claim
from tests.unit.eval_case import case_of, pretend

pytestmark = pytest.mark.long

FIELDS = [
    "suite", "scenarios", "delivered", "false_success", "by_cause", "spl", "sim_seconds", "wall_seconds", "cases",
]  # fmt: skip


def test_a_worker_that_dies_costs_its_case_only_and_one_that_dies_once_a_repeat(tmp_path: Path) -> None:
    once = msgspec.structs.replace(case_of(3, "dies once"), command=str(tmp_path / "died"))
    said = list(evaluate([case_of(0), case_of(1, "dies"), case_of(2), once], 2, pretend))
    results = {r.seed: r for r in said if isinstance(r, Result)}
    assert sorted(results) == [0, 1, 2, 3]
    assert results[1].outcome == "crashed" and "status 7" in results[1].cause
    assert {results[n].outcome for n in (0, 2, 3)} == {"reported"}
    assert any(isinstance(p, Progressed) and p.state == "WAITING" for p in said)
    assert sorted((r.case.seed, "status 7" in r.why) for r in said if isinstance(r, Repeated)) == [(1, True), (3, True)]


def test_a_case_without_end_is_given_up() -> None:
    said = list(evaluate([case_of(0, "hangs"), case_of(1)], 1, pretend, limit=1.0))
    assert [r.outcome for r in said if isinstance(r, Result)] == ["crashed", "reported"]
    assert [(r.case.seed, r.why) for r in said if isinstance(r, Repeated)] == [(0, "no result within 1 s of wall time")]


def test_a_process_that_says_nothing_is_hung() -> None:
    said = list(evaluate([case_of(0, "hangs")], 1, pretend, silence=1.0))
    assert [r.cause for r in said if isinstance(r, Result)] == ["crash: no sign of life for 1 s, in each of 2 attempts"]


def test_a_run_that_is_left_ends_its_workers() -> None:
    run = evaluate([case_of(0, "hangs"), case_of(1, "hangs")], 2, pretend)
    assert isinstance(next(run), Progressed)
    run.close()
    children = [p for p in psutil.Process().children(recursive=True) if "evaluation.workers.lane" in p.cmdline()]
    assert not children


def test_a_worker_is_renewed_after_so_many_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lane, "CASES_OF_A_PROCESS", 2)
    said = list(evaluate([case_of(n, "pid") for n in range(3)], 1, pretend))
    first, second, third = (p.state for p in said if isinstance(p, Progressed) and p.t)
    assert first == second != third
    assert [r.outcome for r in said if isinstance(r, Result)] == ["reported"] * 3


def test_the_report_is_that_of_the_contract() -> None:
    results = [judge(case_of(n), Observed(claimed="failed", failed_at="GRABBING", code="MISSED", ended=True), 0.1)
               for n in (2, 1)]  # fmt: skip
    found = report.record("fetch", results, 3.0)
    assert [f for f in found if f in FIELDS] == FIELDS
    assert [list(c) for c in found["cases"]] == [
        ["seed", "command", "outcome", "false_claims", "evidence", "cause"]
    ] * 2
    assert [c["seed"] for c in found["cases"]] == [1, 2]
    assert found["by_cause"] == {"grasp: MISSED": 2}
    console = Console(record=True, width=120, file=StringIO())
    report.show(console, found, results)
    assert "grasp: MISSED" in console.export_text()


def false(seed: int) -> Result:
    """A case of two missions that both were claimed to have succeeded."""
    claims = [Claim(1.0, "speech", "Done.", f"m-{n}", "do", "mug: on floor") for n in range(2)]
    return judge(case_of(seed), Observed(claims=claims, ended=True), 0.1)


def test_false_claims_have_a_column_of_their_own_everywhere_and_every_rate_its_interval() -> None:
    results = [false(1), *(judge(case_of(n), Observed(claimed="failed", ended=True), 0.1) for n in (2, 3, 4))]
    found = report.record("faults", results, 3.0, bar=0.5)
    assert (found["false_success"], found["false_claims"]) == (1, 2)
    assert [c["false_claims"] for c in found["cases"]] == [2, 0, 0, 0]
    assert found["cases"][0]["evidence"]["claims"][1]["false"] == "mug: on floor"
    assert found["intervals"] == {
        "delivered": [0.0, 0.49], "false_success": [0.046, 0.699], "as_expected": [0.0, 0.49],
        "objects_delivered": [0.0, 1.0], "wrong_thing": [0.0, 0.49],
    }  # fmt: skip
    assert (found["as_expected"], found["bar"], found["passed"]) == (0, 0.5, False)
    console = Console(record=True, width=160, file=StringIO())
    report.show(console, found, results)
    text = console.export_text()
    for words in ("1 of 4 (5 to 70 %)", "0 of 4 (0 to 49 %)", "3 of 4 (30 to 95 %)", "false claims", "50 %", "not met"):
        assert words in text, words
    assert "false claims 2" in report.line(results[0]) and "false claims" not in report.line(results[1])


def test_every_suite_has_its_bar() -> None:
    assert all(0.5 < bar <= 1.0 for bar in (WORLD_BAR, *(suite.bar for suite in SUITES.values())))


@pytest.mark.parametrize(
    ("words", "outcomes", "status"),
    [
        ([], ["delivered"] * 20, 0),
        ([], ["delivered"] * 19 + ["failed"], 0),
        ([], ["delivered"] * 18 + ["failed"] * 2, 1),
        (["--at-least", "0.9"], ["delivered"] * 18 + ["failed"] * 2, 0),
        (["--at-least", "0"], ["failed"] * 20, 0),
        (["--at-least", "0"], ["delivered"] * 19 + ["false_success"], 1),
    ],
)
def test_the_exit_status_is_the_bar_of_the_suite(
    words: list[str], outcomes: list[str], status: int, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    def ended(*_: object, **__: object) -> Iterator[Result]:
        for n, outcome in enumerate(outcomes):
            lie = outcome == "false_success"
            yield Result(
                seed=n, command="do", outcome=outcome, evidence={}, cause="", met=outcome == "delivered",  # type: ignore
                false_claims=int(lie),
            )  # fmt: skip

    monkeypatch.setattr(evaluation_main, "_evaluate", ended)
    assert evaluation_main.main(["--suite", "fetch", "-n", "20", *words]) == status
    shown = capsys.readouterr().out
    bar = "95" if not words else str(round(100 * float(words[1])))
    assert f"bar: {bar} % as expected and no false claim: {'met' if not status else 'not met'}" in shown


def test_an_empty_run_is_no_division_by_zero() -> None:
    assert report.record("fetch", [], 0.0)["spl"] == 0.0


def test_help_has_examples(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        parser().parse_args(["eval", "--help"])
    assert "tidybot eval --suite seed" in capsys.readouterr().out


def test_a_mistyped_suite_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    assert evaluation_main.main(["--suite", "fetsh"]) == 1
    assert "fetch" in capsys.readouterr().err


def test_settings_that_no_case_can_use_end_the_run(capsys: pytest.CaptureFixture[str]) -> None:
    assert evaluation_main.main(["-n", "3", "--set", "sim.robot=ostrich"]) == 1
    assert capsys.readouterr().err == "tidybot: sim.robot: robot ostrich: expected tidybot or official\n"


def test_without_dask_the_line_that_installs_it_is_given(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(CliError, match=r"pip install 'tidybot-zenoh\[cluster\]'"):
        next(cluster.evaluate([case_of(0)], "local", 1, pretend))


def test_other_code_has_another_fingerprint(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ours = cluster.fingerprint()
    (tmp_path / "brain.toml").write_text("settle = 0.5\n")
    monkeypatch.setenv("TIDYBOT_CONFIG_DIR", str(tmp_path))
    cluster.fingerprint.cache_clear()
    theirs = cluster.fingerprint()
    cluster.fingerprint.cache_clear()
    assert {name for name in ours if ours[name] != theirs[name]} == {"tidybot"}


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["--cluster", "somewhere"], "expected tcp://HOST:PORT"),
        (["--voices", "."], "are for --suite spoken"),
        (["--suite", "spoken", "--snr", "loud"], "expected -20 to 80 dB"),
    ],
)
def test_options_that_make_no_sense(words: list[str], reason: str, capsys: pytest.CaptureFixture[str]) -> None:
    with contextlib.suppress(SystemExit):
        assert main(["eval", *words]) == 1
    assert reason in capsys.readouterr().err
