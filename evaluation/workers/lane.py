"""A lane: one child process that runs case after case, replaced when it is old, ends or hangs.

The same lane serves the local pool and every machine of a cluster, so that a seed means the same in both. A case that
loses its process is repeated in a new one; one that loses `ATTEMPTS` of them is `crashed`.
"""

import os
import pkgutil
import signal
import subprocess
import sys
import tempfile
import threading
import traceback
from collections.abc import Callable
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from typing import Any

import msgspec

from common.config import ConfigError
from common.rendering.backend import best, environment
from common.time.clock import monotonic
from evaluation.case import Case, Observed, Result
from evaluation.verdict import judge

Progress = Callable[[float, str], None]
Run = Callable[[Case, Progress], Result]
WALL_LIMIT = 3600.0
"""Wall time [s] for one case: six times what the longest case of any suite took on a busy machine."""
SILENCE = 300.0
"""Wall time [s] without a sign of life (one every 2 s of robot time) after which a process counts as hung; a fresh one
may take a minute to load on a busy machine."""
ATTEMPTS = 2
"""Processes that one case may lose before it is reported as crashed."""
CASES_OF_A_PROCESS = 12
"""Worlds after which a process is replaced; its memory grew by 80 MB over the first eight, which nobody holds."""
GRACE = 20.0
"""Time [s] to end after SIGTERM: a process may have services of its own to end first."""


class LaneClosed(Exception):
    """The lane was closed while a case was running."""


def name_of(run: Run) -> str:
    """The name of a function as `module:function`."""
    return f"{run.__module__}:{run.__qualname__}"


class Lane:
    """`run` is the name of a module-level function, `module:function`, which the child imports."""

    def __init__(self, run: str, limit: float = WALL_LIMIT, silence: float = SILENCE) -> None:
        self._name = run
        self._limit, self._silence = limit, silence
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._pipe: Connection[Any, Any] | None = None
        self._scratch: tempfile.TemporaryDirectory[str] | None = None
        self._given, self._closed = 0, False

    def run(self, case: Case, progress: Progress, lost: Callable[[str], None] = lambda why: None) -> Result:
        """Run a case and return its result; `lost` is called for each process that died on it.

        Raises:
            LaneClosed: `close` was called by another thread.
            ConfigError: the case's settings cannot be used, so that a second attempt would end alike.
        """
        began = monotonic()
        for attempt in range(1, ATTEMPTS + 1):
            found = self._once(case, progress)
            if isinstance(found, Result):
                return found
            self._end()
            why = found if ATTEMPTS == 1 else f"{found}, in each of {ATTEMPTS} attempts"
            if attempt < ATTEMPTS:
                lost(found)
        return judge(case, Observed(crash=why), monotonic() - began)

    def _once(self, case: Case, progress: Progress) -> Result | str:
        """The result, or why there is none."""
        pipe = self._ready()
        heard = monotonic()
        # A fresh process may take long to load: its first word starts the clock.
        end = float("inf")
        try:
            pipe.send_bytes(msgspec.msgpack.encode(case))
            while True:
                now = monotonic()
                if now > end:
                    return f"no result within {self._limit:.0f} s of wall time"
                if not pipe.poll(1.0):
                    if now - heard > self._silence:
                        return f"no sign of life for {self._silence:.0f} s"
                    continue
                said = msgspec.msgpack.decode(pipe.recv_bytes(), type=tuple[float, str] | Result | str)
                if isinstance(said, str):
                    raise ConfigError(said)
                if isinstance(said, Result):
                    return said
                heard = monotonic()
                end = min(end, heard + self._limit)
                progress(*said)
        except (OSError, EOFError):
            if self._closed:
                raise LaneClosed from None
            return f"the worker process ended with status {self._status()}"

    # --- the process
    def _ready(self) -> "Connection[Any, Any]":
        if self._given == CASES_OF_A_PROCESS:
            self._end()
        with self._lock:
            if self._closed:
                raise LaneClosed
            if self._process is None or self._pipe is None:
                self._pipe, theirs = Pipe()
                self._scratch = tempfile.TemporaryDirectory(prefix="tidybot-eval-", ignore_cleanup_errors=True)
                # Each world has threads of its own, and glibc would keep an arena of memory for each of them.
                env = {"OMP_NUM_THREADS": "1", "MALLOC_ARENA_MAX": "2", **os.environ, "TMPDIR": self._scratch.name}
                env["PYTHONPATH"] = os.pathsep.join(p for p in sys.path if p)
                if not env.get("MUJOCO_GL"):
                    # It imports MuJoCo before it could choose.
                    env |= environment(best())
                command = [sys.executable, "-m", "evaluation.workers.lane", str(theirs.fileno()), self._name]
                # In a group of its own: Ctrl-C at the terminal is for the one who closes the lanes.
                self._process = subprocess.Popen(
                    command, env=env, pass_fds=[theirs.fileno()], stdin=subprocess.DEVNULL, process_group=0
                )
                theirs.close()
                self._given = 0
            self._given += 1
            return self._pipe

    def _status(self) -> int | None:
        """Exit status of a process whose pipe has closed; it may still be on its way out."""
        process = self._process
        if process is None:
            return None
        try:
            return process.wait(5)
        except subprocess.TimeoutExpired:
            return None

    def _end(self) -> None:
        with self._lock:
            process, pipe, scratch = self._process, self._pipe, self._scratch
            self._process = self._pipe = self._scratch = None
        if pipe is not None and not self._closed:
            pipe.close()
        if process is not None:
            process.terminate()
            try:
                process.wait(GRACE)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        if scratch is not None:
            scratch.cleanup()

    @property
    def closed(self) -> bool:
        return self._closed

    def close(self) -> None:
        """End the process, also from another thread than the one that runs a case."""
        with self._lock:
            self._closed = True
        self._end()


def child(descriptor: int, name: str) -> None:
    """The child process's loop: takes cases, sends signs of life and results, until the pipe closes."""
    signal.signal(signal.SIGTERM, _leave)
    run: Run = pkgutil.resolve_name(name)
    pipe: Connection[Any, Any] = Connection(descriptor)
    encode = msgspec.msgpack.encode
    status = 1
    try:
        while True:
            case = msgspec.msgpack.decode(pipe.recv_bytes(), type=Case)
            pipe.send_bytes(encode((0.0, "starting")))
            try:
                found: Result | str = run(case, lambda t, state: pipe.send_bytes(encode((t, state))))
            except ConfigError as error:
                found = str(error)
            pipe.send_bytes(encode(found))
    except (EOFError, BrokenPipeError, ConnectionResetError, SystemExit):
        status = 0
    except Exception:
        traceback.print_exc()
    finally:
        # Not through the interpreter's own end: threads of the speech and picture libraries do not survive it.
        os._exit(status)


def _leave(number: int, frame: object) -> None:
    raise SystemExit(128 + number)


if __name__ == "__main__":
    child(int(sys.argv[1]), sys.argv[2])
