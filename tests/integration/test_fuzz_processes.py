"""A slice of `bench.fuzz`: hostile payloads at real processes, which live on, count, and answer afterwards."""

import pytest

from bench.fuzz.storm import Storm
from common import messages as m
from common import topics
from common.bus import codec, delivery
from evaluation.site import Site, eventually

PAYLOADS = 3000


@pytest.mark.slow  # its storm starves what runs beside it
@pytest.mark.timeout(600)
def test_processes_survive_hostile_payloads_and_still_answer(here: Site) -> None:
    with here.session() as session:
        storm = Storm(here, session, ("sim", "navigation", "brain"), seed=21)
        storm.start(TIDYBOT__RUNTIME__SCENE="minimal")
        storm.learn()
        storm.throw(PAYLOADS, rate=1000.0)
        health = storm.settle()
        assert all(health[name].drops > 20 for name in storm.names)
        assert not storm.troubles()
        storm.recover()
        delivery.send(session, topics.NAVIGATION_GOAL, m.NavigationGoal(goal="goto the moon", id="t.1"))

        def answered() -> bool:
            found = delivery.fetch(session, topics.NAVIGATION_STATUS.key).values()
            return any(codec.decode(topics.NAVIGATION_STATUS, f).code == "UNKNOWN_PLACE" for f in found)

        eventually(answered, "navigation still answers", 120.0)
        truth = delivery.fetch(session, topics.SIM_TRUTH, timeout=20.0)
        assert truth and b"nan" not in next(iter(truth.values())).lower()
        storm.check_alive()
