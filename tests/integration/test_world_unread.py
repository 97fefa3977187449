"""Who opens the world: a whole robot runs on a world and a household of its own, and every file it opens is noted."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from evaluation.site import eventually
from tests.integration.test_cli_up import Run
from tests.support import ROOT

HOOK = """
import os, sys
def _note(event, args):
    if event == "open" and isinstance(args[0], str) and args[0].endswith(".toml"):
        line = sys.orig_argv
        word = line[line.index("-m") + 1] if "-m" in line else "other"
        log = os.open(os.path.join(os.environ["NOTED"], word), os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)
        os.write(log, (args[0] + "\\n").encode())
        os.close(log)
sys.addaudithook(_note)
"""
"""Runs in every Python process before its program: notes the TOML files that it opens, and what its forks open."""
MUG = (
    'name = "blue mug", kind = "mug", colour = "blue", size = [0.07, 0.07, 0.09], mass = 0.2, rgba = [0.1, 0.2, 0.8, 1]'
)
SERVICES = ("brain", "planner", "perception", "navigation", "manipulation", "camera", "dashboard")


@pytest.fixture
def run(tmp_path: Path) -> Iterator[Run]:
    opened = Run(tmp_path / "run")
    hook, noted = tmp_path / "hook", tmp_path / "noted"
    hook.mkdir()
    noted.mkdir()
    (hook / "sitecustomize.py").write_text(HOOK)
    opened.environ |= {"PYTHONPATH": f"{hook}{os.pathsep}{ROOT}", "NOTED": str(noted)}
    (tmp_path / "mine.world.toml").write_text(f'name = "mine"\nplan = "apartment"\nobjects = [{{ {MUG} }}]\n')
    (tmp_path / "mine.household.toml").write_text('name = "mine"\nplan = "apartment"\n')
    try:
        yield opened
    finally:
        opened.close()


def opened_by(directory: Path) -> dict[str, set[str]]:
    """Program -> names of the TOML files that it has opened."""
    return {p.name: {Path(line).name for line in p.read_text().splitlines()} for p in directory.iterdir()}


@pytest.mark.slow
@pytest.mark.timeout(300)
@pytest.mark.parametrize("keys", [False, True], ids=["open", "certificates"])
def test_only_the_simulation_opens_the_world(run: Run, tmp_path: Path, keys: bool) -> None:
    world, household = tmp_path / "mine.world.toml", tmp_path / "mine.household.toml"
    words = ["--world", str(world), "--household", str(household), "--only", ",".join(("router", "sim", *SERVICES))]
    words += ["--set", "dashboard.port=0"]
    if keys:
        directory = tmp_path / "keys"
        assert run.command("keys", "--dir", str(directory)).returncode == 0
        words += ["--keys", str(directory)]
    done = run.detached(*words)
    assert done.returncode == 0, done.stdout + done.stderr
    rows = eventually(lambda: all(r["alive"] for r in run.rows().values()) and run.rows(), "all are alive")
    assert set(rows) == {"router", "sim", *SERVICES}
    seen = opened_by(tmp_path / "noted")
    assert world.name in seen["services.sim"], "the hook notes what is opened"
    for name in SERVICES:
        files = seen[f"services.{name}"]
        assert household.name in files and f"{name}.toml" in files, f"{name} opened {files}"
        assert world.name not in files and not any("scenes" in f for f in files), f"{name} opened {files}"
    assert run.command("down").returncode == 0
