"""One case in this process: the real services, the examiner among them, in lockstep as fast as the CPU allows."""

import json
import tempfile
import traceback
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from common import topics
from common.clock import monotonic
from common.lockstep import DT
from evaluation.case import Case, Observed, Result, Strike
from evaluation.examiner import Examiner, examiner_of
from evaluation.faults import faulty
from evaluation.picture import last_picture
from evaluation.stack import Stack
from evaluation.verdict import judge

Progress = Callable[[float, str], None]
REPORT = 2.0
OURS = tuple(str(Path(__file__).parents[1] / name) for name in ("common", "services", "evaluation", "judge"))


class Director:
    """Does the strikes of a case when the brain is in their states."""

    def __init__(
        self, stack: Stack, strikes: tuple[Strike, ...], struck: Callable[[float], None] = lambda now: None
    ) -> None:
        self._stack, self._waiting, self._struck = stack, list(strikes), struck
        self._back: list[tuple[float, str]] = []
        self._since: dict[str, float] = {}

    def step(self) -> None:
        stack, state = self._stack, self._stack.state().state
        self._since.setdefault(state, stack.now)
        due = [s for s in self._waiting if stack.now >= self._since.get(s.state, float("inf")) + s.after]
        for strike in due:
            self._waiting.remove(strike)
            self._struck(stack.now)
            self._strike(strike)
        for service in (stack.sim, *(s for s, _ in stack.members.values())):
            if (at := getattr(getattr(service, "door", None), "hit_at", None)) is not None:
                self._struck(at)
        self._start_again()

    def _strike(self, strike: Strike) -> None:
        stack = self._stack
        if strike.jump:
            stack.jump(strike.jump)
        if strike.full:
            stack.fill_disk(strike.full)
        if strike.service == "router":
            stack.cut(strike.seconds)
        elif strike.service == "sim":
            stack.restart_sim()
        elif strike.service in stack.members and strike.seconds:
            stack.hang(strike.service, strike.seconds)
        elif strike.service in stack.members:
            stack.kill(strike.service)
            self._back.append((stack.now + strike.back_after, strike.service))

    def _start_again(self) -> None:
        stack = self._stack
        for row in [r for r in self._back if r[0] <= stack.now]:
            self._back.remove(row)
            stack.start(row[1])


def run(case: Case, progress: Progress = lambda t, state: None) -> Result:
    """Run and judge one case. What a service raises ends the case as `crashed`."""
    began = monotonic()
    with tempfile.TemporaryDirectory(prefix="case-") as state_dir:
        return _run(case, progress, began, Path(state_dir) if case.strikes else None)


def _run(case: Case, progress: Progress, began: float, state_dir: Path | None) -> Result:
    try:
        stack = Stack(
            case.scene or "apartment", case.seed, case.settings, swaps=_swaps(case), without=idle_services(case),
            state_dir=state_dir,
        )  # fmt: skip
    except Exception as error:
        return judge(case, Observed(crash=_words(error)), monotonic() - began)
    try:
        examiner: Examiner = stack.join(examiner_of(case))
        try:
            _until_over(stack, examiner, case, progress)
        except Exception as error:
            examiner.abort(stack.now, _words(error))
        result = judge(case, examiner.observed, monotonic() - began)
        result.evidence["timeline"] = timeline(partial(stack.bus.get, topics.BRAIN_MISSIONS))
        if not result.met:
            result.evidence["picture"] = last_picture(stack.bus.get)
        return result
    finally:
        stack.close()


def _until_over(stack: Stack, examiner: Examiner, case: Case, progress: Progress) -> None:
    director = Director(stack, case.strikes, examiner.struck)
    due = 0.0
    while not examiner.done:
        stack.tick()
        if case.fault and round(stack.now / DT) % 5 == 0:
            director.step()
        if stack.now >= due:
            due = stack.now + REPORT
            progress(stack.now, stack.state().state)


def _words(error: Exception) -> str:
    """What was raised, and where in our code."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if f.filename.startswith(OURS)]
    where = f" at {Path(frames[-1].filename).name}:{frames[-1].lineno}" if frames else ""
    return f"{type(error).__name__}: {error}{where}"


def _swaps(case: Case) -> dict[str, Any]:
    return {r.service: partial(faulty, rules=case.rules) for r in case.rules}


def idle_services(case: Case) -> tuple[str, ...]:
    """The fetch pipeline asks the planner for nothing."""
    if not any("pipeline=fetch" in s for s in case.settings):
        return ()
    return ("planner",)


def timeline(query: Callable[[bytes], bytes | None]) -> list[str]:
    """The mission log of every mission of the case, as the brain tells it."""
    rows: list[str] = []
    for mission in json.loads(query(b"") or b"[]"):
        record = json.loads(query(str(mission["id"]).encode()) or b"null") or {}
        for entry in record.get("entries", []):
            words = (f"{entry['t']:.2f} s", entry["state"], entry["cause"], entry["evidence"])
            rows.append("  ".join(str(w) for w in words if w))
    return rows
