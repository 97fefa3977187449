"""A brain on the memory bus with hand-driven peers, for the brain's unit tests."""

import itertools
from typing import Any, TypeVar

from common import messages as m
from common import topics
from common.household import load_household
from common.topic import Topic
from services.brain.config import BrainConfig
from services.brain.service import BrainService
from tests.node import Node

M = TypeVar("M", bound=m.Message)
JOINTS = m.JointStates(t=0.0, name=["base_x"], position=[0.0], velocity=[0.0], effort=[0.0])
START = 10_000
"""The first moment [ticks of 10 ms]: 100 s, because nothing may rely on a clock that starts at 0."""
HOME = load_household("apartment")


class Bench(Node):
    """Steps the brain at 20 Hz; `sent(topic)` and `states()` are what peers saw.

    `joints`: what the robot's body reports before every step; None: it is silent.
    """

    def __init__(self, config: BrainConfig | None = None, joints: bool = True) -> None:
        super().__init__(BrainService, config or BrainConfig(pipeline="fetch"), HOME, lockstep=False, tick=START)
        self.brain: BrainService = self.service
        self.joints: m.JointStates | None = JOINTS if joints else None

    def feed(self) -> None:
        if self.joints is not None:
            self.bus.send(topics.JOINT_STATES, self.joints)

    def send(self, topic: Topic[M], message: M) -> None:
        if isinstance(message, m.JointStates):
            self.joints = message
        super().send(topic, message)

    def why(self) -> str:
        return f"state {self.state.state}, step {self.state.step!r}"

    def states(self) -> list[str]:
        """State names in order, repetitions (a new step in the same state) folded."""
        return [name for name, _ in itertools.groupby(s.state for s in self.sent(topics.BRAIN_STATE))]

    @property
    def state(self) -> m.BrainState:
        return self.last(topics.BRAIN_STATE)

    def next_goal(self, topic: Topic[M], count: int, limit: float = 400.0) -> M:
        """The goal number `count` (from 1) on a topic, stepping until it is there."""
        self.until(lambda: self.count(topic) >= count, limit)
        return self.sent(topic)[count - 1]

    @property
    def outcome(self) -> str:
        """How the last mission ended, "" while none has."""
        return self.state.last.outcome if self.state.last is not None else ""

    # --- peers
    def command(self, text: str, **more: Any) -> None:
        """A voice command, and a step with it."""
        self.send(topics.VOICE_COMMAND, m.VoiceCommand(text=text, **more))
        self.step()

    def hear(self, text: str, count: int = 1) -> None:
        """Result the listen goal number `count` with a text."""
        goal = self.next_goal(topics.SPEECH_GOAL, count)
        assert goal.goal == "listen"
        self.send(topics.SPEECH_RESULT, m.SpeechResult(text=text, goal_id=goal.id, attempt=goal.attempt))
        self.step()

    def drove(self, goal: Any, status: m.NavStatus = "arrived", code: str = "") -> None:
        message = m.NavigationStatus(status=status, goal_id=goal.id, attempt=goal.attempt, code=code)
        self.send(topics.NAVIGATION_STATUS, message)
        self.step()

    def did(self, goal: m.ManipulationGoal, status: m.ManipStatus = "done", code: str = "") -> None:
        message = m.ManipulationStatus(status=status, goal_id=goal.id, attempt=goal.attempt, code=code)
        self.send(topics.MANIPULATION_STATUS, message)
        self.step()

    def nav(self, count: int) -> m.NavigationGoal:
        return self.next_goal(topics.NAVIGATION_GOAL, count)

    def manip(self, count: int) -> m.ManipulationGoal:
        return self.next_goal(topics.MANIPULATION_GOAL, count)

    def texts(self, topic: Topic[Any]) -> list[str]:
        return [goal.goal for goal in self.sent(topic)]
