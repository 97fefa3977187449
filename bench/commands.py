"""`tidybot` as people run it, for a robot of a benchmark's own."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager

PATIENCE = 600.0
"""Time [s] for one command: a mission of `say --wait`, on a busy machine."""
Tidybot = Callable[..., str]


@contextmanager
def commands() -> Iterator[Tidybot]:
    """Runs `tidybot` with some words and returns what it prints; at the end whatever is up goes down.

    Raises:
        SystemExit: a command failed, with what it said.
    """
    with tempfile.TemporaryDirectory() as run_dir:
        environment = {**os.environ, "TIDYBOT_RUN_DIR": run_dir}

        def tidybot(*words: str) -> str:
            command = [sys.executable, "-m", "cli.main", *words]
            done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=PATIENCE)
            if done.returncode:
                raise SystemExit(f"tidybot {words[0]}: {done.stdout}{done.stderr}")
            return done.stdout

        try:
            yield tidybot
        finally:
            tidybot("down")
