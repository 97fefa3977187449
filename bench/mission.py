"""A whole robot in one process: the real services on the in-memory bus in lockstep, judged by physics."""

import json
import time
from dataclasses import dataclass, field
from typing import Any

import msgspec
import numpy as np

from common import config, topics
from common import messages as m
from common.clock import ManualClock
from common.lockstep import DT, InProcess
from common.memory import MemoryBus, MemoryIo
from common.scene import Scene, load_scene
from services.brain.service import BrainService
from services.manipulation.service import ManipulationService
from services.navigation.service import NavigationService
from services.sim.service import SimService
from services.speech.service import SpeechService

SERVICES: tuple[Any, ...] = (NavigationService, ManipulationService, SpeechService, BrainService)
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


class Robot:
    """Every service of the fetch pipeline in one process."""

    def __init__(
        self, scene: str = "apartment", seed: int = 0, settings: tuple[str, ...] = (), log_level: str = "error"
    ) -> None:
        self.scene: Scene = load_scene(scene)
        self.bus, clock = MemoryBus(), ManualClock()
        changes = config.overrides({}, settings)

        def make(kind: Any) -> tuple[Any, MemoryIo]:
            parameters = config.load(kind.NAME, kind.CONFIG, config.config_dir(), changes)
            io = MemoryIo(
                self.bus, kind.NAME, kind.READS, kind.WRITES, scene=self.scene, seed=seed, clock=clock,
                log_level=log_level,
            )  # fmt: skip
            if kind is SimService:
                io.out_stamp = -1
            return kind(parameters, io), io

        self.sim, sim_io = make(SimService)
        self.world = InProcess(self.sim, sim_io, clock)
        for kind in SERVICES:
            self.world.add(*make(kind))

    def state(self) -> m.BrainState:
        """What the brain says it does."""
        return msgspec.json.decode(self.bus.last[topics.BRAIN_STATE.key], type=m.BrainState)

    def truth(self) -> dict[str, Any]:
        """The answer of sim/truth."""
        found: dict[str, Any] = json.loads(self.bus.get(topics.SIM_TRUTH) or b"{}")
        return found

    def advance(self, seconds: float) -> None:
        for _ in range(round(seconds / DT)):
            self.world.advance()

    def play(self, samples: "np.ndarray[Any, np.dtype[np.int16]]") -> None:
        """Put 16 kHz audio into the robot's ear at robot-time rate."""
        for n, start in enumerate(range(0, len(samples), 1600)):
            data = samples[start : start + 1600].tobytes()
            self.bus.send(topics.AUDIO_PCM, m.AudioChunk(t=self.world.clock.now(), data=data, seq=n))
            self.advance(0.1)


def fetch(robot: Robot, item: str, seed: int, patience: float = 400.0, speech: Any = None) -> Outcome:
    """Ask for an item and step until the brain has reported; `speech` is 16 kHz audio, else the words are typed."""
    outcome = Outcome(seed, item)
    started = time.perf_counter()
    while robot.state().state != "LISTENING":
        robot.world.advance()
    begin = robot.world.clock.now()
    height = robot.truth()["objects"][item]["position"][2]
    if speech is None:
        robot.bus.send(topics.SPEECH_TEXT, m.TypedText(text=f"bring me the {item}"))
    else:
        robot.play(speech)
    body = robot.sim.physics.bodies[item]
    while robot.world.clock.now() - begin < patience:
        for _ in range(10):
            robot.world.advance()
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
    outcome.robot_seconds = robot.world.clock.now() - begin
    outcome.wall_seconds = time.perf_counter() - started
    return outcome
