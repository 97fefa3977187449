"""The robot as processes: seconds to ready, resident memory, and a mission in lockstep.

Memory is told as each process counts it, with the libraries that several share in every one, and in proportion, where
what n processes share counts 1/n for each: that is what the whole takes. One process instead of many is measured by
`tidybot eval --suite fetch --pipeline fetch`.
"""

import argparse
import json
import os
import tempfile
import time
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from typing import Any

import psutil  # type: ignore[import-untyped]

from cli.processes.ports import free_port
from cli.processes.programs import said_by

PATIENCE = 600.0
"""Time [s] for one command: a mission of `say --wait`, on a busy machine."""
Tidybot = Callable[..., str]


def main() -> None:
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    with tempfile.TemporaryDirectory() as run_dir, ExitStack() as stack:
        own = {**os.environ, "TIDYBOT_RUN_DIR": run_dir}
        tidybot = partial(said_by, "cli.main", environ=own, timeout=PATIENCE)
        stack.callback(tidybot, "down")
        began = time.perf_counter()
        tidybot("up", "--detach", "--speed", "max", "--port", str(free_port()))
        ready = time.perf_counter() - began
        before, started = _clock(tidybot), time.perf_counter()
        tidybot("say", "bring me the red mug", "--wait")
        speed = (_clock(tidybot) - before) / (time.perf_counter() - started)
        rows: list[dict[str, Any]] = json.loads(tidybot("ps", "--json"))
        names = {row["pid"]: row["name"] for row in rows}
        supervisor = psutil.Process(rows[0]["pid"]).parent()
        names |= {supervisor.pid: "supervisor"}
        names |= {child.pid: "watchdog" for child in supervisor.children() if child.pid not in names}
        taken = {name: _memory(pid) for pid, name in names.items()}
    print(f"{'up to ready':34} {ready:8.1f} s")
    rss, pss = zip(*taken.values(), strict=True)
    for name, (counted, share) in {**taken, "all": (sum(rss), sum(pss))}.items():
        print(f"{'resident, ' + name:34} {counted:8.0f} MB  {share:8.0f} in proportion")
    print(f"{'fetch in lockstep':34} {speed:8.1f} x real time")


def _memory(pid: int) -> tuple[float, float]:
    """What a process takes with all that it shares, and in proportion [MB]."""
    info = psutil.Process(pid).memory_full_info()
    return info.rss / 1e6, info.pss / 1e6


def _clock(tidybot: Tidybot) -> float:
    """Robot time now."""
    found: float = json.loads(tidybot("topic", "echo", "joint_states", "--count", "1", "--json"))["t"]
    return found


if __name__ == "__main__":
    main()
