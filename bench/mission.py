"""Fetch missions of the real services in one process, judged by physics."""

import time
from dataclasses import dataclass, field
from typing import Any

from common import messages as m
from common import topics
from evaluation.stack import Stack

LIFTED = 0.05


@dataclass
class Outcome:
    """How a mission went, by what the brain said and by what physics says."""

    seed: int
    item: str
    claimed: str = "none"
    reason: str = ""
    on: str = ""
    held: bool = False
    lifted: bool = False
    robot_seconds: float = 0.0
    wall_seconds: float = 0.0
    states: list[str] = field(default_factory=list)

    def delivered(self, goal: str) -> bool:
        """The object was lifted and rests on the goal, let go of."""
        return self.lifted and not self.held and self.on == goal


class Robot(Stack):
    """Every service of the fetch pipeline in one process."""

    def __init__(
        self, scene: str = "apartment", seed: int = 0, settings: tuple[str, ...] = (), log_level: str = "error"
    ) -> None:
        settings = ("brain.pipeline=fetch", *settings)
        super().__init__(scene, seed, settings, without=("planner",), log_level=log_level)


def fetch(robot: Robot, item: str, seed: int, patience: float = 400.0, speech: Any = None) -> Outcome:
    """Ask for an item and step until the brain has reported; `speech` is 16 kHz audio, else the words are typed."""
    outcome = Outcome(seed, item)
    while robot.state().state != "LISTENING":
        robot.tick()
    begin, started = robot.now, time.perf_counter()
    height = robot.truth()["objects"][item]["position"][2]
    if speech is None:
        robot.bus.send(topics.SPEECH_TEXT, m.TypedText(text=f"bring me the {item}"))
    else:
        robot.play(speech)
    body = robot.sim.physics.bodies[item]
    while robot.now - begin < patience:
        robot.advance(0.1)
        outcome.lifted |= bool(robot.sim.physics.data.xpos[body][2] > height + LIFTED)
        state = robot.state()
        if not outcome.states or outcome.states[-1] != state.state:
            outcome.states.append(state.state)
        if state.last is not None and state.state == "LISTENING" and len(outcome.states) > 2:
            outcome.claimed, outcome.reason = state.last.outcome, state.last.reason
            break
    found = robot.truth()
    outcome.on = found["objects"][item]["on"]
    outcome.held = found["objects"][item]["touching_gripper"]
    outcome.robot_seconds = robot.now - begin
    outcome.wall_seconds = time.perf_counter() - started
    return outcome
