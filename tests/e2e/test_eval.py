"""`tidybot eval` as a user runs it: Ctrl-C, and the same seed in one process and as processes."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import psutil
import pytest

from evaluation.site import eventually
from tests.support import ROOT

pytestmark = pytest.mark.timeout(600)
ENVIRON = {k: v for k, v in os.environ.items() if not k.startswith("TIDYBOT")}


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


@pytest.mark.slow
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
