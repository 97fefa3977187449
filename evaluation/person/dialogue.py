"""The simulated user's side of the dialogue: sentences, typed or spoken, and answers to questions."""

import math
import re
from collections import deque
from collections.abc import Mapping, Sequence
from typing import Literal

from common import messages as m
from common import topics
from common.bus.port import Io, Job
from common.floor_plan import Vec3
from common.scene import Scene
from common.sound import RATE, Samples
from evaluation.case import Case
from evaluation.person.ego_noise import EgoNoise
from evaluation.person.voice import loudness, utter
from judge.evidence import Sample
from judge.words import plain

SHOWN, NEAREST = 0.10, 0.05
"""Distance [m] of an object from the place that the robot shows, up to which it is what is seen there, and by how much
any other has to be farther. Chosen: the size of an object, and half of one; between two neighbours one sees neither."""
Manner = Literal["correct", "reject", "silent", "agree"]
PATIENCE = 6
"""Answers that the user gives to one command; chosen: more than the robot may ask."""
CORRECTIONS = ("no, the {}", "no, I said the {}", "the {}")
"""Who was not understood says it in other words."""
_HEARD = re.compile(r"^did you say,?\s*(.+?)\??$", re.IGNORECASE)
_AGAIN = re.compile(r"say (?:it|that) again|please repeat|did not (?:hear|understand|catch)|pardon|what did you", re.I)
_IDENTITY = re.compile(r"(?:is (?:that|this)|which of them is) the .+\?$", re.IGNORECASE)
ORDINALS = ("first", "second", "third", "fourth", "fifth")
_WHICH = re.compile(r"^(?:which\b|do you mean|the .+ or the .+\?)", re.IGNORECASE)
REACTION = 0.5
"""Time [s] until the simulated user answers."""
WAKE = "hey jarvis, "
IDEAL = "sim.sensors=ideal"
"""The setting with which the robot's microphone does not hear the robot."""


class Dialogue:
    """Speaks sentences once the robot is silent; `last` is the robot time [s] at which either side last spoke."""

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
        """True while somebody speaks or is about to."""
        return bool(self._due or self._sound or self._voice is not None or self._saying)

    def hear(self, saying: str, now: float, seen: Sequence[str]) -> None:
        """Take what the robot says, "" for nothing; after a sentence the user, who has `seen` what it shows,
        answers."""
        before, self._saying = self._saying, saying
        if before and not self._saying:
            self.last = now
            if answer := self.user.answer(before, seen):
                self.say(answer, now + REACTION)

    def say(self, text: str, due: float) -> None:
        """Queue a sentence of the user, to be said at robot time `due` [s] at the earliest."""
        self._due.append((due, text))

    def step(self, now: float, opening: bool, speed: float) -> bool:
        """Speak what is due; True when a sentence begins. `opening`: it opens a dialogue; `speed` [m/s]: the base's."""
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


# --- a person with a wish: says it, listens to what the robot says, and answers its questions
class SimulatedUser:
    """Wants `command` done with the world's object `thing`; `called` are the user's words for it, if others.

    Manners: `correct` a wrong question ("no, the <words>"), `reject` it with "no" and repeat when asked, keep `silent`,
    or `agree` to anything.
    """

    def __init__(self, command: str, thing: str, scene: Scene, manner: Manner = "correct", called: str = "") -> None:
        self._command, self._thing, self._scene, self._manner = command, thing, scene, manner
        self._words = called or thing
        self.answers = 0

    def set_goal(self, command: str, thing: str = "") -> None:
        """Note what was said, and meant, from now on; without a `thing` the one that was wanted before."""
        self._command, self.answers = command, 0
        if thing:
            self._thing = self._words = thing

    def answer(self, sentence: str, shown: Sequence[str] = ()) -> str:
        """What to say to a sentence of the robot's; "" for nothing. `shown`: the objects that it shows as it asks."""
        if self._manner == "silent" or self.answers >= PATIENCE:
            return ""
        reply = self._reply(sentence.strip(), shown)
        self.answers += bool(reply)
        return reply

    def _reply(self, sentence: str, shown: Sequence[str]) -> str:
        if heard := _HEARD.match(sentence):
            if self._manner == "agree" or self._same(heard[1]):
                return "yes"
            if self._manner == "correct" and self._only_the_thing_differs(heard[1]):
                return CORRECTIONS[self.answers % len(CORRECTIONS)].format(self._words)
            return "no"
        if _AGAIN.search(sentence):
            return self._command
        if _IDENTITY.search(sentence) and self._thing:
            return "yes" if self._manner == "agree" else choice(self._thing, shown)
        if _WHICH.match(sentence) and self._thing:
            return f"the {self._words}"
        return ""

    def _same(self, heard: str) -> bool:
        return self._canonical(heard) == self._canonical(self._command)

    def _canonical(self, text: str) -> str:
        """A sentence with aliases of objects replaced by their names."""
        words = plain(text)
        for spec in self._scene.objects:
            for alias in sorted(spec.aliases, key=len, reverse=True):
                if " " in alias:
                    words = re.sub(rf"\b{re.escape(plain(alias))}\b", plain(spec.name), words)
        return words

    def _only_the_thing_differs(self, heard: str) -> bool:
        """The robot understood what to do, but with another object."""
        if not self._thing:
            return False
        pattern = re.escape(self._canonical(self._command)).replace(re.escape(plain(self._words)), "(.+)", 1)
        found = re.fullmatch(pattern, self._canonical(heard))
        names = {plain(n) for o in self._scene.objects for n in (o.name, *o.aliases)}
        return found is not None and bool(found.groups()) and found[1] in names


# --- what the person sees of the robot: the object that it shows, and how fast it drives
def seen_at(place: Vec3, objects: Mapping[str, Vec3]) -> str:
    """The object that a person sees at the place that the robot shows them; "" for none."""
    apart = sorted((math.dist(at, place), name) for name, at in objects.items())
    alone = len(apart) == 1 or (len(apart) > 1 and apart[1][0] > apart[0][0] + NEAREST)
    return apart[0][1] if alone and apart[0][0] < SHOWN else ""


def choice(thing: str, shown: Sequence[str]) -> str:
    """The answer of somebody who wants the thing to a question about the object or objects that they are shown."""
    if len(shown) < 2:
        return "yes" if thing in shown else "no"
    return f"the {ORDINALS[shown.index(thing)]} one" if thing in shown else "none of them"


class Onlooker:
    """The user's eyes on the world; `offered` are the places [map] that the robot shows, `shown` the objects seen at
    each, `speed` [m/s] its base's."""

    def __init__(self) -> None:
        self.offered: list[Vec3] = []
        self.shown: list[str] = []
        self.speed = 0.0
        self._was = (0.0, (0.0, 0.0))

    def see(self, t: float, sample: Sample) -> None:
        """Take a sample of the world at robot time `t` [s]."""
        places = {name: o.position for name, o in sample.things.items()}
        self.shown = [seen_at(place, places) for place in self.offered]
        (before, there), here = self._was, sample.base[:2]
        self._was = t, here
        self.speed = math.dist(there, here) / max(t - before, 0.01) if before else 0.0
