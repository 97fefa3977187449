"""The evaluation's second look at the world agrees with the simulation's own truth; and the lengths of ways."""

import math
from pathlib import Path
from typing import Any

import pytest

from common import messages as m
from common import topics
from common.bus import codec
from common.scene import load_scene
from evaluation.shortest import ShortestPaths
from judge.evidence import Evidence, Sample
from judge.goal import Goal
from judge.observer import Observer, Replica
from services.sim.truth import report
from tests.simulation import Simulation

APARTMENT = load_scene("apartment")


class World(Simulation):
    """The simulation and its replica."""

    def __init__(self, scene: str, seed: int) -> None:
        super().__init__(scene, seed)
        self.replica = Replica(self.last(topics.SIM_MODEL).mjcf, self.io.world)

    def look(self) -> Sample:
        self.step(0.05)
        return self.replica.sample(self.last(topics.SIM_STATE))


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


class Watched(Simulation):
    """The simulation with an observer that gets what an evaluator gets."""

    def __init__(self, scene: str = "minimal", **more: Any) -> None:
        super().__init__(scene, 0, **more)
        self.observer = Observer(self.io.world)
        self.observer.model(self.last(topics.SIM_MODEL))

    def watch(self, seconds: float) -> Evidence:
        for _ in range(round(seconds / 0.05)):
            self.step(0.05)
            self.observer.world(self.last(topics.SIM_STATE))
        for said in self.sent(topics.SIM_CONTACTS):
            self.observer.contacts(said)
        return self.observer.conclude(Goal())

    def move(self, name: str, position: tuple[float, float, float], velocity: tuple[float, float, float]) -> None:
        """Put an object somewhere, upright, on its way."""
        physics = self.sim.physics
        joint = physics.model.joint(name.replace(" ", "_"))
        at, rate = joint.qposadr[0], joint.dofadr[0]
        physics.data.qpos[at : at + 7] = (*position, 1.0, 0.0, 0.0, 0.0)
        physics.data.qvel[rate : rate + 3] = velocity


def test_a_robot_that_drives_into_furniture_has_hit_it() -> None:
    world = Watched()
    assert world.watch(0.5).hits == []
    world.bus.send(topics.BASE_TARGET, m.BaseTarget(x=2.6, y=0.0, theta=0.0, id="a"))
    found = world.watch(7.0)
    assert found.hits and all(" on delivery tray" in hit for hit in found.hits)
    touches = world.sim.physics.contacts.touches
    worst = max(touches, key=lambda t: t.force)
    assert worst.force > 65.0 and worst.impulse > 0.0 and worst.kind == "furniture" and worst.depth > 0.0
    assert worst.seconds <= worst.last - worst.first + 0.0051, "counted in steps of up to 5 ms"


def test_what_another_object_knocks_over_is_disturbed() -> None:
    """The robot touches neither: a can slides into a bottle, and the bottle goes over."""
    world = Watched("apartment")
    table = next(r for r in world.io.world.receptacles if r.kind == "table")
    x, y, z = table.center
    world.move("green can", (x - 0.12, y, z + 0.06), (0.0, 0.0, 0.0))
    world.move("blue bottle", (x, y, z + 0.107), (0.0, 0.0, 0.0))
    world.watch(0.5)
    world.observer.begin()
    assert world.watch(0.5).disturbed == []
    world.move("green can", (x - 0.12, y, z + 0.06), (1.5, 0.0, 0.0))
    found = world.watch(2.0)
    assert {"green can", "blue bottle"} <= set(found.disturbed) and found.hits == []


def test_an_arm_on_its_own_base_is_a_hit_and_the_log_outlives_the_process(tmp_path: Path) -> None:
    world = Watched(state_dir=tmp_path, run="one")
    home = world.sim.physics.home_arm
    assert world.watch(0.5).touches == [], "at home the robot does not touch itself"
    folded = [home[0], 0.9, *home[2:]]
    for n in range(100):
        share = min(1.0, n / 60)
        aim = [a + share * (b - a) for a, b in zip(home, folded, strict=True)]
        world.bus.send(topics.ARM_COMMAND, m.ArmCommand(position=aim, period=0.05))
        world.watch(0.05)
    found = world.watch(0.5)
    touches = world.sim.physics.contacts.touches
    assert {t.kind for t in touches} == {"self"} and max(t.force for t in touches) > 10.0
    assert found.hits
    after = Simulation("minimal", 0, state_dir=tmp_path, run="one")
    kept = after.sim.physics.contacts.touches
    assert kept and [t.part for t in kept] == [t.part for t in touches][: len(kept)]
    assert after.truth()["contacts"][0]["kind"] == "self"


def test_a_state_of_another_model_is_refused() -> None:
    world = World("minimal", 0)
    world.look()
    state = codec.decode(topics.SIM_STATE, world.bus.last["sim/state"])
    state.qpos = state.qpos[:-8]
    with pytest.raises(ValueError, match="does not fit"):
        world.replica.sample(state)


def test_lengths_of_ways() -> None:
    plan = ShortestPaths(APARTMENT)
    straight = plan.length((0.0, 0.0), [(0.9, -1.4)])
    assert straight == pytest.approx(math.hypot(0.9, 1.4), abs=0.08)
    kitchen = plan.length((0.0, 0.0), [(3.6, -1.2)])
    assert math.hypot(3.6, 1.2) - 0.05 < kitchen < 1.15 * math.hypot(3.6, 1.2)
    behind_the_wall = plan.length((1.9, 0.8), [(3.1, 0.4)])
    assert behind_the_wall > 2.0 * math.hypot(1.2, 0.4)
    assert plan.length((0.0, 0.0), [(9.0, -1.4), (0.9, -1.4)]) <= straight


def test_the_best_order_of_errands() -> None:
    plan = ShortestPaths(APARTMENT)
    near, far = ((-1.5, -2.1), "living table", "toy box"), ((4.45, -3.0), "counter", "bin")
    both = plan.mission((0.0, 0.0, 0.0), [near, far])
    assert both == pytest.approx(plan.mission((0.0, 0.0, 0.0), [far, near]))
    assert both > plan.mission((0.0, 0.0, 0.0), [near])
    assert plan.mission((0.0, 0.0, 0.0), []) == 0.0
