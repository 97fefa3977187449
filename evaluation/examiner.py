"""The examiner, a participant of the lockstep: plays the user, observes physics, ends the case."""

from collections import deque
from typing import Any

import numpy as np

from common import messages as m
from common import topics
from common.bus.port import Io
from common.config import Config
from evaluation.case import Case, Line, Observed
from evaluation.faults.reports import FaultReport
from evaluation.person.dialogue import Dialogue, Onlooker
from evaluation.shortest import ShortestPaths
from evaluation.watch import observe
from judge.evidence import Sample
from judge.observer import WATCH, Observer

OPEN = ("WAITING", "LISTENING")
OVER = ("COMPLETED", "ERROR")
QUIET = 40.0
"""Time [s] of quiet after which a case without an outcome is over."""


class Examiner:
    """Runs one case; once it is `done`, `observed` holds what was seen. `examiner_of` makes the class for a case."""

    NAME = "examiner"
    HZ = 20
    CONFIG = Config
    KNOWS_WORLD = True
    READS = (
        topics.SIM_MODEL, topics.SIM_STATE, topics.SIM_STATUS, topics.SPEECH_STATUS, topics.BRAIN_STATE,
        topics.SYSTEM_STATUS, topics.SIM_CONTACTS,
    )  # fmt: skip
    WRITES = (topics.SPEECH_TEXT, topics.AUDIO_PCM, topics.VOICE_COMMAND)
    case: Case

    def __init__(self, config: Config, io: Io) -> None:
        self._case, self._io = self.case, io
        self._dialogue = Dialogue(self._case, io, self.HZ)
        self._observer = Observer(io.world)
        self._onlooker = Onlooker()
        self._lines = deque(self._case.lines)
        self._line: Line | None = None
        self.active = False
        self._ended_at: float | None = None
        self._quiet_since = 0.0
        self._when: dict[str, float] = {}
        self._at = self._step_at_fault = ("", "")
        self.observed = Observed()
        self.done = False

    def step(self, now: float) -> None:
        """Observe the world, play the simulated user, note the end of the case."""
        if self.done:
            return
        self._watch()
        self._listen(now)
        if not self._observer.ready:
            return
        self.follow(now)
        self._talk(now)
        self.done = self._over(now)
        if self.done:
            self._conclude(now)

    # --- physics
    def _watch(self) -> None:
        first = not self._observer.ready
        for t, sample in observe(self._io, self._observer):
            self._onlooker.see(t, sample)
            if first:
                self.observed.shortest, first = self._shortest(sample), False
        for status in self._io.take_all(topics.SIM_STATUS):
            self.observed.stopped |= status.state == "stopped"

    def _shortest(self, sample: Sample) -> float:
        """The shortest way [m] of a base that makes all deliveries; 0 where there is none."""
        wants = self._case.wants
        deliveries = [(sample.things[w.thing].position[:2], sample.things[w.thing].on, w.goals[0]) for w in wants]
        found = ShortestPaths(self._io.world).mission(sample.base, deliveries)
        return round(found, 3) if np.isfinite(found) else 0.0

    # --- the robot's words and states
    def _listen(self, now: float) -> None:
        for status in self._io.take_all(topics.SPEECH_STATUS):
            before = self._observer.saying
            saying = self._observer.speech(now, status)
            if saying and saying != before:
                self.observed.said.append(saying)
            self._dialogue.hear(saying, now, self._onlooker.shown)

    def follow(self, now: float) -> None:
        """Take a message of `brain/state`."""
        seen = self.observed
        for status in self._io.take_all(topics.SYSTEM_STATUS):
            self._observer.status(now, status)
        for state in self._io.take_all(topics.BRAIN_STATE):
            self._observer.brain(now, state)
            self._onlooker.offered = state.offered
            if not seen.states or seen.states[-1] != state.state:
                seen.states.append(state.state)
            self._when.setdefault(state.state, now)
            self._progress(state, now)
            # A brain that has been restarted is IDLE with its mission until it has looked at the world.
            resuming = state.state == "IDLE" and bool(state.mission_id)
            if resuming or state.state not in (*OPEN, *OVER, "IDLE"):
                self.active, self._ended_at = True, None
                seen.stage = seen.stage if resuming else state.state
            elif state.state in (*OPEN, "IDLE") and self.active:
                self.active, self._ended_at = False, now
                self._when.setdefault("ended", now)
            if state.last is not None:
                last = state.last
                seen.claimed, seen.reason = last.outcome, last.reason
                seen.failed_at, seen.code, seen.explained = last.stage, last.code, last.spoken
            self._quiet_since = now
        if self._when.keys() & set(OPEN):
            self._when.setdefault("ready", now)

    def note_fault(self, report: FaultReport) -> None:
        """Note that a fault took effect; the first starts the clock of the recovery."""
        self.observed.fault_reports.append(report)
        if self.observed.fault_at is None:
            self.observed.fault_at, self._step_at_fault = report.t, self._at

    def _progress(self, state: m.BrainState, now: float) -> None:
        """Recovered is a mission that has come to another step than the one in which the fault took effect."""
        self._at = state.state, state.step
        seen = self.observed
        if seen.fault_at is None or seen.recovery is not None or state.state == "IDLE":
            return
        if self._at != self._step_at_fault:
            seen.recovery = round(now - seen.fault_at, 2)

    # --- the person
    def _talk(self, now: float) -> None:
        while self._lines and self._reached(self._lines[0], now):
            self._note_mission()
            if self._line is None:
                self._observer.begin()
            self._line = line = self._lines.popleft()
            if line.when == "ended":
                self._dialogue.user.set_goal(line.text, line.thing)
                # The next one waits for the end of this one's mission.
                del self._when["ended"]
            self._observer.expect(self._case.goal_of(line))
            self._dialogue.say(line.text, now)
        if self._dialogue.step(now, opening=not self.active, speed=self._onlooker.speed):
            self._ended_at = None

    def _note_mission(self) -> None:
        """The mission of the last line is over: what is not as it wants it."""
        if self._case.explores and self._line is not None and self._line.goal is not None:
            self.observed.missions.append((self._line.text, self._observer.shortfall(self._line.goal)))

    def _reached(self, line: Line, now: float) -> bool:
        """Lines come one after the other, each at its moment."""
        at = self._when.get(line.when)
        return at is not None and now >= at + line.after

    # --- the end
    def _over(self, now: float) -> bool:
        if now > self._case.limit:
            return True
        quiet_since = max(self._quiet_since, self._dialogue.last)
        quiet = "ready" in self._when and not self.active and now >= quiet_since + QUIET
        if self._lines or self._dialogue.busy:
            if quiet and self._line is not None:
                # What was said has led to no mission.
                self._when.setdefault("ended", now)
            return False
        self.observed.ended = self._ended_at is not None
        if self._ended_at is not None:
            return now >= self._ended_at + WATCH
        return quiet

    def abort(self, now: float, why: str) -> None:
        """End the case after an error of the run, with what was observed so far."""
        self.observed.crash = why
        self._conclude(now)

    def _conclude(self, now: float) -> None:
        seen = self.observed
        observer, goal = self._observer, self._case.goal
        seen.evidence, seen.shown = observer.conclude(goal), observer.shown(goal)
        self._note_mission()
        seen.claims, seen.shortfall, seen.wrong = observer.claims, observer.shortfall(goal), observer.wrong()
        seen.robot_seconds = round(now, 2)
        seen.ended = seen.ended or now <= self._case.limit


def examiner_of(case: Case) -> Any:
    """The examiner's class for this case."""
    return type("Examiner", (Examiner,), {"case": case})
