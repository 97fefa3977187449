"""The evaluation's second look at the world agrees with the simulation's own truth; and the lengths of ways."""

import math

import pytest

from common import codec, topics
from common.scene import load_scene
from evaluation.shortest import FloorPlan
from judge.evidence import Look
from judge.replica import Replica
from services.sim.truth import report
from tests.simulation import Simulation

APARTMENT = load_scene("apartment")


class World(Simulation):
    """The simulation and its replica."""

    def __init__(self, scene: str, seed: int) -> None:
        super().__init__(scene, seed)
        self.replica = Replica(self.last(topics.SIM_MODEL).mjcf, self.io.scene)

    def look(self) -> Look:
        self.step(0.05)
        return self.replica.look(self.last(topics.SIM_STATE))


@pytest.mark.parametrize("seed", [0, 5])
def test_the_replica_sees_what_is_so(seed: int) -> None:
    world = World("apartment", seed)
    look = world.look()
    truth = report(world.sim.physics, 0.0, "")
    for name, thing in look.things.items():
        assert math.dist(thing.position, truth["objects"][name]["position"]) < 1e-6
        assert thing.on == truth["objects"][name]["on"] != ""
        assert not thing.held and not thing.touched
        assert thing.tilt < 0.02
    assert look.base == pytest.approx(truth["base"])
    assert look.hits == ()


def test_a_robot_in_the_furniture_is_noticed() -> None:
    world = World("minimal", 0)
    data, at = world.sim.physics.data, world.sim.physics.qpos_at
    world.look()
    data.qpos[at[0]] = 2.0
    state = codec.decode(topics.SIM_STATE, world.bus.last["sim/state"])
    state.qpos = data.qpos.tobytes()
    hits = world.replica.look(state).hits
    assert {thing for _, thing, _ in hits} & {"table", "table leg 0", "table leg 1", "table leg 2", "table leg 3"}
    assert all(depth > 0 for *_, depth in hits)


def test_a_state_of_another_model_is_refused() -> None:
    world = World("minimal", 0)
    world.look()
    state = codec.decode(topics.SIM_STATE, world.bus.last["sim/state"])
    state.qpos = state.qpos[:-8]
    with pytest.raises(ValueError, match="does not fit"):
        world.replica.look(state)


def test_lengths_of_ways() -> None:
    plan = FloorPlan(APARTMENT)
    straight = plan.length((0.0, 0.0), [(0.9, -1.4)])
    assert straight == pytest.approx(math.hypot(0.9, 1.4), abs=0.08)
    kitchen = plan.length((0.0, 0.0), [(3.6, -1.2)])
    assert math.hypot(3.6, 1.2) - 0.05 < kitchen < 1.15 * math.hypot(3.6, 1.2)
    behind_the_wall = plan.length((1.9, 0.8), [(3.1, 0.4)])
    assert behind_the_wall > 2.0 * math.hypot(1.2, 0.4)
    assert plan.length((0.0, 0.0), [(9.0, -1.4), (0.9, -1.4)]) <= straight


def test_the_best_order_of_errands() -> None:
    plan = FloorPlan(APARTMENT)
    near, far = ((-1.5, -2.1), "living table", "toy box"), ((4.45, -3.0), "counter", "bin")
    both = plan.mission((0.0, 0.0, 0.0), [near, far])
    assert both == pytest.approx(plan.mission((0.0, 0.0, 0.0), [far, near]))
    assert both > plan.mission((0.0, 0.0, 0.0), [near])
    assert plan.mission((0.0, 0.0, 0.0), []) == 0.0
