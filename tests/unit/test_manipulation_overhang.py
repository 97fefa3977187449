"""What is too wide as it lies is pulled over the edge of its surface and taken from there."""

import math
from dataclasses import replace

import numpy as np
import pytest
from msgspec import structs

from bench.grasp.unlisted import trial
from common.floor_plan import Receptacle
from common.messages import WorldObject
from common.scene import load_scene
from services.manipulation.arm.arm_model import Obstacle
from services.manipulation.config import ManipulationConfig
from services.manipulation.grasps.clearance import PAD, PAD_HALF
from services.manipulation.grasps.grasped_object import attach
from services.manipulation.grasps.over_edge import flat_and_wide, over_an_edge
from services.manipulation.grasps.target import Target
from services.manipulation.planning.edge_spots import INSET, edge_spots
from services.manipulation.planning.motion_planner import PlanError, Planner
from services.manipulation.planning.overhang import LEDGE, LINKS_HALF, PADS_END, plan_pull
from services.manipulation.planning.plan_place import plan_place, plan_placements
from services.manipulation.planning.planning_scene import tilt_of
from services.manipulation.planning.straight_grab import Way, feasible
from services.manipulation.planning.surface_edge import facing_edge
from services.sim.model import own

PLANNER = Planner(own().mjcf, seed=0)
ARM = PLANNER.arm
HEIGHT = 0.6
TABLE = Receptacle(
    name="table", kind="table", center=(0.68, 0.0, HEIGHT), size=(0.6, 1.2), approach=((-1.0, 0.0), (0.0, 1.0))
)
EDGE_AT = 0.38


def slab(edge: float = EDGE_AT) -> Obstacle:
    return Obstacle((edge + 0.3, 0.0, HEIGHT - 0.07), (0.6, 1.2, 0.14))


def box(x: float, yaw: float, thick: float = 0.05) -> Target:
    return Target("box", "box", (x, 0.02, HEIGHT + thick / 2), yaw, (0.16, 0.11, thick), math.pi / 2, "box")


def plate(x: float, tall: float = 0.02) -> Target:
    return Target("plate", "plate", (x, 0.02, HEIGHT + tall / 2), 0.0, (0.18, 0.18, tall), shape="bowl")


def test_what_a_person_calls_a_box_lies_where_a_book_does_not() -> None:
    seen = WorldObject(
        label="green book", kind="book", colour="green", position=(0.5, 0, 0.6), size=(0.19, 0.13, 0.05), shape="box",
        measured=True,
    )  # fmt: skip
    assert tilt_of(seen) == 0.0
    assert tilt_of(structs.replace(seen, kind="box")) == pytest.approx(math.pi / 2)
    assert tilt_of(structs.replace(seen, kind="box", size=(0.13, 0.05, 0.19))) == 0.0


def test_only_flat_things_that_are_too_wide_are_pulled() -> None:
    assert flat_and_wide(box(0.55, 0.0), ARM.widest)
    assert not flat_and_wide(box(0.55, 0.0, thick=0.09), ARM.widest)
    assert flat_and_wide(plate(0.55), ARM.widest)
    assert not flat_and_wide(plate(0.55, tall=0.05), ARM.widest), "its rim is taken from above"


def test_the_edge_is_the_one_that_the_robot_stands_before() -> None:
    edge = facing_edge(TABLE, (0.0, 0.0, 0.0))
    assert edge is not None
    assert edge.outward == pytest.approx([-1.0, 0.0]) and edge.inset(0.5, 0.3) == pytest.approx(0.5 - EDGE_AT)
    beside = facing_edge(TABLE, (0.7, 1.1, -math.pi / 2))
    assert beside is not None and beside.inset(0.0, 0.0) == pytest.approx(-0.5)
    assert facing_edge(TABLE, (0.68, -1.2, math.pi / 2)) is None


@pytest.mark.parametrize("yaw", [0.1, 0.7, -1.2])
def test_it_ends_along_the_edge_as_far_over_it_as_it_stays(yaw: float) -> None:
    edge = facing_edge(TABLE, (0.0, 0.0, 0.0))
    assert edge is not None
    plan = plan_pull(PLANNER, box(0.54, yaw), edge, [slab()], ARM.home.copy(), 0.1)
    x, y, turned = plan.line[-1]
    assert edge.inset(x, y) == pytest.approx(LEDGE, abs=1e-3)
    assert abs(math.remainder(turned, math.pi / 2)) < 0.01 and abs(turned - yaw) < math.pi / 4 + 0.01
    assert len(plan.line) == len(plan.pull)
    # It always moves straight away from the fingers, which are behind it.
    hands = np.array([ARM.pose(q).position for q in plan.pull])
    assert (np.diff(hands[:, 0]) < 1e-3).all()
    assert all(hand[0] > x for hand, (x, _, _) in zip(hands, plan.line, strict=True))


def test_the_pads_alone_meet_what_is_pulled_however_the_hand_leans() -> None:
    edge = facing_edge(TABLE, (0.0, 0.0, 0.0))
    assert edge is not None
    plan = plan_pull(PLANNER, box(0.62, 0.0), edge, [slab()], ARM.home.copy(), 0.1)
    assert ARM.pose(plan.pull[-1]).rotation[2, 2] > -0.97, "it leans"
    lowest = []
    for q in plan.pull:
        hand = ARM.pose(q)
        corners = [(x, 0.0, -PADS_END) for x in (-LINKS_HALF, LINKS_HALF)]
        lowest.append(min(float((hand.position + hand.rotation @ corner)[2]) for corner in corners))
    assert min(lowest) > HEIGHT + 0.05


@pytest.mark.parametrize("thick", [0.015, 0.04])
def test_on_a_surface_as_high_as_the_elbow_a_hand_that_leans_more_pulls(thick: float) -> None:
    top = 0.9
    edge = facing_edge(structs.replace(TABLE, center=(0.68, 0.0, top)), (0.0, 0.0, 0.0))
    assert edge is not None
    lies = Target("bat", "book", (0.5, 0.02, top + thick / 2), 0.2, (0.145, 0.138, thick), shape="box")
    plan = plan_pull(PLANNER, lies, edge, [Obstacle((0.68, 0.0, top - 0.07), (0.6, 1.2, 0.14))], ARM.home.copy(), 0.1)
    for q in plan.pull:
        hand = ARM.pose(q)
        tip = min(float((hand.position + hand.rotation @ (x, 0.0, PAD))[2]) for x in (-PAD_HALF, PAD_HALF))
        assert top < tip < top + thick - 0.002, "no finger is drawn up over it"


def test_what_stands_in_the_way_is_not_pushed_down() -> None:
    edge = facing_edge(TABLE, (0.0, 0.0, 0.0))
    assert edge is not None
    vase = Obstacle((0.43, 0.02, HEIGHT + 0.05), (0.06, 0.06, 0.1), label="vase")
    with pytest.raises(PlanError) as refused:
        plan_pull(PLANNER, box(0.56, 0.0), edge, [slab(), vase], ARM.home.copy(), 0.1)
    assert refused.value.blockers == ("vase",)


def test_a_finger_below_it_has_room_only_over_the_edge() -> None:
    within, over = box(0.80, 0.0), box(0.70, 0.0)
    grasps = over_an_edge(over, ARM.forward, ARM.widest)
    assert grasps and all(g.width == pytest.approx(0.05) and g.over_edge for g in grasps)
    # The hand above its upper end when it stands: that end is where the hand comes from.
    assert all(math.cos(g.axis or 0.0) < 0 for g in grasps if abs(g.pose.rotation[1, 2]) < 0.1)
    for target, reached in ((within, False), (over, True)):
        way = Way([slab(0.68)], False, 0.1, 0.1)
        assert feasible(PLANNER, target, way, ARM.home.copy()) is reached


def test_a_plate_ends_with_its_rim_over_the_edge_and_lies_on_its_foot() -> None:
    edge = facing_edge(TABLE, (0.0, 0.0, 0.0))
    assert edge is not None
    plan = plan_pull(PLANNER, plate(0.60), edge, [slab()], ARM.home.copy(), 0.1)
    inside = edge.inset(*plan.line[-1][:2])
    assert LEDGE <= inside < 0.09 - 0.04
    assert all(abs(math.remainder(at[2], math.tau)) < 0.01 for at in plan.line)


def test_a_finger_below_a_rim_has_room_only_over_the_edge_and_is_drawn_out_when_it_is_put_down() -> None:
    for x, reached in ((0.85, False), (0.73, True)):
        way = Way([slab(0.68)], False, 0.1, 0.1)
        assert feasible(PLANNER, plate(x), way, ARM.home.copy()) is reached
    grasp = over_an_edge(plate(0.73), ARM.forward, ARM.widest)[0]
    held = attach(plate(0.73), grasp)
    assert held.from_below and held.opening is not None and held.opening < ARM.widest / 2
    down = plan_place(PLANNER, held, [(0.6, 0.0)], HEIGHT, 0.004, [slab(0.3)], ARM.home.copy())
    ARM.set_obstacles([slab(0.3)])
    ARM.open_fingers(held.opening)
    assert not any(ARM.collides(q) for q in down.lower)
    ARM.open_fingers()


def test_what_is_held_level_from_below_is_put_down_over_the_edge() -> None:
    edge = facing_edge(TABLE, (0.0, 0.0, 0.0))
    assert edge is not None
    lies = Target("book", "book", (0.66, 0.02, HEIGHT + 0.015), 0.1, (0.19, 0.13, 0.03), shape="box")
    held = attach(lies, over_an_edge(lies, ARM.forward, ARM.widest)[0])
    assert held.level
    with pytest.raises(PlanError):
        plan_place(PLANNER, held, [(0.6, 0.0)], HEIGHT, 0.004, [slab()], ARM.home.copy())
    free = edge_spots(held, edge, [], ARM.forward)
    down = plan_placements(PLANNER, held, free, HEIGHT + 0.004, [slab()], ARM.home.copy())
    assert edge.inset(*down.spot) >= INSET
    ARM.set_obstacles([slab()])
    ARM.open_fingers(held.opening)
    assert not any(ARM.collides(q) for q in (*down.lower, *down.retreat))
    ARM.open_fingers()
    beside = edge_spots(held, edge, [(*down.spot, 0.05)], ARM.forward)
    assert beside and all(math.dist(spot, down.spot) > 0.05 + 0.095 for spot, _ in beside)


def test_what_would_tip_over_the_edge_is_not_put_down_there() -> None:
    edge = facing_edge(TABLE, (0.0, 0.0, 0.0))
    assert edge is not None
    lies = Target("book", "book", (0.66, 0.0, HEIGHT + 0.015), 0.0, (0.13, 0.19, 0.03), shape="box")
    held = attach(lies, over_an_edge(lies, ARM.forward, ARM.widest)[0])
    deep = replace(held, offset=held.offset * (0.4, 1.0, 1.0))
    assert edge_spots(held, edge, [], ARM.forward) and not edge_spots(deep, edge, [], ARM.forward)


@pytest.mark.slow
def test_a_book_is_brought() -> None:
    """In physics: pulled, taken from below, put down over the edge of the tray."""
    assert trial(load_scene("apartment"), "book lying", 64002, ManipulationConfig()) == "ok"


@pytest.mark.slow
def test_a_plate_is_brought() -> None:
    """In physics: pulled until a finger has room below its rim, and put down so that it can come out again."""
    assert trial(load_scene("apartment"), "plate", 0, ManipulationConfig()) == "ok"


@pytest.mark.slow
@pytest.mark.parametrize("seed", [2, 6])
def test_a_flat_box_is_brought_and_stands(seed: int) -> None:
    """In physics: pulled, taken from a stance farther back, put down upright."""
    assert trial(load_scene("apartment"), "carton lying", seed, ManipulationConfig()) == "ok"
