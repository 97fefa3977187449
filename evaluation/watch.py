"""A participant that feeds the judge's observer, for benchmarks and tests that drive the robot themselves."""

from common import topics
from common.bus.port import Io
from common.config import Config
from judge.evidence import Sample
from judge.observer import Observer


class Watch:
    """Feeds an `Observer` with what the simulation and the robot publish, at 20 Hz."""

    NAME = "watch"
    HZ = 20
    CONFIG = Config
    KNOWS_WORLD = True
    READS = (
        topics.SIM_MODEL, topics.SIM_STATE, topics.SIM_CONTACTS, topics.SPEECH_STATUS, topics.BRAIN_STATE,
        topics.SYSTEM_STATUS,
    )  # fmt: skip
    WRITES = ()

    def __init__(self, config: Config, io: Io) -> None:
        self._io = io
        self.observer = Observer(io.world)

    def step(self, now: float) -> None:
        io, observer = self._io, self.observer
        observe(io, observer)
        if not observer.ready:
            return
        for said in io.take_all(topics.SPEECH_STATUS):
            observer.speech(now, said)
        for status in io.take_all(topics.SYSTEM_STATUS):
            observer.status(now, status)
        for state in io.take_all(topics.BRAIN_STATE):
            observer.brain(now, state)


def observe(io: Io, observer: Observer) -> list[tuple[float, Sample]]:
    """Feed an observer with the newest states of the world; returns its samples, none before the model is known."""
    if (model := io.latest(topics.SIM_MODEL)) is None:
        return []
    observer.model(model)
    states = io.take_all(topics.SIM_STATE)
    samples = [(state.t, sample) for state in states if (sample := observer.world(state)) is not None]
    for report in io.take_all(topics.SIM_CONTACTS):
        observer.contacts(report)
    return samples
