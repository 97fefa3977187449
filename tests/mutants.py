"""Mutation testing of the pure modules: `python -m tests.mutants [-h] [NAME...]`, configured in tests/mutants.toml.

mutmut changes one thing at a time in a module and asks the module's own tests; what they do not notice survives. Each
module is run in a directory of its own below build/mutants; `.venv/bin/mutmut browse` there shows what was found.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tests.support import ROOT

CONFIGURATION = ROOT / "tests" / "mutants.toml"
WORK = ROOT / "build" / "mutants"
PACKAGES = ("common", "services", "cli", "judge", "evaluation")
BESIDES = ("bench", "config", "docs", "examples", "README.md", "docker-compose.yml")
"""What tests read beside the packages."""
PLUGINS = ("-p", "no:cacheprovider", "-p", "no:xdist", "-p", "no:playwright", "-m", "not slow")
"""Arguments of pytest."""
SURVIVED = (0, 33)
"""mutmut's codes for a mutant that every test passes and for one that no test reaches."""


@dataclass
class Found:
    """The outcome of one module; `survivors` maps a mutant's name to what it takes out and puts in."""

    name: str
    mutants: int = 0
    survivors: dict[str, str] = field(default_factory=dict)
    argued: int = 0
    unargued: list[str] = field(default_factory=list)
    stale: list[str] = field(default_factory=list)

    @property
    def killed(self) -> int:
        return self.mutants - len(self.survivors)


def mutmut(*words: str, cwd: Path) -> "subprocess.CompletedProcess[str]":
    """Run mutmut; its output is kept.

    Raises:
        RuntimeError: it ended with an error, which is told.
    """
    line = [sys.executable, "-c", "from mutmut.__main__ import cli; cli()", *words]
    environ = {**os.environ, "OMP_NUM_THREADS": "1", "PYTHONPATH": "."}
    done = subprocess.run(line, cwd=cwd, env=environ, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"mutmut {words[0]} in {cwd}:\n{done.stdout[-3000:]}{done.stderr[-2000:]}")
    return done


def prepare(name: str, module: dict[str, Any], keep: bool) -> Path:
    """The module's directory: links to the sources and a configuration for mutmut."""
    place = WORK / name
    if not keep:
        # mutmut does not ask changed tests again.
        shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True, exist_ok=True)
    for entry in (*PACKAGES, *BESIDES, "tests"):
        link = place / entry
        if not link.exists():
            link.symlink_to(ROOT / entry)
    options = {
        "source_paths": [*PACKAGES],
        "only_mutate": [module["path"]],
        "also_copy": [*BESIDES],
        "pytest_add_cli_args": [*PLUGINS],
        "pytest_add_cli_args_test_selection": module["tests"],
        "use_git_change_detection": False,
    }
    lines = [f"{key} = {json.dumps(value)}" for key, value in options.items()]
    project = (ROOT / "pyproject.toml").read_text()
    (place / "pyproject.toml").write_text(project + "\n[tool.mutmut]\n" + "\n".join(lines) + "\n")
    return place


def changed(place: Path, mutant: str) -> str:
    """What a mutant takes out and puts in, as `- old` and `+ new` lines without indentation."""
    shown = mutmut("show", mutant, cwd=place).stdout.splitlines()
    lines = [line for line in shown if line[:1] in "+-" and line[:3] not in ("---", "+++")]
    return "\n".join(f"{line[0]} {line[1:].strip()}" for line in lines)


def examine(name: str, module: dict[str, Any], keep: bool, children: int) -> Found:
    """Run the mutants of one module."""
    place = prepare(name, module, keep)
    mutmut("run", "--max-children", str(children), cwd=place)
    codes = json.loads((place / "mutants" / f"{module['path']}.meta").read_text())["exit_code_by_key"]
    found = Found(name, len(codes))
    for mutant, code in codes.items():
        if code in SURVIVED:
            found.survivors[mutant] = changed(place, mutant)
    arguments = [one.strip() for one in module.get("argued", [])]
    for mutant, change in found.survivors.items():
        if change in arguments:
            found.argued += 1
        else:
            found.unargued.append(mutant)
    found.stale = [one for one in arguments if one not in found.survivors.values()]
    return found


def table(rows: Iterable[Found]) -> str:
    """module / mutants / killed / survivors / %."""
    rows = list(rows)
    total = Found("all", sum(r.mutants for r in rows))
    lines = [f"{'module':12} {'mutants':>8} {'killed':>8} {'survivors':>10} {'argued':>7} {'%':>6}"]
    left = sum(len(r.survivors) for r in rows)
    cells = [(r.name, r.mutants, r.killed, len(r.survivors), r.argued) for r in rows]
    cells.append(("all", total.mutants, total.mutants - left, left, sum(r.argued for r in rows)))
    for label, mutants, killed, survivors, argued in cells:
        share = 100 * killed / mutants if mutants else 0.0
        lines.append(f"{label:12} {mutants:8} {killed:8} {survivors:10} {argued:7} {share:6.1f}")
    return "\n".join(lines)


def main() -> int:
    """Run what is asked for; 1 when a strict module has an unargued survivor or too few were killed."""
    settings = tomllib.loads(CONFIGURATION.read_text())
    least = settings.pop("least")
    parser = argparse.ArgumentParser(prog="python -m tests.mutants", description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"modules (default: all): {', '.join(settings)}")
    parser.add_argument("--keep", action="store_true", help="go on where a run with the same tests was interrupted")
    parser.add_argument("--survivors", action="store_true", help="show every survivor, also of modules not strict")
    parser.add_argument("--children", type=int, default=os.cpu_count() or 1, help="mutants at a time (default: cores)")
    options = parser.parse_args()
    if unknown := set(options.names) - set(settings):
        parser.error(f"no module {', '.join(sorted(unknown))}; known: {', '.join(settings)}")
    rows = []
    failed = False
    for name in options.names or settings:
        module = settings[name]
        print(f"{name}: {module['path']}", flush=True)
        found = examine(name, module, options.keep, options.children)
        rows.append(found)
        strict = module.get("strict", False)
        failed |= strict and bool(found.unargued)
        for mutant in found.unargued if strict or options.survivors else ():
            print(f"survived: {mutant}\n{found.survivors[mutant]}", flush=True)
        for one in found.stale:
            print(f"argued, but no survivor any more:\n{one}", flush=True)
    print(table(rows))
    mutants = sum(r.mutants for r in rows)
    return int(failed or sum(r.killed for r in rows) * 100 < least * mutants)


if __name__ == "__main__":
    sys.exit(main())
