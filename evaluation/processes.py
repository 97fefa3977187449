"""Running a case with every service as a process: `tidybot up --speed max`, the examiner as a participant."""

import os
import shutil
import tempfile
import threading
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import msgspec

from cli.errors import CliError
from cli.processes.own_robot import own_robot
from cli.processes.plan import Plan
from cli.processes.services import SERVICES, Service
from cli.processes.supervision import Supervision
from cli.processes.up import bring_up
from common import config, topics
from common.bus import delivery
from common.bus.session import BusError, open_session
from common.files.plan_file import to_toml
from common.household import load_words, told
from common.process.host import StopSignal
from common.process.service_process import Process
from common.scene import load_scene
from common.time.clock import SimClock, monotonic
from evaluation.case import Case, Observed, Result
from evaluation.examiner import Examiner, examiner_of
from evaluation.faults.physical.faults import targets
from evaluation.faults.processes import ProcessFaultInjector, unavailable
from evaluation.faults.reports import FaultReportFile
from evaluation.node import CASE, FAULT_REPORTS
from evaluation.report.picture import last_picture
from evaluation.runner import REPORT, Progress, idle_services, timeline
from evaluation.stack import paced_services
from evaluation.verdict import judge

WALL_LIMIT = 3000.0
"""Wall time [s] for one case; below the worker's own limit, so that the case can say why it ended."""


class Ended(StopSignal):
    """Stops the examiner's loop when its case is over."""

    def __init__(self, progress: Progress) -> None:
        # Signals stay with the worker: this one only ends a loop.
        self._event = threading.Event()
        self.process: Process | None = None
        self._progress, self._due = progress, 0.0
        self._end = monotonic() + WALL_LIMIT
        self.follow: Callable[[float, str], None] = lambda now, state: None

    def is_set(self) -> bool:
        process = self.process
        if process is not None and process.io.clock.now() >= self._due:
            self._due = process.io.clock.now() + REPORT
            self._progress(process.io.clock.now(), _state(process) or "starting")
        if process is not None:
            self.follow(process.io.clock.now(), _state(process))
        over = process is not None and bool(process.service.done)
        return over or monotonic() > self._end or super().is_set()


def _state(process: Process) -> str:
    """What the brain was last seen to do."""
    return "".join(process.service.observed.states[-1:])


def run(case: Case, progress: Progress = lambda t, state: None) -> Result:
    """Run and judge one case. A process that does not come up ends it as `crashed`."""
    began = monotonic()
    directory = Path(tempfile.mkdtemp(prefix="case-"))
    supervision = Supervision(directory / "run")
    try:
        if why := unavailable(case):
            raise CliError(f"not available as processes: {why}")
        return _run(case, directory, supervision, progress, began)
    except (CliError, BusError) as error:
        return judge(case, Observed(crash=str(error).partition("\n")[0]), monotonic() - began)
    finally:
        supervision.stop()
        shutil.rmtree(directory, ignore_errors=True)


def _run(case: Case, directory: Path, supervision: Supervision, progress: Progress, began: float) -> Result:
    plan = _plan(case, directory)
    world = case.scene or load_scene("apartment")
    household = case.household or told(world, load_words(config.config_dir()))
    bring_up(supervision, plan, lambda text: None)
    stop, clock = Ended(progress), SimClock()
    shared = config.RuntimeConfig(seed=case.seed, lockstep=True, log_level="error")
    with open_session(plan.connect, plan.namespace) as session:
        process = Process(examiner_of(case), config.Config(), shared, household, session, clock, stop, directory, world)
        examiner: Examiner = process.service
        injected = FaultReportFile(directory / FAULT_REPORTS)
        injector = ProcessFaultInjector(supervision, case.timed_faults, directory, injected.report)

        def follow(now: float, state: str) -> None:
            injector.step(now, state)
            for report in injected.news():
                examiner.note_fault(report)

        stop.process, stop.follow = process, follow
        try:
            process.run_on_sim_clock(clock)
            injector.finish(clock.now())
            follow(clock.now(), "")
            if not examiner.done:
                examiner.abort(clock.now(), f"no end within {WALL_LIMIT:.0f} s of wall time")
            result = judge(case, examiner.observed, monotonic() - began)
            result.evidence["timeline"] = timeline(partial(_ask, session))
            if not result.met:
                result.evidence["picture"] = last_picture(partial(_value, session))
        finally:
            process.close()
    return result


def _ask(session: Any, payload: bytes) -> bytes | None:
    return next(iter(delivery.fetch(session, topics.BRAIN_MISSIONS, payload).values()), None)


def _value(session: Any, key: str) -> bytes | None:
    return next(iter(delivery.fetch(session, key).values()), None)


def _plan(case: Case, directory: Path) -> Plan:
    """`tidybot up` for the case: the services with rules behind their doors, the examiner awaited as well."""
    file = directory / "case.json"
    file.write_bytes(msgspec.json.encode(case))
    files = {"scene": case.scene, "household": case.household}
    given = {name: str(directory / f"{name}.toml") if it is not None else "" for name, it in files.items()}
    for name, it in files.items():
        if it is not None:
            Path(given[name]).write_text(to_toml(it), encoding="utf-8")
    plan = Plan(own_robot("eval", seed=case.seed, settings=case.settings, **given))
    faulty = targets(case)
    needed = {"router", "sim", *paced_services()} - {*idle_services(case)}
    services = [
        Service(s.name, "evaluation.node", s.paced, s.token) if s.name in faulty else s
        for s in SERVICES
        if s.name in needed
    ]
    plan.pace(services, Examiner.NAME)
    clean = {k: v for k, v in plan.environ.items() if k in _plan_keys(plan) or not k.startswith(config.PREFIX)}
    plan.environ = {**clean, CASE: str(file), "TIDYBOT_STATE_DIR": str(directory)}
    return plan


def _plan_keys(plan: Plan) -> set[str]:
    """What the plan itself sets, and not the user's environment: a seed must mean the same everywhere."""
    return {k for k, v in plan.environ.items() if os.environ.get(k) != v}
