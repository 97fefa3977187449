"""Structured logs: one line a record on stderr, and the same record as a message for `log/<service>`."""

import contextlib
import sys
from collections.abc import Callable
from typing import Any

from common import messages as m
from common.time.clock import Clock

LEVELS = {"debug": 10, "info": 20, "warning": 30, "error": 40}


class Logger:
    """Names the service and, while one runs, the mission in every record."""

    def __init__(
        self,
        service: str,
        clock: Clock,
        level: str = "info",
        sink: Callable[[m.LogRecord], None] | None = None,
    ) -> None:
        if level not in LEVELS:
            raise ValueError(f"log level {level!r} is none of {', '.join(LEVELS)}")
        self.mission = ""
        self.last_error = ""
        self._service, self._clock, self._sink = service, clock, sink
        self._threshold = LEVELS[level]

    def debug(self, event: str, **fields: Any) -> None:
        self._emit("debug", event, fields)

    def info(self, event: str, **fields: Any) -> None:
        self._emit("info", event, fields)

    def warning(self, event: str, **fields: Any) -> None:
        self._emit("warning", event, fields)

    def error(self, event: str, **fields: Any) -> None:
        self.last_error = event
        self._emit("error", event, fields)

    def _emit(self, level: str, event: str, fields: dict[str, Any]) -> None:
        if LEVELS[level] < self._threshold:
            return
        if self.mission:
            fields = {"mission": self.mission, **fields}
        now = self._clock.now()
        # A full disk behind it, or a reader that has gone, is no reason to stop working.
        with contextlib.suppress(OSError):
            print(render(now, level, self._service, event, fields), file=sys.stderr, flush=True)
        if self._sink is not None:
            plain: dict[str, object] = {
                k: v if isinstance(v, (str, int, float, bool)) else str(v) for k, v in fields.items()
            }
            self._sink(m.LogRecord(t=now, service=self._service, level=level, event=event, fields=plain))


def render(t: float, level: str, service: str, event: str, fields: dict[str, Any]) -> str:
    """`   12.34 INFO    brain  goal sent key=value`."""
    tail = "".join(f" {k}={_value(v)}" for k, v in fields.items())
    return f"{t:10.2f} {level.upper():7} {service:12} {event}{tail}"


def _value(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.3f}"
    text = str(value)
    return repr(text) if not text or " " in text or "\n" in text else text
