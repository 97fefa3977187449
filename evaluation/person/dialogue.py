"""The person's side of the conversation with the robot: sentences typed or by voice, and answers to questions."""

from collections import deque

from common import messages as m
from common import topics
from common.bus.port import Io, Job
from evaluation.case import Case
from evaluation.person.ego_noise import EgoNoise
from evaluation.person.simulated_user import Manner, SimulatedUser
from evaluation.person.voice import RATE, Samples, loudness, utter

REACTION = 0.5
"""Time [s] until the simulated user answers."""
WAKE = "hey jarvis, "
IDEAL = "sim.sensors=ideal"
"""The setting with which the robot's microphone does not hear the robot."""


class Dialogue:
    """Sentences wait in `say` until the robot is silent; `last` is when [s of robot time] either side last spoke."""

    def __init__(self, case: Case, io: Io, hz: int) -> None:
        self._case, self._io, self._chunk = case, io, RATE // hz
        manner: Manner = "silent" if case.silent else "reject" if case.name == "rejection" else "correct"
        self.user = SimulatedUser(case.command, case.thing, io.world, manner, case.called)
        self._due: deque[tuple[float, str]] = deque()
        self._voice: Job[Samples] | None = None
        self._sound: deque[Samples] = deque()
        self._ego: EgoNoise | None = None
        self._saying = ""
        self.last = 0.0

    @property
    def busy(self) -> bool:
        """Somebody speaks, or is about to."""
        return bool(self._due or self._sound or self._voice is not None or self._saying)

    def hear(self, saying: str, now: float, seen: str) -> None:
        """What the robot says, "" for nothing; at the end of a sentence the person, who has `seen` what it shows,
        answers."""
        before, self._saying = self._saying, saying
        if before and not self._saying:
            self.last = now
            if answer := self.user.answer(before, seen):
                self.say(answer, now + REACTION)

    def say(self, text: str, due: float) -> None:
        """Have the person say it, at robot time `due` [s] at the earliest."""
        self._due.append((due, text))

    def step(self, now: float, opening: bool, speed: float) -> bool:
        """Speak; True when a sentence begins. `opening`: it opens a dialogue; `speed` [m/s] of the robot beside."""
        if self._sound:
            self._play(now, speed)
        elif self._voice is not None:
            if self._voice.poll(now):
                samples, self._voice = self._voice.result(), None
                if self._ego is None and IDEAL not in self._case.settings:
                    self._ego = EgoNoise(self._case.seed, loudness(samples))
                self._sound.extend(samples[i : i + self._chunk] for i in range(0, len(samples), self._chunk))
        elif self._due and self._due[0][0] <= now and not self._saying:
            self._begin(self._due.popleft()[1], opening, now)
            return True
        return False

    def _begin(self, text: str, opening: bool, now: float) -> None:
        io, case = self._io, self._case
        self.last = now
        io.log.info("person", says=text)
        # Who speaks first has to get the robot's attention; speech itself hears only what it listens for.
        opening = opening and case.wake
        if case.spoken:
            words = WAKE + text if opening else text
            self._voice = io.submit(utter, words, case.noise, case.seed, case.speaker, seconds=0.2)
        elif opening:
            io.publish(topics.VOICE_COMMAND, m.VoiceCommand(text=text, id=io.new_id("typed")))
        else:
            io.publish(topics.SPEECH_TEXT, m.TypedText(text=text))

    def _play(self, now: float, speed: float) -> None:
        part = self._sound.popleft()
        if self._ego is not None:
            part = self._ego.over(part, speed)
        chunk = m.AudioChunk(t=now, data=part.astype("<i2").tobytes(), rate=RATE, end=not self._sound)
        self._io.publish(topics.AUDIO_PCM, chunk)
        self.last = now
