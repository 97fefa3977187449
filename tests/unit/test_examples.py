"""What docs/EXTENDING.md shows."""

import shutil
from math import cos, pi, sin
from pathlib import Path

import mujoco
import numpy as np
import pytest

from common import config, topics
from common import messages as m
from common.household import load_household, load_words, told
from common.kinds import KINDS
from common.plan_rules import known_world
from common.scene import ObjectSpec, load_scene
from examples.odometer import DISTANCE, OdometerConfig, OdometerService
from services.manipulation.grasps.rules import candidates
from services.manipulation.grasps.target import Target
from services.perception.shapes.known import distances
from services.planner.config import PlannerConfig
from services.planner.grammar import grammar
from services.planner.world import believed
from services.sim.objects import geoms
from tests.mission import Robot, fetch
from tests.node import Node

TEA = str(Path(__file__).parents[2] / "examples" / "tea.toml")
RULE = '[[tidy]]\nkinds = ["can"]\ncolours = ["orange"]\nto = ["tea shelf"]\n\n'


def test_the_odometer_adds_up_a_circle() -> None:
    node = Node(OdometerService, OdometerConfig(report_every=0.5), load_household("minimal"))
    for n in range(201):
        a = 2 * pi * n / 200
        node.send(topics.ODOMETRY, m.Odometry(t=n * 0.05, x=cos(a), y=sin(a), theta=0.0))
        node.later(0.05)
        node.run()
    reports = [report.metres for report in node.sent(DISTANCE)]
    assert len(reports) == 12
    assert reports == sorted(reports)
    assert reports[-1] == pytest.approx(6.0, abs=0.1)


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_a_tea_tin_of_ones_own_is_fetched() -> None:
    robot = Robot(TEA, seed=1, settings=("brain.pipeline=fetch",))
    outcome = fetch(robot, "tea tin")
    assert outcome.claimed == "delivered", outcome.reason
    assert outcome.objections == []


def test_a_rule_of_ones_own_says_where_it_goes(tmp_path: Path) -> None:
    directory = tmp_path / "config"
    shutil.copytree(config.DEFAULT_DIR, directory)
    rules = directory / "words.toml"
    rules.write_text(rules.read_text().replace("[[tidy]]\n", f"{RULE}[[tidy]]\n", 1))
    scene = load_scene(TEA)
    spec = scene.object("tea tin")
    assert spec is not None
    tin = m.WorldObject(
        label="tea tin", kind=spec.kind, colour=spec.colour, size=spec.size, on="table", position=(2.2, 0.3, 0.65)
    )
    targets = {}
    for name, where in (("before", config.DEFAULT_DIR), ("after", directory)):
        household = told(scene, load_words(where))
        known = known_world(household, ["tea tin"], "")
        parameters = config.load("planner", PlannerConfig, where, {})
        world = believed(household, known, [tin], (0.0, 0.0, 0.0), 1.0)
        plan = grammar.plan("put the tea tin away", world, parameters, (), None, "r")
        targets[name] = [s.target for s in plan.steps if s.action == "place"]
    assert targets["after"] == ["tea shelf"]
    assert targets["before"] != ["tea shelf"]


USUAL = (0.06, 0.06, 0.1)
SIZES = {"bowl": (0.16, 0.16, 0.07), "apple": (0.07, 0.07, 0.07), "ball": (0.07, 0.07, 0.07)} | dict.fromkeys(
    ("orange", "lemon"), (0.07, 0.07, 0.07)
)


def surface(kind: str) -> np.ndarray:
    """Points (n, 3) of the body that physics has, seen from all around, its underside at height 0."""
    size = SIZES.get(kind, USUAL)
    spec = ObjectSpec(name="x", kind=kind, colour="red", size=size, mass=0.2, rgba=(1.0, 0.0, 0.0, 1.0))
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody><body>{geoms(spec)}</body></worldbody></mujoco>")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    found, geom = [], np.zeros(1, np.int32)
    for azimuth in np.linspace(0.0, 2 * pi, 24, endpoint=False):
        for height in np.linspace(-0.4, 0.4, 9) * size[2]:
            way = -np.array([cos(azimuth), sin(azimuth), 0.0])
            start = np.array([0.0, 0.0, height]) - 0.3 * way
            far = mujoco.mj_ray(model, data, start, way, None, 1, -1, geom)
            if far >= 0:
                found.append(start + far * way + [0.0, 0.0, size[2] / 2])
    return np.array(found)


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_has_a_body_and_the_outline_that_perception_looks_for(kind: str) -> None:
    points = surface(kind)
    assert len(points) > 40
    off = distances(KINDS[kind], SIZES.get(kind, USUAL), points, 0.0, 0.0, 0.0, 0.0)
    # What the outline leaves out, such as a mug's handle, is the smaller part.
    # A bowl's wall is made of flat staves.
    assert np.quantile(off, 0.75) < 0.005, f"physics and perception disagree by {np.quantile(off, 0.75) * 1000:.0f} mm"


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_has_a_grasp_and_round_ones_are_held_from_any_side(kind: str) -> None:
    def held(yaw: float) -> list[list[float]]:
        target = Target(label="x", kind=kind, size=SIZES.get(kind, USUAL), position=(0.6, 0.0, 0.6), yaw=yaw)
        return [g.pose.rotation.ravel().round(6).tolist() for g in candidates(target, forward=0.12, widest=0.076)]

    assert held(0.0)
    if KINDS[kind].shape != "box" and not KINDS[kind].handle:
        assert held(0.0) == held(0.4), "held by its faces, like a block"
