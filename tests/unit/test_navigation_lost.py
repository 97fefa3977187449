"""A robot that does not know where it is: switched on elsewhere, carried away, in one of two rooms that look alike."""

import math

import msgspec
import numpy as np
import pytest

from common import messages as m
from common.floor_plan import Place, Wall
from common.geometry import Pose2, Rectangle
from common.household import Household
from services.navigation.localisation.disambiguation import FAR, RAYS, expected_ranges
from services.navigation.localisation.distance_field import distance_field
from services.navigation.localisation.hypotheses import hypotheses, plausibility
from tests.unit.navigation_flat import SCENE, Flat, cast, ends

ELSEWHERE: Pose2 = (4.2, 2.2, 2.0)
ALIKE = ((0.0, 0.0), (4.0, 0.0))
"""Where the two rooms begin."""


def wall(x: float, y: float, to_x: float, to_y: float) -> Wall:
    return Wall(start=(x, y), end=(to_x, to_y))


def twins() -> Household:
    """Two rooms that are the same but for where they are, on a corridor that is longer on one side."""
    walls = [wall(0, 0, 8, 0), wall(0, 0, 0, 5.2), wall(4, 0, 4, 3.5), wall(8, 0, 8, 3.5), wall(0, 5.2, 12, 5.2)]
    walls += [wall(12, 3.5, 12, 5.2), wall(8, 3.5, 12, 3.5)]
    for x, _ in ALIKE:
        walls += [wall(x, 3.5, x + 2.4, 3.5), wall(x + 3.5, 3.5, x + 4, 3.5), wall(x + 1.2, 0, x + 1.2, 1.0)]
    return msgspec.structs.replace(
        SCENE, name="twins", low=(0.0, 0.0), high=(12.0, 5.2), walls=tuple(walls), furniture=(), receptacles=(),
        rooms=(), home=Place(name="home", x=2.2, y=1.6, theta=0.0),
        places=(Place(name="end", x=11.0, y=4.35, theta=0.0),),
    )  # fmt: skip


def off(flat: Flat, x: float, y: float) -> float:
    return math.dist(flat.true[:2], (x, y))


def codes(flat: Flat) -> list[str]:
    return [msgspec.json.decode(f, type=m.NavigationFeedback).code for f in flat.feedbacks]


def test_switched_on_elsewhere_it_finds_itself_and_goes_where_it_is_sent() -> None:
    flat = Flat(initial_pose="unknown")
    flat.true = ELSEWHERE
    flat.step()
    flat.ask("return_to_start")
    assert flat.finish(60.0).status == "arrived"
    assert off(flat, 0.0, 0.0) < 0.05


def test_carried_away_on_its_way_it_says_so_and_arrives_all_the_same() -> None:
    flat = Flat()
    flat.step()
    flat.ask("goto kitchen")
    for _ in range(40):
        flat.step()
    flat.true = ELSEWHERE
    assert flat.finish(90.0).status == "arrived"
    assert "LOST" in codes(flat)
    place = next(p for p in SCENE.places if p.name == "kitchen")
    assert off(flat, place.x, place.y) < 0.05


def test_where_two_rooms_look_alike_it_drives_to_where_they_differ() -> None:
    plan = twins()
    flat = Flat(household=plan, initial_pose="unknown")
    flat.true = (6.2, 1.6, 0.4)
    flat.step()
    for _ in range(60):
        flat.step()
    state = flat.service.state
    assert state.lost and len(state.everywhere.hypotheses) == 2
    flat.ask("goto end")
    assert flat.finish(120.0).status == "arrived"
    assert off(flat, 11.0, 4.35) < 0.05 and flat.closest > 0.35


def test_a_map_of_another_home_is_called_that() -> None:
    rng = np.random.default_rng(2)
    crowd = [Rectangle(*rng.uniform(-2.0, 2.0, 2), 0.5, 0.5, 0.3) for _ in range(40)]
    crowd = [box for box in crowd if box.distance(0.0, 0.0) > 0.6]
    flat = Flat(boxes=crowd, lost_patience=3.0)
    flat.step()
    flat.ask("goto kitchen")
    status = flat.finish(60.0)
    assert (status.status, status.code) == ("failed", "MAP_MISMATCH")
    assert "MAP_MISMATCH" in codes(flat)


def test_a_ray_through_a_wall_counts_against_a_pose() -> None:
    plan = twins()
    field = distance_field(plan, 0.2)
    points = ends(cast((10.0, 4.3, 0.0), [w.footprint for w in plan.walls]))
    right, wrong = (plausibility(field, pose, points) for pose in ((10.0, 4.3, 0.0), (2.0, 2.0, 0.0)))
    assert right > 0.95 and wrong < 0.3
    assert plausibility(field, (4.0, 2.0, 0.0), points) == -1.0, "it does not stand in a wall"


def test_both_of_two_equal_rooms_are_hypotheses() -> None:
    plan = twins()
    points = ends(cast((2.2, 1.6, 0.3), [w.footprint for w in plan.walls]))
    found = hypotheses(distance_field(plan, 0.2), points, plan.low, plan.high)
    assert sorted(h.pose[0] for h in found[:2]) == pytest.approx([2.2, 6.2], abs=0.02)
    assert abs(found[0].score - found[1].score) < 0.05


def test_expected_ranges_are_those_of_the_plan() -> None:
    plan = twins()
    pose = (10.0, 4.3, 0.5)
    found = expected_ranges(distance_field(plan, 0.2), np.array([pose]))[0]
    true = np.minimum(cast(pose, [w.footprint for w in plan.walls]), FAR)
    # The lidar of the flat starts behind the robot, ours ahead.
    assert found == pytest.approx(np.roll(true, 180)[:: 360 // RAYS], abs=0.1)
