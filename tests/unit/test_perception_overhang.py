"""What reaches over the free edge of its surface is measured as a whole; what is beside it is none of its objects."""

import math
from dataclasses import replace

import msgspec
import mujoco
import numpy as np
import pytest

from common.floor_plan import Vec3
from common.furniture_tops import seats
from common.household import Household, load_household, told
from common.rendering.raycast import render
from common.scene import ObjectSpec, load_scene
from services.perception.detect import ClassicalDetector
from services.perception.segments import segmentation
from services.perception.tracking.object_tracker import ObjectTracker
from services.perception.views.view import View
from services.sim.layout import place_objects
from services.sim.world import world_mjcf

WIDTH, HEIGHT, FOVY = 400, 300, 62.0
LENGTH, THICK = 0.16, 0.05


FLAT: Vec3 = (LENGTH, 0.11, THICK)


def seen_with_box(
    over: float, size: Vec3 = FLAT, on: str = "kitchen table"
) -> tuple[View, Household, tuple[float, float, float]]:
    """A table, or a seat, with a flat box that reaches `over` its free edge by so much [m], from before that."""
    plan = load_scene("apartment")
    (top,) = (r for r in (*plan.receptacles, *seats(plan)) if r.name == on)
    x, y, z = top.center
    way = -1 if on == "kitchen table" else 1
    edge = x + way * top.size[0] / 2
    at = (edge - way * (size[0] / 2 - over), y)
    box = ObjectSpec(
        name="box", kind="block", colour="red", size=size, mass=0.2, rgba=(0.8, 0.1, 0.1, 1.0),
        position=at, yaw=0.0, on=on,
    )  # fmt: skip
    scene = msgspec.structs.replace(plan, objects=(box,))
    model = mujoco.MjModel.from_xml_string(world_mjcf(scene, place_objects(scene, 0)))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    position = np.array([edge + way * 0.5, y, 1.3 if way < 0 else 1.0])
    down = math.radians(45)
    # Right, down, ahead of the camera in the map's axes.
    ahead = np.array([-way * math.cos(down), 0.0, -math.sin(down)])
    right = np.array([0.0, float(way), 0.0])
    rotation = np.stack([right, np.cross(ahead, right), ahead], axis=1)
    rgb, depth = render(model, data, position, rotation @ np.diag([1.0, -1.0, -1.0]), FOVY, WIDTH, HEIGHT)
    focal = HEIGHT / 2 / math.tan(math.radians(FOVY) / 2)
    view = View(
        rgb=rgb, depth=depth.astype(np.float32), focal=(focal, focal), middle=(WIDTH / 2, HEIGHT / 2),
        position=position, rotation=rotation,
    )  # fmt: skip
    return view, msgspec.structs.replace(told(scene), things=()), (*at, z + size[2] / 2)


@pytest.mark.parametrize(("over", "low"), [(0.0, 0.0), (0.03, 0.0), (0.07, 0.0), (0.05, 0.008)])
def test_it_is_measured_as_a_whole_though_all_is_seen_lower_than_it_is(over: float, low: float) -> None:
    view, household, at = seen_with_box(over)
    view = replace(view, position=view.position - (0.0, 0.0, low))
    found = [d for d in ClassicalDetector(household, 3.5).detect(view) if d.on == "kitchen table"]
    assert len(found) == 1
    assert math.dist(found[0].position[:2], at[:2]) < 0.012
    assert found[0].size == pytest.approx((LENGTH, 0.11, THICK), abs=0.015)


@pytest.mark.parametrize("over", [0.0, 0.07])
def test_what_reaches_over_the_edge_of_a_seat_is_measured_as_a_whole(over: float) -> None:
    view, household, at = seen_with_box(over, on="sofa seat")
    (found,) = (d for d in ClassicalDetector(household, 3.5).detect(view) if d.on == "sofa seat")
    assert math.dist(found.position[:2], at[:2]) < 0.012
    assert found.size == pytest.approx((LENGTH, 0.11, THICK), abs=0.015)


@pytest.mark.parametrize(("high", "seen"), [(0.33, True), (0.6, False)], ids=["a tall bottle", "a post"])
def test_what_is_slim_and_tall_is_seen_to_its_top(high: float, seen: bool) -> None:
    view, household, at = seen_with_box(-0.1, (0.075, 0.075, high))
    found = [d for d in ClassicalDetector(household, 3.5).detect(view) if d.on == "kitchen table"]
    assert [pytest.approx(high, abs=0.01)] * seen == [d.size[2] for d in found]
    assert all(math.dist(d.position, at) < 0.02 for d in found)


def test_what_stands_beside_the_surface_is_not_on_it() -> None:
    view, household, _ = seen_with_box(LENGTH + 0.02)
    assert segmentation.segments(view, household, 3.5) == []


@pytest.mark.parametrize("hidden", [False, True])
def test_what_was_pulled_to_the_edge_is_still_the_same_object(hidden: bool) -> None:
    """17 cm from where it was, and flat: the table is hardly farther from the camera than its upper side.

    `hidden`: in the first view of it there the arm hides where it was.
    """
    tracker, names = ObjectTracker(load_household("apartment"), 3, 0.5), set()
    for n, over in enumerate((-0.12, -0.12, 0.05, 0.05)):
        view, household, at = seen_with_box(over)
        found = ClassicalDetector(household, 3.5).detect(view)
        if hidden and n == 2:
            view.depth[:] = 0.0
        tracker.update(view, found, float(n))
        if hidden and n == 2:
            continue
        (one,) = tracker.objects()
        assert math.dist(one.position[:2], at[:2]) < 0.012
        names.add((one.id, one.label))
    assert len(names) == 1
