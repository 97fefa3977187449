"""The examiner takes part in the lockstep like any service: plays the person, watches physics, ends the case."""

import math
from collections import deque
from typing import Any

import numpy as np

from common import messages as m
from common import topics
from common.bus.port import Io, Job
from common.config import Config
from evaluation.case import Case, Line, Observed
from evaluation.faults.reports import FaultReport
from evaluation.person.ego_noise import EgoNoise
from evaluation.person.simulated_user import Manner, SimulatedUser, seen_at
from evaluation.person.voice import RATE, Samples, loudness, utter
from evaluation.shortest import FloorPlan
from judge.evidence import Sample
from judge.observer import WATCH, Observer

OPEN = ("WAITING", "LISTENING")
OVER = ("COMPLETED", "ERROR")
REACTION, QUIET = 0.5, 40.0
"""Time [s] until the simulated user answers, and of quiet after which a case without an outcome is over."""
WAKE = "hey jarvis, "
IDEAL = "sim.sensors=ideal"
"""The setting with which the robot's microphone does not hear the robot."""


class ExaminerConfig(Config, frozen=True):
    """The examiner has no parameters: everything is in the case."""


class Examiner:
    """`done` once the case is over; then `observed` holds what was seen. `examiner_of` gives it its case."""

    NAME = "examiner"
    HZ = 20
    CONFIG = ExaminerConfig
    KNOWS_WORLD = True
    READS = (
        topics.SIM_MODEL, topics.SIM_STATE, topics.SIM_STATUS, topics.SPEECH_STATUS, topics.BRAIN_STATE,
        topics.SYSTEM_STATUS, topics.SIM_CONTACTS,
    )  # fmt: skip
    WRITES = (topics.SPEECH_TEXT, topics.AUDIO_PCM, topics.VOICE_COMMAND)
    case: Case

    def __init__(self, config: ExaminerConfig, io: Io) -> None:
        self._case, self._io = self.case, io
        manner: Manner = "reject" if self._case.name == "rejection" else "correct"
        manner = "silent" if self._case.silent else manner
        self._user = SimulatedUser(self._case.command, self._case.thing, io.world, manner, self._case.called)
        self._observer = Observer(io.world)
        self._begun = False
        self._lines = deque(self._case.lines)
        self._line: Line | None = None
        self._due: deque[tuple[float, str]] = deque()
        self._voice: Job[Samples] | None = None
        self._sound: deque[Samples] = deque()
        self._ego: EgoNoise | None = None
        self._speed, self._was = 0.0, (0.0, (0.0, 0.0))
        self._about: tuple[float, float, float] | None = None
        self._seen = ""
        self._saying = ""
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
        self._watch(now)
        self._listen(now)
        if not self._observer.ready:
            return
        self.follow(now)
        self._talk(now)
        self.done = self._over(now)
        if self.done:
            self._conclude(now)

    # --- physics
    def _watch(self, now: float) -> None:
        io, observer = self._io, self._observer
        if (model := io.latest(topics.SIM_MODEL)) is None:
            return
        observer.model(model)
        for state in io.take_all(topics.SIM_STATE):
            first = not observer.ready
            sample = observer.world(state)
            if sample is not None:
                self._seen = seen_at(self._about, {name: o.position for name, o in sample.things.items()})
                before, there = self._was
                self._was = state.t, sample.base[:2]
                self._speed = math.dist(there, sample.base[:2]) / max(state.t - before, 0.01) if before else 0.0
            if first and sample is not None:
                self.observed.shortest = self._shortest(sample)
        for report in io.take_all(topics.SIM_CONTACTS):
            observer.contacts(report)
        for status in io.take_all(topics.SIM_STATUS):
            self.observed.stopped |= status.state == "stopped"

    def _shortest(self, sample: Sample) -> float:
        """The shortest way [m] of a base that makes all deliveries; 0 where there is none."""
        wants = self._case.wants
        deliveries = [(sample.things[w.thing].position[:2], sample.things[w.thing].on, w.goals[0]) for w in wants]
        found = FloorPlan(self._io.world).mission(sample.base, deliveries)
        return round(found, 3) if np.isfinite(found) else 0.0

    # --- the robot's words and states
    def _listen(self, now: float) -> None:
        for status in self._io.take_all(topics.SPEECH_STATUS):
            if status.state == "speaking" and status.detail != self._saying:
                self._saying = status.detail
                self.observed.said.append(status.detail)
                self._observer.sentence(now, status.detail)
            elif status.state != "speaking" and self._saying:
                answer, self._saying = self._user.answer(self._saying, self._seen), ""
                self._quiet_since = now
                if answer:
                    self._due.append((now + REACTION, answer))

    def follow(self, now: float) -> None:
        """Take what the brain says of its mission."""
        seen = self.observed
        for status in self._io.take_all(topics.SYSTEM_STATUS):
            self._observer.status(now, status)
        for state in self._io.take_all(topics.BRAIN_STATE):
            self._observer.brain(now, state)
            self._about = state.about
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
        """A fault took effect; the first starts the clock of the recovery."""
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
            self._line = line = self._lines.popleft()
            if line.when == "ended":
                self._user.set_goal(line.text, line.thing)
                # The next one waits for the end of this one's mission.
                del self._when["ended"]
            if not self._begun:
                self._begun = True
                self._observer.begin()
            self._observer.expect(self._case.goal_of(line))
            self._due.append((now, line.text))
        if self._sound:
            self._play(now)
        elif self._voice is not None:
            if self._voice.poll(now):
                samples, self._voice = self._voice.result(), None
                size = RATE // self.HZ
                if self._ego is None and IDEAL not in self._case.settings:
                    self._ego = EgoNoise(self._case.seed, loudness(samples))
                self._sound.extend(samples[i : i + size] for i in range(0, len(samples), size))
        elif self._due and self._due[0][0] <= now and not self._saying:
            self._say(self._due.popleft()[1], now)

    def _note_mission(self) -> None:
        """The mission of the last line is over: what is not as it wants it."""
        if self._case.explores and self._line is not None and self._line.goal is not None:
            self.observed.missions.append((self._line.text, self._observer.shortfall(self._line.goal)))

    def _reached(self, line: Line, now: float) -> bool:
        """Lines come one after the other, each at its moment."""
        at = self._when.get(line.when)
        return at is not None and now >= at + line.after

    def _say(self, text: str, now: float) -> None:
        io = self._io
        self._quiet_since, self._ended_at = now, None
        io.log.info("person", says=text)
        # Who speaks first has to get the robot's attention; speech itself hears only what it listens for.
        opening = self._case.wake and not self.active
        if not self._case.spoken and opening:
            io.publish(topics.VOICE_COMMAND, m.VoiceCommand(text=text, id=io.new_id("typed")))
            return
        if not self._case.spoken:
            io.publish(topics.SPEECH_TEXT, m.TypedText(text=text))
            return
        words = WAKE + text if opening else text
        self._voice = io.submit(utter, words, self._case.noise, self._case.seed, self._case.speaker, seconds=0.2)

    def _play(self, now: float) -> None:
        part = self._sound.popleft()
        if self._ego is not None:
            part = self._ego.over(part, self._speed)
        chunk = m.AudioChunk(t=now, data=part.astype("<i2").tobytes(), rate=RATE, end=not self._sound)
        self._io.publish(topics.AUDIO_PCM, chunk)
        self._quiet_since = now

    # --- the end
    def _over(self, now: float) -> bool:
        if now > self._case.limit:
            return True
        quiet = "ready" in self._when and not self.active and now >= self._quiet_since + QUIET
        if self._lines or self._due or self._sound or self._voice is not None or self._saying:
            if quiet and self._begun:
                # What was said has led to no mission.
                self._when.setdefault("ended", now)
            return False
        self.observed.ended = self._ended_at is not None
        if self._ended_at is not None:
            return now >= self._ended_at + WATCH
        return quiet

    def abort(self, now: float, why: str) -> None:
        """The run broke: conclude with what was seen."""
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
