"""A tiny real service for tests of the bus and the runtime: `python -m tests.fakes`."""

from common import messages as m
from common import topics
from common.bus.port import Io
from common.config import Config
from common.runtime import main


class EchoConfig(Config, frozen=True):
    word: str = "arrived"
    fail_on: str = "raise"


class EchoService:
    """Answers every navigation goal with a status, raises on one word."""

    NAME = "echo"
    HZ = 100
    CONFIG = EchoConfig
    READS = (topics.NAVIGATION_GOAL, topics.JOINT_STATES, topics.BRAIN_STATE)
    WRITES = (topics.NAVIGATION_STATUS,)

    def __init__(self, config: EchoConfig, io: Io) -> None:
        self._config, self._io = config, io

    def step(self, now: float) -> None:
        self._io.latest(topics.JOINT_STATES)
        for goal in self._io.take_all(topics.NAVIGATION_GOAL):
            if goal.goal == self._config.fail_on:
                raise RuntimeError("asked to fail")
            detail = f"{goal.goal} at {now:.2f}"
            status = m.NavigationStatus(
                status="arrived", goal_id=goal.id or self._io.new_id("echo"), attempt=goal.attempt, detail=detail
            )
            self._io.publish(topics.NAVIGATION_STATUS, status)


if __name__ == "__main__":
    main(EchoService)
