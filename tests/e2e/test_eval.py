"""`tidybot eval` as a user runs it: spoken and typed scenarios, faults, Ctrl-C, and the same seed as processes."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import msgspec
import psutil
import pytest

from common.scene import load_scene
from evaluation import runner
from evaluation.case import Case, Line, Result
from evaluation.chaos import CELLS, CHAOS_SERVICES, EVERY, Cell
from evaluation.evidence import Want
from evaluation.faults import Rule
from evaluation.suites import cases
from tests.support import ROOT, eventually

pytestmark = pytest.mark.timeout(600)
FETCH = ("brain.pipeline=fetch",)
ENVIRON = {k: v for k, v in os.environ.items() if not k.startswith("TIDYBOT")}


def case_of(seed: int, thing: str, **more: object) -> Case:
    """A fetch in the small flat, typed."""
    command = f"bring me the {thing}"
    fields = {
        "suite": "fetch", "seed": seed, "name": "fetch", "command": command, "lines": (Line(command),),
        "thing": thing, "wants": (Want(thing, ("delivery tray",)),), "settings": FETCH,
        "scene": load_scene("minimal"), **more,
    }  # fmt: skip
    return Case(**fields)  # type: ignore[arg-type]


def untimed(result: Result) -> dict[str, object]:
    return {k: v for k, v in result.evidence.items() if k != "wall_seconds"}


def test_a_seed_repeats_with_all_its_evidence() -> None:
    """To the last digit; the first seconds of a mission are enough to differ in."""
    first, second = (runner.run(case_of(2, "green can", limit=20.0)) for _ in range(2))
    assert first.outcome == "timeout"
    assert float(str(first.evidence["driven"])) > 0.5
    assert untimed(first) == untimed(second)


def test_a_gripper_that_does_not_close_is_noticed_and_tried_again() -> None:
    rule = Rule(service="manipulation", key="gripper_command", kind="drop", match={"position": 1.0})
    result = runner.run(case_of(2, "yellow block", rules=(rule,)))
    assert result.delivered, result.evidence
    assert result.evidence["things"][0]["carried"] > 0.5  # type: ignore[index]
    always = msgspec.structs.replace(rule, count=1000)
    lame = runner.run(case_of(2, "yellow block", rules=(always,)))
    assert (lame.outcome, lame.evidence["claimed"]) == ("reported", "failed")
    assert lame.cause.startswith("grasp")


@pytest.mark.parametrize("skip", [0, 1])
def test_a_service_that_raises_ends_its_case_as_crashed(skip: int) -> None:
    """At its start, or with its first status."""
    rule = Rule(
        service="navigation", key="brain/navigation_status", kind="edit", skip=skip, fields={"status": "flying"}
    )  # fmt: skip
    result = runner.run(case_of(2, "green can", rules=(rule,)))
    assert result.outcome == "crashed"
    assert "status" in result.cause


def harmed(seed: int) -> Result:
    return runner.run(cases("chaos", 1, seed)[0])


def check(result: Result) -> None:
    """Recovered or honestly reported; nothing dropped, no success claimed that is none."""
    evidence = result.evidence
    things = evidence["things"]
    assert result.outcome in ("delivered", "reported"), (result.cause, evidence)
    assert isinstance(things, list) and not any(t["drops"] for t in things), evidence
    assert result.outcome == "delivered" or evidence["reason"], evidence


def test_a_brain_killed_in_every_state_of_one_mission_delivers() -> None:
    result = harmed(CELLS.index(Cell("brain", EVERY, "kill")))
    check(result)
    assert result.delivered and isinstance(result.evidence["recovery"], float)


@pytest.mark.slow
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("service", [s for s in CHAOS_SERVICES if s != "brain"])
def test_each_service_killed_in_every_state_of_one_mission(service: str) -> None:
    check(harmed(CELLS.index(Cell(service, EVERY, "kill"))))


@pytest.mark.slow
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("seed", range(3, len(CELLS), 10))
def test_a_tenth_of_the_matrix(seed: int) -> None:
    check(harmed(seed))


def command(*words: str) -> list[str]:
    return [sys.executable, "-m", "cli.main", "eval", *words]


@pytest.mark.slow
@pytest.mark.timeout(1800)
@pytest.mark.parametrize(
    "suite",
    [
        ["--suite", "fetch", "--seed", "1", "--pipeline", "fetch"],
        ["--suite", "seed", "--seed", "0"],
        ["--suite", "seed", "--seed", "1"],
    ],
)
def test_in_one_process_and_as_processes_a_seed_ends_the_same(suite: list[str], tmp_path: Path) -> None:
    reports = []
    for n, mode in enumerate(([], ["--processes"])):
        out = tmp_path / f"{n}.json"
        words = command("-n", "1", *suite, "--json", str(out), *mode)
        assert subprocess.run(words, cwd=ROOT, env=ENVIRON, capture_output=True).returncode == 0
        reports.append(json.loads(out.read_text()))
    cases = [r["cases"][0] for r in reports]
    assert cases[0]["outcome"] == cases[1]["outcome"] == "delivered"
    assert cases[0]["evidence"]["states"] == cases[1]["evidence"]["states"]
    assert cases[0]["evidence"]["spl"] == pytest.approx(cases[1]["evidence"]["spl"], abs=0.02)


def is_tracker(process: psutil.Process) -> bool:
    """Python's own watcher of shared resources: it ends when it notices that its parent has."""
    try:
        return "resource_tracker" in " ".join(process.cmdline())
    except psutil.Error:
        return False


def test_ctrl_c_keeps_what_is_done_and_leaves_nothing_behind(tmp_path: Path) -> None:
    out = tmp_path / "report.json"
    words = command("-n", "50", "--jobs", "2", "--pipeline", "fetch", "--json", str(out))
    process = subprocess.Popen(
        words, cwd=ROOT, env=ENVIRON, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True
    )
    family = psutil.Process(process.pid)
    try:
        eventually(lambda: len(family.children(recursive=True)) >= 2, "the workers run", patience=240)
        children = family.children(recursive=True)
        trackers = [c for c in children if is_tracker(c)]
        os.killpg(process.pid, signal.SIGINT)
        text = process.communicate(timeout=120)[0].decode()
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
    assert process.returncode == 130, text
    assert "interrupted" in text
    assert json.loads(out.read_text())["suite"] == "fetch"
    assert not [c for c in children if c not in trackers and c.is_running() and c.status() != "zombie"]
    assert not psutil.wait_procs(trackers, timeout=20)[1]
