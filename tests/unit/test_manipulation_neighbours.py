"""A neighbour in the way is put elsewhere, and the object grasped then: in real physics."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from msgspec.structs import replace

from bench.grasp.hand import Bench
from common import messages as m
from common import topics
from common.geometry import yaw_quat
from common.scene import ObjectSpec, body_name, load_scene
from services.manipulation.config import ManipulationConfig
from services.manipulation.execution import neighbours
from services.manipulation.execution.robot import Failure, Robot, Steps

GREY = (0.5, 0.5, 0.5, 1.0)
BOX = ObjectSpec(name="thin box", kind="box", colour="grey", size=(0.05, 0.05, 0.12), mass=0.1, rgba=GREY)
POSTS = tuple(
    ObjectSpec(name=f"post {n}", kind="box", colour="grey", size=(0.05, 0.05, 0.2), mass=0.2, rgba=GREY)
    for n in range(4)
)
GAP = 0.045


def crowd(gap: float, posts: tuple[ObjectSpec, ...] = POSTS) -> tuple[Bench, m.WorldObjects]:
    """A box with a taller one before each of its faces."""
    bench = Bench(load_scene("apartment"), BOX, 0.6, 3, ManipulationConfig(), others=posts, known=False)
    placed = bench.sim.physics.placements[0]
    x, y, z = placed.position
    table = z - BOX.size[2] / 2
    physics = bench.sim.physics
    objects = []
    for n, spec in enumerate((BOX, *posts)):
        far, bearing = (0.05 + gap if n else 0.0), placed.yaw + n * math.pi / 2
        at = (x + far * math.cos(bearing), y + far * math.sin(bearing), table + spec.size[2] / 2 + 0.001)
        start = physics.model.jnt_qposadr[physics.model.body(body_name(spec)).jntadr[0]]
        physics.data.qpos[start : start + 7] = (*at, *yaw_quat(placed.yaw))
        told = m.WorldObject(label=spec.name, kind="", colour="grey", position=at, size=spec.size, on=placed.on)
        objects.append(replace(told, orientation=yaw_quat(placed.yaw), shape="box", measured=True, spread=0.001))
    bench.rest(0.3)
    bench.stand(bench.before_it(np.random.default_rng(0)))
    known = m.WorldObjects(t=0.0, objects=objects)
    bench.bus.send(topics.WORLD_OBJECTS, known)
    return bench, known


def reference(found: m.WorldObject) -> m.ObjectRef:
    return m.ObjectRef(
        label=found.label, position=found.position, orientation=found.orientation, size=found.size, shape=found.shape
    )


@pytest.mark.slow
def test_a_neighbour_in_the_way_is_put_elsewhere_first() -> None:
    bench, known = crowd(GAP)
    status = bench.run("grab", "g", reference(known.objects[0]), patience=120.0)
    assert status.status == "done", status.detail
    assert "was put elsewhere first" in status.detail
    truth = bench.truth()
    assert truth["holding"] == BOX.name
    moved = [
        p.name
        for p, told in zip(POSTS, known.objects[1:], strict=True)
        if math.dist(truth["objects"][p.name]["position"][:2], told.position[:2]) > 0.05
    ]
    assert moved and all(name in status.detail for name in moved), "what was moved is told"
    for post in POSTS:
        found = truth["objects"][post.name]
        assert found["on"] == known.objects[1].on
        _, x, y, _ = found["quaternion"]
        assert 1 - 2 * (x * x + y * y) > 0.98, "it stands"


def test_with_room_nothing_is_moved() -> None:
    bench, known = crowd(0.1, POSTS[1:2])
    status = bench.run("grab", "g", reference(known.objects[0]), patience=60.0)
    assert status.status == "done" and "elsewhere" not in status.detail


@pytest.mark.slow
def test_a_neighbour_that_finds_no_place_is_put_back_where_it_stood(monkeypatch: pytest.MonkeyPatch) -> None:
    def no_room(robot: Robot, where: str, away_from: str = "") -> Steps[str]:
        raise Failure("UNREACHABLE", "cannot put it there")
        yield

    monkeypatch.setattr(neighbours, "place", no_room)
    bench, known = crowd(GAP)
    before = {name: thing["position"] for name, thing in bench.truth()["objects"].items()}
    status = bench.run("grab", "g", reference(known.objects[0]), patience=120.0)
    assert (status.status, status.code) == ("failed", "UNREACHABLE")
    assert status.blockers
    bench.rest(0.5)
    truth = bench.truth()
    assert truth["holding"] is None, "the next grab finds an empty hand"
    for name, thing in truth["objects"].items():
        assert math.dist(thing["position"], before[name]) < 0.02
        assert abs(thing["quaternion"][1]) + abs(thing["quaternion"][2]) < 0.05, "it stands"


def test_a_neighbour_that_is_not_known_any_more_stays_in_the_way() -> None:
    robot: Any = SimpleNamespace(source=SimpleNamespace(objects=list))
    goal = m.ManipulationGoal(goal="grab")
    with pytest.raises(Failure, match="in the way: post 1"):
        next(neighbours._put_elsewhere(robot, goal, "post 1", Failure("UNREACHABLE", "in the way: post 1")))
