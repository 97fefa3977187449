"""Running a case in this process: the real services and the examiner in lockstep, as fast as the CPU allows."""

import json
import shutil
import tempfile
import traceback
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

from common import messages as m
from common import topics
from common.bus import codec
from common.config import ConfigError
from common.time.clock import monotonic
from common.time.lockstep import DT
from evaluation.case import Case, Observed, Result, Showing, TimedFault
from evaluation.examiner import Examiner, examiner_of
from evaluation.faults.physical.faults import targets, with_faults
from evaluation.faults.reports import FaultReport, Reporter, ignore
from evaluation.homes.new import NotMapped, mapped_first
from evaluation.report.picture import last_picture
from evaluation.stack import Stack
from evaluation.verdict import judge

NAMES = "taught-names.json"
"""What perception keeps in its directory of state."""
PATIENCE = 60.0
"""Robot time [s] within which it is to have learned a name."""
SETTINGS = ("brain.pipeline=vla", "brain.enable_confirmation=false")
Progress = Callable[[float, str], None]
REPORT = 2.0
"""Robot time [s] between two signs of life of a worker."""
OURS = tuple(str(Path(__file__).parents[1] / name) for name in ("common", "services", "evaluation", "judge"))


class FaultScheduler:
    """Injects the faults of a case when the brain is in their states, and reports those that took effect."""

    def __init__(self, stack: Stack, faults: tuple[TimedFault, ...], report: Reporter = ignore) -> None:
        self._stack, self._waiting, self._report = stack, list(faults), report
        self._back: list[tuple[float, str]] = []
        self._since: dict[str, float] = {}

    def step(self) -> None:
        stack, state = self._stack, self._stack.state().state
        self._since.setdefault(state, stack.now)
        due = [s for s in self._waiting if stack.now >= self._since.get(s.state, float("inf")) + s.after]
        for timed in due:
            self._waiting.remove(timed)
            now = round(stack.now, 2)
            for fault, what in self._inject(timed):
                self._report(FaultReport(now, fault, f"{what} in {timed.state}, {timed.after:.2f} s after it began"))
        self._start_again()

    def _inject(self, fault: TimedFault) -> Iterator[tuple[str, str]]:
        """What was done of it."""
        stack, name = self._stack, fault.service
        if fault.jump:
            stack.jump(fault.jump)
            yield "clock jump", f"time leapt by {fault.jump:.0f} s"
        if fault.full and stack.fill_disk(fault.full):
            yield "disk full", "a write failed"
        if name == "router":
            stack.cut(fault.seconds)
            yield "router loss", f"nobody hears anybody for {fault.seconds:.0f} s"
        elif name == "sim":
            stack.restart_sim()
            yield "kill", "the sim was replaced"
        elif name in stack.members and fault.seconds:
            stack.hang(name, fault.seconds)
            yield "hang", f"{name} takes no step for {fault.seconds:.0f} s"
        elif name in stack.members:
            stack.kill(name)
            self._back.append((stack.now + fault.back_after, name))
            yield "kill", f"{name} is gone"

    def _start_again(self) -> None:
        stack = self._stack
        for row in [r for r in self._back if r[0] <= stack.now]:
            self._back.remove(row)
            stack.start(row[1])


def run(case: Case, progress: Progress = lambda t, state: None) -> Result:
    """Run and judge one case. What a service raises ends the case as `crashed`.

    Raises:
        ConfigError: the settings, which all cases of a run share, cannot be used.
    """
    began = monotonic()
    with tempfile.TemporaryDirectory(prefix="case-") as state_dir:
        keeps = bool(case.timed_faults or case.showing)
        return _run(case, progress, began, Path(state_dir) if keeps else None)


def _run(case: Case, progress: Progress, began: float, state_dir: Path | None) -> Result:
    reports: list[FaultReport] = []
    if case.showing is not None and state_dir is not None and (why := show(case.showing, state_dir)):
        seen = Observed(claimed="failed", reason=why, failed_at="GROUNDING", code="NOT_TAUGHT", ended=True)
        return judge(case, seen, monotonic() - began)
    mapping: dict[str, Any] = {}
    if case.explores:
        try:
            case, mapping = mapped_first(case, progress)
        except NotMapped as error:
            seen = Observed(claimed="failed", reason=str(error), failed_at="NAVIGATING", code="NOT_MAPPED", ended=True)
            return judge(case, seen, monotonic() - began)
        except ConfigError:
            raise
        except Exception as error:
            return judge(case, Observed(crash=_words(error)), monotonic() - began)
    try:
        stack = Stack(
            case.scene or "apartment", case.seed, case.settings, household=case.household,
            swaps=_swaps(case, reports.append), without=idle_services(case), state_dir=state_dir,
            replaced=case.replaced,
        )  # fmt: skip
    except ConfigError:
        raise
    except Exception as error:
        return judge(case, Observed(crash=_words(error)), monotonic() - began)
    try:
        examiner: Examiner = stack.join(examiner_of(case))
        try:
            _until_over(stack, examiner, case, reports, progress)
        except Exception as error:
            examiner.abort(stack.now, _words(error))
        examiner.observed.mapping = mapping
        examiner.observed.evidence.hits += mapping.get("hits", [])
        result = judge(case, examiner.observed, monotonic() - began)
        result.evidence["timeline"] = timeline(partial(stack.bus.get, topics.BRAIN_MISSIONS))
        if not result.met:
            result.evidence["picture"] = last_picture(stack.bus.get)
        return result
    finally:
        stack.close()


def _until_over(stack: Stack, examiner: Examiner, case: Case, reports: list[FaultReport], progress: Progress) -> None:
    """`reports`: what the injectors have reported so far."""
    scheduler = FaultScheduler(stack, case.timed_faults, reports.append)
    due, told = 0.0, 0
    while not examiner.done:
        stack.tick()
        if case.timed_faults and round(stack.now / DT) % 5 == 0:
            scheduler.step()
        for report in reports[told:]:
            examiner.note_fault(report)
        told = len(reports)
        if stack.now >= due:
            due = stack.now + REPORT
            progress(stack.now, stack.state().state)


def _words(error: Exception) -> str:
    """What was raised, and where in our code."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if f.filename.startswith(OURS)]
    where = f" at {Path(frames[-1].filename).name}:{frames[-1].lineno}" if frames else ""
    return f"{type(error).__name__}: {error}{where}"


def _swaps(case: Case, report: Reporter) -> dict[str, Any]:
    return {name: partial(with_faults, case=case, report=report) for name in targets(case)}


def idle_services(case: Case) -> tuple[str, ...]:
    """The services that a case has no use for: the planner, of the fetch pipeline."""
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


# --- what a person shows the robot before a case begins: a world of its own, in which a thing gets its name
def show(showing: Showing, folder: Path) -> str:
    """Run the showing; the names that the robot keeps of it go to `folder`. Why it has learned nothing, or ""."""
    with tempfile.TemporaryDirectory(prefix="showing-") as kept:
        stack = Stack(
            showing.scene, showing.seed, SETTINGS, household=showing.household, without=("dashboard", "speech"),
            state_dir=Path(kept),
        )  # fmt: skip
        try:
            why = _teach(stack, showing)
        finally:
            stack.close()
        if not why:
            shutil.copy(Path(kept) / NAMES, folder / NAMES)
    return why


def _teach(stack: Stack, showing: Showing) -> str:
    while stack.state().state != "WAITING":
        if stack.now > PATIENCE:
            return "the robot does not get ready"
        stack.tick()
    end = stack.now + PATIENCE
    if showing.at is not None:
        request = m.TeachRequest(name=showing.name, id="click", position=showing.at)
        stack.bus.send(topics.TEACH, request)
    else:
        stack.bus.send(topics.VOICE_COMMAND, m.VoiceCommand(text=showing.sentence, id="shown", confirmed=True))
    while stack.now < end:
        stack.tick()
        last = stack.bus.last.get(topics.TAUGHT.key)
        if last is not None:
            result = codec.decode(topics.TAUGHT, last)
            return "" if result.ok else f"{result.code}: {result.detail}"
        ended = stack.state().last
        if ended is not None and ended.outcome != "delivered":
            return ended.reason
    return "it says nothing of the name"
