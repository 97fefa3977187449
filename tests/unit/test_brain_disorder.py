"""Peers that fail, keep silent, repeat themselves, answer late or for others: what must hold all the same."""

import itertools
import random
from typing import Any

import pytest

from common import messages as m
from common import topics
from services.brain.config import BrainConfig
from tests.unit.brain_bench import Bench

QUICK = {
    "navigation_timeout": 6.0,
    "manipulation_timeout": 6.0,
    "listen_timeout": 6.0,
    "answer_timeout": 6.0,
    "planning_timeout": 4.0,
    "perception_timeout": 4.0,
    "settle": 0.2,
    "speech_retry_delay": 0.5,
}
STEPS = [
    m.PlanStep(action="find", object="red mug"),
    m.PlanStep(action="grasp", object="red mug"),
    m.PlanStep(action="return"),
    m.PlanStep(action="release"),
]


class Disorder:
    """Answers every goal somehow, some time, perhaps twice; keeps the honest record of what was `done` in time."""

    def __init__(self, bench: Bench, seed: int) -> None:
        self.bench, self.random = bench, random.Random(seed)
        self.due: list[tuple[float, Any, m.Message]] = []
        self.read = dict.fromkeys(
            (
                topics.NAVIGATION_GOAL,
                topics.MANIPULATION_GOAL,
                topics.SPEECH_GOAL,
                topics.NAV_GOAL,
                topics.PLAN_REQUEST,
                topics.OBJECT_QUERY,
            ),
            0,
        )
        self.done: list[str] = []

    def step(self) -> None:
        for topic in self.read:
            goals = self.bench.sent(topic)[self.read[topic] :]
            self.read[topic] += len(goals)
            for goal in goals:
                self.answer(topic, goal)
        now = self.bench.now
        for row in [row for row in self.due if row[0] <= now]:
            self.due.remove(row)
            self.bench.send(row[1], row[2])
            self.record(row[2])
        self.bench.step()

    def record(self, message: m.Message) -> None:
        if isinstance(message, m.ManipulationStatus) and message.status == "done":
            self.done.append(message.goal_id)

    def later(self, topic: Any, message: m.Message) -> None:
        pick = self.random.random()
        if pick < 0.08:
            return
        for _ in range(2 if pick > 0.8 else 1):
            self.due.append((self.bench.now + self.random.choice((0.05, 0.3, 1.0, 3.0, 8.0)), topic, message))

    def answer(self, topic: Any, goal: Any) -> None:
        text = getattr(goal, "goal", "")
        good = self.random.random() < 0.85
        name = goal.id if self.random.random() < 0.9 else "somebody.9"
        if topic in (topics.NAVIGATION_GOAL, topics.NAV_GOAL) and text != "stop":
            status: m.NavStatus = "arrived" if good else "failed"
            if topic == topics.NAV_GOAL:
                self.later(topics.NAVIGATION_FEEDBACK, m.NavigationFeedback(status=status, goal_id=name))
            else:
                told = m.NavigationStatus(status=status, goal_id=name, attempt=goal.attempt)
                self.later(topics.NAVIGATION_STATUS, told)
        elif topic == topics.MANIPULATION_GOAL and text != "stop":
            done = m.ManipulationStatus(status="done" if good else "failed", goal_id=name, attempt=goal.attempt)
            self.later(topics.MANIPULATION_STATUS, done)
        elif text == "listen":
            fetch = "bring me the red mug"
            words = self.random.choice(("yes", fetch, fetch, fetch, "ERROR", "no", "bring me the moon"))
            self.later(topics.SPEECH_RESULT, m.SpeechResult(text=words, goal_id=name))
        elif topic == topics.PLAN_REQUEST:
            steps = STEPS if good else STEPS[1:]
            self.later(topics.ACTION_PLAN, m.ActionPlan(request_id=name, steps=steps))
        elif topic == topics.OBJECT_QUERY:
            self.later(topics.OBJECT_POSE, m.ObjectPose(query_id=name, found=good, label="red mug"))


def check(bench: Bench, peers: Disorder) -> int:
    """Delivered missions, each proven by a `done` grab and a `done` release of its own or an earlier grab."""
    grabs = {g.id for g in bench.sent(topics.MANIPULATION_GOAL) if g.goal == "grab"}
    releases = {g.id: g for g in bench.sent(topics.MANIPULATION_GOAL) if g.goal == "release"}
    delivered = {s.last.id for s in bench.sent(topics.BRAIN_STATE) if s.last and s.last.outcome == "delivered"}
    for mission in delivered:
        assert any(d in releases and d.startswith(f"{mission}.") for d in peers.done), mission
    assert len(delivered) <= len(grabs & set(peers.done))
    states = [s.state for s in bench.sent(topics.BRAIN_STATE)]
    for before, after in itertools.pairwise(states):
        assert not (after == "COMPLETED" and before not in ("RELEASING", "COMPLETED")), (before, after)
    return len(delivered)


@pytest.mark.parametrize("pipeline", ["fetch", pytest.param("vla", marks=pytest.mark.slow)])
def test_no_false_success_and_no_standstill(pipeline: Any) -> None:
    delivered = failed = 0
    for seed in range(12 if pipeline == "fetch" else 5):
        bench = Bench(BrainConfig(pipeline=pipeline, **QUICK))
        peers = Disorder(bench, seed)
        for _ in range(5):
            start = bench.now
            while bench.now - start < 400.0:
                peers.step()
                shown = bench.brain.context.display.shown
                if shown.last is not None and shown.last.t > start:
                    failed += shown.last.outcome == "failed"
                    break
                if shown.state == "WAITING" and pipeline == "vla":
                    bench.send(topics.VOICE_COMMAND, m.VoiceCommand(text="bring me the red mug"))
            else:
                pytest.fail("no mission ended in 400 s")
        delivered += check(bench, peers)
    assert delivered > 3 and failed > 3, (delivered, failed)
