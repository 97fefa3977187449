"""A service as a fork of supervisord behaves like one with an interpreter of its own."""

import subprocess
import sys
from pathlib import Path

import pytest

from cli.processes import forked
from tests.support import ROOT

PARENT = """
import os, signal, sys, threading
from cli.processes import forked
forked.load()
# Room for the names of what it becomes, as supervisord's own command line has.
signal.signal(signal.SIGTERM, lambda number, frame: None)
sys.stdout.flush()
child = os.fork()
if child == 0:
    forked.become([sys.executable, "-m", "child", "--word"], {"PATH": os.environ["PATH"], "GIVEN": "1"})
print("status", os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""
CASES = {
    "import sys; sys.exit(3)": ("status 3", ""),
    "import sys; sys.exit('no')": ("status 1", "no"),
    "raise ValueError('broken')": ("status 1", "ValueError: broken"),
    "import sys; print(__name__, sys.argv[1:])": ("__main__ ['--word']\nstatus 0", ""),
    "import os; print(sorted(os.environ))": ("['GIVEN', 'PATH']\nstatus 0", ""),
    "import signal; signal.raise_signal(signal.SIGTERM)": ("status -15", ""),
    "import atexit; atexit.register(print, 'last')": ("last\nstatus 0", ""),
    "import threading; threading.Thread(target=print, args=('joined',)).start()": ("joined\nstatus 0", ""),
    "print(open('/proc/self/cmdline').read().rstrip('\\0').split('\\0')[1:])": ("['-m', 'child', '--word']", ""),
    "import sys; print([n for n in sys.modules if n.split('.')[0] in ('cli', 'common')])": ("[]\nstatus 0", ""),
    "import numpy, zenoh, os; print(len(os.listdir('/proc/self/task')))": ("1\nstatus 0", ""),
}


def run(directory: Path, code: str) -> "subprocess.CompletedProcess[str]":
    (directory / "child.py").write_text(code, encoding="utf-8")
    environment = {"PATH": "/usr/bin:/bin", "PYTHONPATH": f"{ROOT}:{directory}", "OMP_NUM_THREADS": "1"}
    line = [sys.executable, "-c", PARENT]
    return subprocess.run(line, env=environment, cwd=directory, capture_output=True, text=True, timeout=60)


@pytest.mark.parametrize("code", CASES)
def test_a_module_runs_as_in_a_new_interpreter(tmp_path: Path, code: str) -> None:
    out, errors = CASES[code]
    done = run(tmp_path, code)
    assert out in done.stdout, done
    assert errors in done.stderr


def test_what_renders_or_is_no_module_gets_an_interpreter_of_its_own() -> None:
    assert forked.module_of(["python", "-m", "services.brain"]) == "services.brain"
    assert not forked.module_of(["python", "-m", "services.camera"])
    assert not forked.module_of(["python", "script.py"])
