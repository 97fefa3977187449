"""A brain on the memory bus with hand-driven peers, for the brain's unit tests."""

import itertools
from collections.abc import Callable
from typing import Any, TypeVar

from common import codec, topics
from common import messages as m
from common.memory import MemoryBus, MemoryIo
from common.scene import load_scene
from common.topics import Topic
from services.brain.config import BrainConfig
from services.brain.service import BrainService

M = TypeVar("M", bound=m.Message)
JOINTS = m.JointStates(t=0.0, name=["base_x"], position=[0.0], velocity=[0.0], effort=[0.0])
PERIOD = 0.05


class Bench:
    """Steps the brain at 20 Hz; `goals(topic)` and `states()` are what peers saw."""

    def __init__(self, config: BrainConfig | None = None, joints: bool = True) -> None:
        self.bus = MemoryBus()
        self.now = 100.0
        self._taps = {t.key: self.bus.tap(t) for t in BrainService.WRITES}
        self._decoded: dict[str, list[Any]] = {}
        scene = load_scene("apartment")
        self.io = MemoryIo(
            self.bus, "brain", BrainService.READS, BrainService.WRITES, scene=scene, lockstep=False, log_level="error"
        )
        self.brain = BrainService(config or BrainConfig(pipeline="fetch"), self.io)
        if joints:
            self.send(topics.JOINT_STATES, JOINTS)

    def send(self, topic: Topic[M], message: M) -> None:
        self.bus.send(topic, message)

    def step(self, seconds: float = PERIOD) -> None:
        for _ in range(max(1, round(seconds / PERIOD))):
            self.now += PERIOD
            self.io.begin(None, self.now)
            self.brain.step(self.now)

    def until(self, probe: Callable[[], Any], limit: float = 400.0) -> float:
        """Step until the probe holds; returns the robot seconds that took."""
        start = self.now
        while not probe():
            assert self.now - start < limit, f"state {self.state.state}, step {self.state.step!r}"
            self.step()
        return self.now - start

    def sent(self, topic: Topic[M]) -> list[M]:
        decoded = self._decoded.setdefault(topic.key, [])
        decoded += [codec.decode(topic, payload) for payload in self._taps[topic.key][len(decoded) :]]
        return decoded.copy()

    def states(self) -> list[str]:
        """State names in order, repetitions (a new step in the same state) folded."""
        return [name for name, _ in itertools.groupby(s.state for s in self.sent(topics.BRAIN_STATE))]

    @property
    def state(self) -> m.BrainState:
        last: m.BrainState = codec.decode(topics.BRAIN_STATE, self._taps[topics.BRAIN_STATE.key][-1])
        return last

    def next_goal(self, topic: Topic[M], count: int, limit: float = 400.0) -> M:
        """The goal number `count` (from 1) on a topic, stepping until it is there."""
        self.until(lambda: len(self._taps[topic.key]) >= count, limit)
        return self.sent(topic)[count - 1]

    # --- peers
    def hear(self, text: str, count: int = 1) -> None:
        """Answer the listen goal number `count` with a text."""
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
