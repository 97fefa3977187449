"""CPU time by service and part, on a clock of the test's own."""

import pkgutil

import pytest

from bench.profile.__main__ import PARTS
from bench.profile.meter import NOBODY, Meter


class Clock:
    """Reading it takes `cost` seconds."""

    def __init__(self, cost: float = 0.0) -> None:
        self.now, self.cost = 0.0, cost

    def __call__(self) -> float:
        self.now += self.cost
        return self.now

    def work(self, seconds: float) -> None:
        self.now += seconds


@pytest.mark.parametrize("cost", [0.0, 1.0])
def test_a_part_is_counted_without_the_parts_it_calls_and_without_the_probes(cost: float) -> None:
    clock = Clock(cost)
    meter = Meter(clock)
    inner = meter.probe(lambda: clock.work(20), "inner")

    def step() -> None:
        clock.work(3)
        inner()
        inner()
        clock.work(4)

    meter.probe(step, "step", "sim")()
    inner()
    found = {("sim", "step"): 7.0, ("sim", "inner"): 40.0, (NOBODY, "inner"): 20.0}
    assert meter.take() == pytest.approx(found)
    assert not meter.take()


def test_what_a_part_raises_passes_and_the_next_one_is_counted_on_its_own() -> None:
    clock = Clock()
    meter = Meter(clock)

    def fails() -> None:
        clock.work(1)
        raise KeyError

    with pytest.raises(KeyError):
        meter.probe(fails, "step", "brain")()
    meter.probe(lambda: clock.work(2), "step", "sim")()
    assert meter.take() == {("brain", "step"): 1.0, ("sim", "step"): 2.0}


@pytest.mark.parametrize("where", PARTS)
def test_every_part_that_is_probed_is_there(where: str) -> None:
    assert callable(pkgutil.resolve_name(where))
