"""Cases without a robot for the tests of pools; of few imports, because every process of a pool loads it."""

import os
import time
from collections.abc import Callable
from pathlib import Path

from evaluation.case import Case, Line, Observed, Result
from evaluation.verdict import judge


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
        time.sleep(1.0)
    return judge(case, Observed(claimed="failed", failed_at="GRABBING", code="MISSED", ended=True), 0.1)
