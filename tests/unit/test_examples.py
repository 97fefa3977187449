"""What docs/EXTENDING.md shows."""

import shutil
from math import cos, pi, sin
from pathlib import Path
from typing import get_args

import pytest

from bench.mission import Robot, fetch
from common import codec, config, topics
from common import messages as m
from common.memory import MemoryBus, MemoryIo
from common.scene import ObjectKind, ObjectSpec, load_scene
from examples.odometer import DISTANCE, OdometerConfig, OdometerService
from services.brain.validate import known_world
from services.manipulation.grasp import Target, candidates
from services.perception.shapes import profile
from services.planner import grammar
from services.planner.config import PlannerConfig
from services.planner.world import believed
from services.sim.objects import geoms

TEA = str(Path(__file__).parents[2] / "examples" / "tea.toml")
RULE = '[[tidy]]\nkinds = ["can"]\ncolours = ["orange"]\nto = ["tea shelf"]\n\n'


def test_the_odometer_adds_up_a_circle() -> None:
    bus = MemoryBus()
    reads, writes = OdometerService.READS, OdometerService.WRITES
    io = MemoryIo(bus, "odometer", reads, writes, scene=load_scene("minimal"))
    told = bus.tap(DISTANCE)
    service = OdometerService(OdometerConfig(report_every=0.5), io)
    for n in range(201):
        a = 2 * pi * n / 200
        bus.send(topics.ODOMETRY, m.Odometry(t=n * 0.05, x=cos(a), y=sin(a), theta=0.0))
        io.begin(n + 1, n * 0.05)
        service.step(n * 0.05)
    reports = [codec.decode(DISTANCE, payload).metres for payload in told]
    assert len(reports) == 12
    assert reports == sorted(reports)
    assert reports[-1] == pytest.approx(6.0, abs=0.1)


@pytest.mark.timeout(600)
def test_a_tea_tin_of_ones_own_is_fetched() -> None:
    robot = Robot(TEA, seed=1, settings=("brain.pipeline=fetch",))
    outcome = fetch(robot, "tea tin", 1)
    assert outcome.claimed == "delivered", outcome.reason
    assert outcome.delivered("delivery tray")


def test_a_rule_of_ones_own_says_where_it_goes(tmp_path: Path) -> None:
    directory = tmp_path / "config"
    shutil.copytree(config.DEFAULT_DIR, directory)
    rules = directory / "planner.toml"
    rules.write_text(rules.read_text().replace("[[tidy]]\n", f"{RULE}[[tidy]]\n", 1))
    scene = load_scene(TEA)
    spec = scene.object("tea tin")
    assert spec is not None
    tin = m.WorldObject(
        label="tea tin", kind=spec.kind, colour=spec.colour, size=spec.size, on="table", position=(2.2, 0.3, 0.65)
    )
    told = known_world(scene, ["tea tin"], "")
    targets = {}
    for name, where in (("before", config.DEFAULT_DIR), ("after", directory)):
        parameters = config.load("planner", PlannerConfig, where, {})
        world = believed(scene, told, [tin], (0.0, 0.0, 0.0), 1.0)
        plan = grammar.plan("put the tea tin away", world, parameters, (), None, "r")
        targets[name] = [s.target for s in plan.steps if s.action == "place"]
    assert targets["after"] == ["tea shelf"]
    assert targets["before"] != ["tea shelf"]


@pytest.mark.parametrize("kind", get_args(ObjectKind))
def test_every_kind_has_a_body_a_grasp_and_a_shape(kind: ObjectKind) -> None:
    size = (0.06, 0.06, 0.1)
    spec = ObjectSpec(name="x", kind=kind, colour="red", size=size, mass=0.2, rgba=(1.0, 0.0, 0.0, 1.0))
    assert "<geom" in geoms(spec)
    target = Target(label="x", kind=kind, size=size, position=(0.6, 0.0, 0.6), yaw=0.0)
    assert candidates(target, forward=0.12, widest=0.076)
    if kind not in ("box", "block"):
        assert profile(kind, size)
