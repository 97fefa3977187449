"""CPU time of functions that are probed from outside, each without those that it calls and that are probed too."""

import threading
import time
from collections import Counter, defaultdict
from collections.abc import Callable
from typing import Any

Key = tuple[str, str]
"""A service and a part of it."""
Seconds = dict[Key, float]
NOBODY = "examiner"
"""Whose account a part is on that no service calls: the evaluation's own."""
CALIBRATION = 20000
"""Calls of nothing that tell what a probe costs itself (about 3 us), which is taken off."""


class Meter:
    """Adds up the CPU time [s] of what is probed, each part without the parts that it calls."""

    def __init__(self, clock: Callable[[], float] = time.thread_time) -> None:
        self._clock = clock
        self._here = threading.local()
        self._threads: list[tuple[Seconds, Counter[Key], Counter[Key]]] = []
        self._inside = self._around = 0.0
        self._calibrate()

    def probe(self, function: Callable[..., Any], part: str, service: str = "") -> Callable[..., Any]:
        """`function` on the account of `part`, and of `service` or else the one that calls it."""
        here, clock = self._here, self._clock

        def probed(*args: Any, **named: Any) -> Any:
            stack = getattr(here, "stack", None)
            if stack is None:
                stack = here.stack = []
                here.rows = defaultdict(float), Counter(), Counter()
                self._threads.append(here.rows)
            spent, calls, within = here.rows
            now = clock()
            if stack:
                spent[stack[-1]] += now - here.since
                within[stack[-1]] += 1
            key = (service or (stack[-1][0] if stack else NOBODY), part)
            calls[key] += 1
            stack.append(key)
            here.since = now
            try:
                return function(*args, **named)
            finally:
                now = clock()
                spent[stack.pop()] += now - here.since
                here.since = now

        return probed

    def take(self) -> Seconds:
        """CPU seconds of each part since the last time, without what the probes cost; nothing probed may run now."""
        found: Seconds = defaultdict(float)
        for spent, calls, within in self._threads:
            for key, seconds in spent.items():
                found[key] += seconds - calls[key] * self._inside - within[key] * self._around
            for row in (spent, calls, within):
                row.clear()
        return found

    def _calibrate(self) -> None:
        def nothing() -> None:
            pass

        probed = self.probe(nothing, "callee")

        def calls(function: Callable[[], None]) -> Callable[[], None]:
            def run() -> None:
                for _ in range(CALIBRATION):
                    function()

            return run

        self.probe(calls(nothing), "bare")()
        self.probe(calls(probed), "caller")()
        found = self.take()
        self._inside = found[NOBODY, "callee"] / CALIBRATION
        self._around = (found[NOBODY, "caller"] - found[NOBODY, "bare"]) / CALIBRATION
