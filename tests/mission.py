"""Fetch missions of the real services in one process, judged as the evaluation judges."""

from dataclasses import dataclass, field
from typing import Any

from common import messages as m
from common import topics
from evaluation.stack import Stack
from evaluation.watch import Watch
from judge.claims import Claim
from judge.evidence import Evidence, Want
from judge.goal import Goal
from judge.observer import WATCH
from judge.verdict import objections

PATIENCE = 400.0
"""Robot time [s] for a mission; chosen."""


@dataclass
class Outcome:
    """How a mission went, by what the brain said and by what physics says."""

    claimed: str = "none"
    reason: str = ""
    evidence: Evidence = field(default_factory=Evidence)
    claims: list[Claim] = field(default_factory=list)
    states: list[str] = field(default_factory=list)

    @property
    def objections(self) -> list[str]:
        """What speaks against a flawless delivery."""
        return objections(self.evidence, self.claims)


class Robot(Stack):
    """Every service of the fetch pipeline in one process, and the judge's watch."""

    def __init__(self, scene: str = "apartment", seed: int = 0, settings: tuple[str, ...] = ()) -> None:
        settings = ("brain.pipeline=fetch", *settings)
        super().__init__(scene, seed, settings, without=("planner",))
        self.watch: Watch = self.join(Watch)

    def play(self, samples: Any) -> None:
        """Put 16 kHz int16 audio (n,) to speech recognition at the pace of robot time."""
        for n, start in enumerate(range(0, len(samples), 1600)):
            data = samples[start : start + 1600].tobytes()
            self.bus.send(topics.AUDIO_PCM, m.AudioChunk(t=self.now, data=data, seq=n))
            self.advance(0.1)


def fetch(robot: Robot, item: str, speech: Any = None) -> Outcome:
    """Ask for an item and step until the brain has reported; `speech` is 16 kHz audio, else the words are typed."""
    outcome = Outcome()
    while robot.state().state != "LISTENING":
        robot.tick()
    begin = robot.now
    goal = Goal((Want(item, (robot.scene.delivery,)),))
    observer = robot.watch.observer
    observer.begin()
    observer.expect(goal)
    if speech is None:
        robot.bus.send(topics.SPEECH_TEXT, m.TypedText(text=f"bring me the {item}"))
    else:
        robot.play(speech)
    while robot.now - begin < PATIENCE:
        robot.advance(0.1)
        state = robot.state()
        if not outcome.states or outcome.states[-1] != state.state:
            outcome.states.append(state.state)
        if state.last is not None and state.state == "LISTENING" and len(outcome.states) > 2:
            outcome.claimed, outcome.reason = state.last.outcome, state.last.reason
            break
    robot.advance(WATCH)
    outcome.evidence, outcome.claims = observer.conclude(goal), observer.claims
    return outcome
