"""The examiner takes part in the lockstep like any service: plays the person, watches physics, ends the case."""

from collections import deque
from typing import Any

import numpy as np

from common import messages as m
from common import topics
from common.config import Config
from common.io import Io, Job
from evaluation.case import Case, Line, Observed
from evaluation.effects import Watcher
from evaluation.evidence import Recorder
from evaluation.person import Manner, Person
from evaluation.replica import Replica
from evaluation.shortest import FloorPlan
from evaluation.voice import RATE, Samples, utter

OPEN = ("WAITING", "LISTENING")
OVER = ("COMPLETED", "ERROR")
REACTION, SETTLE, QUIET = 0.5, 2.0, 40.0
WAKE = "hey jarvis, "


class ExaminerConfig(Config, frozen=True):
    """The examiner has no parameters: everything is in the case."""


class Examiner:
    """`done` once the case is over; then `observed` holds what was seen. `examiner_of` gives it its case."""

    NAME = "examiner"
    HZ = 20
    CONFIG = ExaminerConfig
    READS = (topics.SIM_MODEL, topics.SIM_STATE, topics.SIM_STATUS, topics.SPEECH_STATUS, topics.BRAIN_STATE)
    WRITES = (topics.SPEECH_TEXT, topics.AUDIO_PCM, topics.VOICE_COMMAND)
    case: Case

    def __init__(self, config: ExaminerConfig, io: Io) -> None:
        self._case, self._io = self.case, io
        manner: Manner = "reject" if self._case.name == "rejection" else "correct"
        manner = "silent" if self._case.silent else manner
        self._person = Person(self._case.command, self._case.thing, io.scene, manner)
        kinds = {o.name: o.kind for o in io.scene.objects}
        bins = frozenset(r.name for r in io.scene.receptacles if r.depth)
        self._recorder = Recorder(self._case.wants, kinds, bins)
        self._watcher = Watcher(self._case.effects, io.scene)
        self._replica: Replica | None = None
        self._lines = deque(self._case.lines)
        self._due: deque[tuple[float, str]] = deque()
        self._voice: Job[Samples] | None = None
        self._sound: deque[Samples] = deque()
        self._saying = ""
        self._active = False
        self._ended_at: float | None = None
        self._quiet_since = 0.0
        self._when: dict[str, float] = {}
        self._at = self._struck_at = ("", "")
        self.observed = Observed()
        self.done = False

    def step(self, now: float) -> None:
        if self.done:
            return
        self._watch(now)
        self._listen(now)
        if not self._recorder.ready:
            return
        self._follow(now)
        self._talk(now)
        self.done = self._over(now)
        if self.done:
            self._conclude(now)

    # --- physics
    def _watch(self, now: float) -> None:
        io = self._io
        model = io.latest(topics.SIM_MODEL)
        if self._replica is None and model is not None:
            self._replica = Replica(model.mjcf, io.scene)
        if self._replica is None:
            return
        for state in io.drain(topics.SIM_STATE):
            look = self._replica.look(state)
            if not self._recorder.ready:
                errands = [
                    (look.things[w.thing].position[:2], look.things[w.thing].on, w.goals[0]) for w in self._case.wants
                ]
                shortest = FloorPlan(io.scene).mission(look.base, errands)
                self.observed.shortest = round(shortest, 3) if np.isfinite(shortest) else 0.0
            self._recorder.see(look)
            self._watcher.see(look)
        for status in io.drain(topics.SIM_STATUS):
            self.observed.stopped |= status.state == "stopped"

    # --- the robot's words and states
    def _listen(self, now: float) -> None:
        for status in self._io.drain(topics.SPEECH_STATUS):
            if status.state == "speaking" and status.detail != self._saying:
                self._saying = status.detail
                self.observed.said.append(status.detail)
                self._watcher.hear(status.detail)
            elif status.state != "speaking" and self._saying:
                answer, self._saying = self._person.answer(self._saying), ""
                self._quiet_since = now
                if answer:
                    self._due.append((now + REACTION, answer))

    def _follow(self, now: float) -> None:
        seen = self.observed
        for state in self._io.drain(topics.BRAIN_STATE):
            if not seen.states or seen.states[-1] != state.state:
                seen.states.append(state.state)
            self._when.setdefault(state.state, now)
            self._progress(state, now)
            # A brain that has been restarted is IDLE with its mission until it has looked at the world.
            resuming = state.state == "IDLE" and bool(state.mission_id)
            if resuming or state.state not in (*OPEN, *OVER, "IDLE"):
                self._active, self._ended_at = True, None
                seen.stage = seen.stage if resuming else state.state
            elif state.state in (*OPEN, "IDLE") and self._active:
                self._active, self._ended_at = False, now
                self._when.setdefault("ended", now)
            if state.last is not None:
                seen.claimed, seen.reason = state.last.outcome, state.last.reason
            self._quiet_since = now
        if self._when.keys() & set(OPEN):
            self._when.setdefault("ready", now)

    def struck(self, now: float) -> None:
        """A fault hits now; the first counts."""
        if self.observed.struck is None:
            self.observed.struck, self._struck_at = round(now, 2), self._at

    def _progress(self, state: m.BrainState, now: float) -> None:
        """Recovered is a mission that has come to another step than the one in which it was struck."""
        self._at = state.state, state.step
        seen = self.observed
        if seen.struck is None or seen.recovery is not None or state.state == "IDLE":
            return
        if self._at != self._struck_at:
            seen.recovery = round(now - seen.struck, 2)

    # --- the person
    def _talk(self, now: float) -> None:
        while self._lines and self._reached(self._lines[0], now):
            line = self._lines.popleft()
            if line.when == "ended":
                self._person.wish(line.text)
            self._due.append((now, line.text))
        if self._sound:
            self._play(now)
        elif self._voice is not None:
            if self._voice.poll(now):
                samples, self._voice = self._voice.result(), None
                size = RATE // self.HZ
                self._sound.extend(samples[i : i + size] for i in range(0, len(samples), size))
        elif self._due and self._due[0][0] <= now and not self._saying:
            self._say(self._due.popleft()[1], now)

    def _reached(self, line: Line, now: float) -> bool:
        """Lines come one after the other, each at its moment."""
        at = self._when.get(line.when)
        return at is not None and now >= at + line.after

    def _say(self, text: str, now: float) -> None:
        io = self._io
        self._quiet_since, self._ended_at = now, None
        io.log.info("person", says=text)
        # Who speaks first has to get the robot's attention; speech itself hears only what it listens for.
        opening = self._case.wake and not self._active
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
        chunk = m.AudioChunk(t=now, data=part.astype("<i2").tobytes(), rate=RATE, end=not self._sound)
        self._io.publish(topics.AUDIO_PCM, chunk)
        self._quiet_since = now

    # --- the end
    def _over(self, now: float) -> bool:
        if now > self._case.limit:
            return True
        if self._lines or self._due or self._sound or self._voice is not None or self._saying:
            return False
        self.observed.ended = self._ended_at is not None
        if self._ended_at is not None:
            return now >= self._ended_at + SETTLE
        return "ready" in self._when and not self._active and now >= self._quiet_since + QUIET

    def abort(self, now: float, why: str) -> None:
        """The run broke: conclude with what was seen."""
        self.observed.crash = why
        self._conclude(now)

    def _conclude(self, now: float) -> None:
        seen = self.observed
        seen.shown = self._watcher.conclude()
        asked = {w.thing for w in self._case.wants} | {n for e in self._case.effects for n in (e.what, e.other)}
        seen.wrong = sorted(self._watcher.lifted - asked)
        seen.evidence, seen.robot_seconds = self._recorder.conclude(), round(now, 2)
        seen.evidence.disturbed = [n for n in seen.evidence.disturbed if n not in asked]
        seen.ended = seen.ended or now <= self._case.limit


def examiner_of(case: Case) -> Any:
    """The examiner's class for this case."""
    return type("Examiner", (Examiner,), {"case": case})
