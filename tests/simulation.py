"""The simulation alone on a memory bus."""

import json
from pathlib import Path
from typing import Any

import msgspec

from common import topics
from common.household import told
from common.scene import Scene, load_scene
from common.time.lockstep import DT
from services.sim.config import SimConfig
from services.sim.service import SimService
from tests.node import Node


class Simulation(Node):
    """Physics, drivers and sensors of one scene; `parameters` are fields of `SimConfig`."""

    def __init__(
        self, scene: str | Scene = "minimal", seed: int = 0, state_dir: Path | None = None, **parameters: object
    ) -> None:
        loaded = load_scene(scene) if isinstance(scene, str) else scene
        config = msgspec.convert(parameters, SimConfig)
        super().__init__(SimService, config, told(loaded), world=loaded, seed=seed, state_dir=state_dir, tick=-1)
        self.sim: SimService = self.service
        self.tick = round(self.sim.start_time / DT) - 1

    def truth(self) -> dict[str, Any]:
        """The answer of `sim/truth`."""
        answer: dict[str, Any] = json.loads(self.bus.get(topics.SIM_TRUTH) or b"{}")
        return answer
