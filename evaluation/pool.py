"""Worker processes for cases: spawned, each with a pipe; one that dies or hangs costs its case, never the run."""

import multiprocessing
import os
import signal
import tempfile
import traceback
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection, wait
from typing import Any

import msgspec

from common.clock import monotonic
from evaluation.case import Case, Observed, Result
from evaluation.verdict import judge
from services.camera.render import best, environment

WALL_LIMIT, START_LIMIT = 3600.0, 300.0
# GL and speech libraries keep some 50 MB of every world that a process has seen.
CASES_OF_A_PROCESS = 12
Run = Callable[[Case, Callable[[float, str], None]], Result]


class Progressed(msgspec.Struct):
    """Where a worker's case is: robot time [s] and the brain's state."""

    worker: int
    case: Case
    t: float
    state: str


def work(run: Run, pipe: "Connection[Any, Any]", scratch: str, gentle: bool) -> None:
    """A worker's life: cases in, results and progress out, until the pipe closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, _leave if gentle else _drop)
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    tempfile.tempdir = scratch
    status = 1
    try:
        while True:
            case = msgspec.msgpack.decode(pipe.recv_bytes(), type=Case)
            result = run(case, lambda t, state: pipe.send_bytes(msgspec.msgpack.encode((t, state))))
            pipe.send_bytes(msgspec.msgpack.encode(result))
    except (EOFError, BrokenPipeError):
        status = 0
    except Exception:
        traceback.print_exc()
    finally:
        # Not through the interpreter's own end: threads of the speech and picture libraries do not survive it.
        os._exit(status)


def _drop(number: int, frame: object) -> None:
    os._exit(128 + number)


def _leave(number: int, frame: object) -> None:
    raise SystemExit(128 + number)


@contextmanager
def _held_back() -> Iterator[None]:
    """Ctrl-C waits: a process that is being started would be nobody's."""
    came: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, frame: came.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        if came:
            signal.raise_signal(signal.SIGINT)


class Worker:
    """One spawned process and the case it has."""

    def __init__(self, number: int, run: Run, scratch: str, gentle: bool) -> None:
        self.number, self._work = number, (run, scratch, gentle)
        self.case: Case | None = None
        self.started, self.begun = 0.0, False
        self._start()

    def _start(self) -> None:
        context = multiprocessing.get_context("spawn")
        self.pipe, theirs = context.Pipe()
        run, scratch, gentle = self._work
        self._process = context.Process(target=work, args=(run, theirs, scratch, gentle), daemon=False)
        kept = dict(os.environ)
        if not os.environ.get("MUJOCO_GL"):
            # It imports MuJoCo before it could choose.
            os.environ |= environment(best())
        with _held_back():
            self._process.start()
        self._given = 0
        for name in os.environ.keys() - kept.keys():
            del os.environ[name]
        theirs.close()

    def give(self, case: Case) -> None:
        if self._given == CASES_OF_A_PROCESS:
            self.end()
            self._start()
        self._given += 1
        self.case, self.started, self.begun = case, monotonic(), False
        self.pipe.send_bytes(msgspec.msgpack.encode(case))

    def hears(self) -> None:
        """The first word from a case starts its clock: a fresh process may take long to load."""
        if not self.begun:
            self.started, self.begun = monotonic(), True

    def overdue(self, limit: float) -> bool:
        return monotonic() - self.started > (limit if self.begun else max(limit, START_LIMIT))

    def failed(self, why: str) -> Result:
        """The case of a worker that is lost; a new process takes its place."""
        case = self.case
        assert case is not None
        self.end()
        self._start()
        self.case = None
        return judge(case, Observed(crash=why), monotonic() - self.started)

    def exit_code(self) -> int | None:
        """Of a process whose pipe has closed; it may still be on its way out."""
        self._process.join(5)
        return self._process.exitcode

    def ask(self) -> None:
        """Ask it to end."""
        self.pipe.close()
        self._process.terminate()

    def end(self) -> None:
        """Stop it, gently first: it may have processes of its own."""
        self.ask()
        self._process.join(20)
        if self._process.is_alive():
            self._process.kill()
            self._process.join()


def evaluate(
    cases: list[Case], jobs: int, run: Run, limit: float = WALL_LIMIT, gentle: bool = False
) -> Iterator[Result | Progressed]:
    """Results as they come, and progress between them.

    `limit` is wall time for one case [s]. `gentle`: a worker that must end has processes of its own to end first.
    """
    with tempfile.TemporaryDirectory(prefix="tidybot-eval-") as scratch:
        yield from _evaluate(cases, jobs, run, limit, scratch, gentle)


def _evaluate(
    cases: list[Case], jobs: int, run: Run, limit: float, scratch: str, gentle: bool
) -> Iterator[Result | Progressed]:
    waiting = deque(cases)
    workers: list[Worker] = []
    try:
        for number in range(min(max(jobs, 1), len(cases))):
            with _held_back():
                workers.append(Worker(number, run, scratch, gentle))
            workers[-1].give(waiting.popleft())
        while busy := [w for w in workers if w.case is not None]:
            ready = set(wait([w.pipe for w in busy], timeout=1.0))
            for worker in busy:
                if worker.pipe in ready:
                    said = _receive(worker)
                    yield said
                    if isinstance(said, Progressed):
                        worker.hears()
                        continue
                elif worker.overdue(limit):
                    yield worker.failed(f"no result within {limit:.0f} s of wall time")
                else:
                    continue
                worker.case = None
                if waiting:
                    worker.give(waiting.popleft())
    finally:
        for worker in workers:
            worker.ask()
        for worker in workers:
            worker.end()


def _receive(worker: Worker) -> Result | Progressed:
    case = worker.case
    assert case is not None
    try:
        raw = worker.pipe.recv_bytes()
    except (EOFError, OSError):
        return worker.failed(f"the worker process ended with status {worker.exit_code()}")
    try:
        return msgspec.msgpack.decode(raw, type=Result)
    except msgspec.ValidationError:
        t, state = msgspec.msgpack.decode(raw, type=tuple[float, str])
        return Progressed(worker.number, case, t, state)
