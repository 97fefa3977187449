"""A service as a fork of supervisord behaves like one with an interpreter of its own."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from cli.processes import forked
from tests.support import ROOT

PARENT = """
import json, os, signal, sys
from cli.processes import forked
forked.load()
signal.signal(signal.SIGTERM, lambda number, frame: None)
ended = []
for number in range(int(sys.argv[1])):
    child = os.fork()
    if child == 0:
        for name, stream in (("out", 1), ("err", 2)):
            os.dup2(os.open(f"{name}{number}", os.O_CREAT | os.O_WRONLY), stream)
        forked.become([sys.executable, "-m", f"child{number}", "--word"], {"PATH": os.environ["PATH"], "GIVEN": "1"})
    ended.append(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
print(json.dumps(ended))
"""
CASES = {
    "import sys; sys.exit(3)": (3, "", ""),
    "import sys; sys.exit('no')": (1, "", "no"),
    "raise ValueError('broken')": (1, "", "ValueError: broken"),
    "import sys; print(__name__, sys.argv[1:])": (0, "__main__ ['--word']", ""),
    "import sys; print(sys.orig_argv[1:])": (0, "['-m', '{module}', '--word']", ""),
    "import os; print(sorted(os.environ))": (0, "['GIVEN', 'PATH']", ""),
    "import signal; signal.raise_signal(signal.SIGTERM)": (-15, "", ""),
    "import atexit; atexit.register(print, 'last')": (0, "last", ""),
    "import threading; threading.Thread(target=print, args=('joined',)).start()": (0, "joined", ""),
    "print(open('/proc/self/cmdline').read().split('\\0')[1:3])": (0, "['-m', '{module}']", ""),
    "import sys; print([n for n in sys.modules if n.split('.')[0] in ('cli', 'common')])": (0, "[]", ""),
    "import numpy, zenoh, os; print(len(os.listdir('/proc/self/task')))": (0, "1", ""),
}
"""A module's code, and its exit status, output and last words."""


@pytest.fixture(scope="module")
def ended(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[int, str, str]]:
    """What became of each case, as a fork of one parent."""
    directory = tmp_path_factory.mktemp("children")
    for number, code in enumerate(CASES):
        (directory / f"child{number}.py").write_text(code, encoding="utf-8")
    environment = {"PATH": "/usr/bin:/bin", "PYTHONPATH": f"{ROOT}:{directory}", "OMP_NUM_THREADS": "1"}
    line = [sys.executable, "-c", PARENT, str(len(CASES))]
    done = subprocess.run(line, env=environment, cwd=directory, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr

    def written(name: str, number: int) -> str:
        return Path(directory / f"{name}{number}").read_text(encoding="utf-8").strip()

    return {
        code: (status, written("out", n), written("err", n).split("\n")[-1])
        for n, (code, status) in enumerate(zip(CASES, json.loads(done.stdout), strict=True))
    }


@pytest.mark.parametrize("code", CASES)
def test_a_module_runs_as_in_a_new_interpreter(ended: dict[str, tuple[int, str, str]], code: str) -> None:
    status, out, errors = CASES[code]
    assert ended[code] == (status, out.format(module=f"child{list(CASES).index(code)}"), errors)


def test_what_is_no_module_gets_an_interpreter_of_its_own() -> None:
    assert forked.module_of(["python", "-m", "services.brain"]) == "services.brain"
    assert not forked.module_of(["python", "script.py"])
