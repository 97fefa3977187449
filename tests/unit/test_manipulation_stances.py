"""From where else an object is in reach, and what is too wide from anywhere."""

import math

import numpy as np
import pytest
from msgspec import structs

from bench.grasp.hand import Bench
from common import messages as m
from common.approach import ROOM, clearance
from common.geometry import compose, inverse
from common.household import told
from common.scene import load_scene
from services.manipulation.arm.arm_model import Obstacle
from services.manipulation.config import ManipulationConfig
from services.manipulation.grasps.target import Target
from services.manipulation.planning.motion_planner import PlanError, Planner
from services.manipulation.planning.plan_grab import plan_grab, refine
from services.manipulation.planning.planning_scene import obstacles, target_of
from services.manipulation.planning.stances import MOST, SAME, STAND_OFFS, other_stance, stances
from services.manipulation.planning.straight_grab import SHORTER
from services.sim.model import own

PLANNER = Planner(own().mjcf, seed=0)
HOME = told(load_scene("apartment"))
TABLE = next(r for r in HOME.receptacles if r.name == "kitchen table")
CONFIG = ManipulationConfig()
REST = PLANNER.arm.home.copy()


def bottle(u: float, v: float) -> m.WorldObject:
    """A bottle at a place of the table's own frame."""
    x, y = TABLE.outline.to_map(u, v)
    at = (x, y, TABLE.center[2] + 0.11)
    return m.WorldObject("bottle", "bottle", "green", at, size=(0.066, 0.066, 0.22), on=TABLE.name)


def plan(found: m.WorldObject, base: tuple[float, float, float], *others: m.WorldObject) -> None:
    around = [obstacles(HOME, base, others)]
    plan_grab(
        PLANNER, target_of(found, base, HOME), around, REST, CONFIG.approach_distance, CONFIG.lift_height,
        CONFIG.reach, frozenset(), [],
    )  # fmt: skip


def test_what_is_out_of_reach_from_here_is_in_reach_from_the_stance_that_is_told() -> None:
    ax, ay = TABLE.approach[0]
    edge = TABLE.size[0] / 2 if ax else TABLE.size[1] / 2
    found = bottle(ax * (edge - 0.12), ay * (edge - 0.12))
    far = TABLE.outline.to_map(ax * (edge + 1.1), ay * (edge + 1.1))
    theta = math.atan2(found.position[1] - far[1], found.position[0] - far[0])
    base = (*far, theta)
    with pytest.raises(PlanError):
        plan(found, base)
    told = [base]
    stance = other_stance(
        PLANNER, HOME, found, [found], told, REST, CONFIG.approach_distance, CONFIG.lift_height, CONFIG.reach
    )
    assert stance is not None
    assert clearance(HOME, *stance[:2]) >= ROOM
    dx, dy, _ = compose(inverse(base), stance)
    assert math.hypot(dx, dy) > SAME, "another one than where it stands"
    plan(found, stance)


def test_a_stance_that_was_told_before_is_not_told_again() -> None:
    ax, ay = TABLE.approach[0]
    edge = TABLE.size[0] / 2 if ax else TABLE.size[1] / 2
    found, told = bottle(ax * (edge - 0.12), ay * (edge - 0.12)), [(0.0, 0.0, 0.0)]
    for _ in range(2):
        stance = other_stance(
            PLANNER, HOME, found, [found], told, REST, CONFIG.approach_distance, CONFIG.lift_height, CONFIG.reach
        )
        assert stance is not None
        assert all(math.dist(stance[:2], other[:2]) > SAME or stance[2] != other[2] for other in told)
        told.append(stance)


def test_a_side_with_room_for_one_base_is_a_side_to_stand_before() -> None:
    ax, ay = TABLE.approach[0]
    narrow = [structs.replace(r, approach=((-ax, -ay),)) if r is TABLE else r for r in HOME.receptacles]
    home = structs.replace(HOME, receptacles=tuple(narrow))
    edge = TABLE.size[0] / 2 if ax else TABLE.size[1] / 2
    found = bottle(ax * (edge - 0.12), ay * (edge - 0.12))
    offered = [TABLE.outline.to_local(*pose[:2]) for pose in stances(home, found, [(0.0, 0.0, 0.0)], [0.55])[:6]]
    sides = [u * ax + v * ay > edge for u, v in offered]
    assert any(sides) and not all(sides), "before both sides, by turns"


def test_at_the_end_of_the_reach_shorter_straight_ways_will_do() -> None:
    """A mug too wide for the fingers on a high shelf is taken by its rim, with 6 cm instead of 10 in and up."""
    mug = Target("mug", "mug", (0.535, 0.0, 0.8386), 2.0, (0.078, 0.078, 0.087), shape="round", measured=True)
    shelf = Obstacle((0.535, 0.0, 0.725), (0.32, 0.88, 0.14))
    made = plan_grab(
        PLANNER, mug, [[shelf]], REST, CONFIG.approach_distance, CONFIG.lift_height, CONFIG.reach, frozenset(), []
    )
    risen = PLANNER.arm.pose(made.lift[-1]).position - made.grasp.pose.position
    come = PLANNER.arm.pose(made.insert[0]).position - made.grasp.pose.position
    assert made.grasp.rim
    assert min(np.linalg.norm(come), risen[2]) == pytest.approx(SHORTER[-1] * CONFIG.lift_height, abs=4e-3)
    moved = refine(PLANNER, made, (0.01, 0.0))
    again = PLANNER.arm.pose(moved.insert[0]).position - moved.grasp.pose.position
    assert np.linalg.norm(again - come) < 4e-3, "corrected, it is as short"


def test_where_nothing_reaches_it_no_stance_is_told() -> None:
    high = m.WorldObject("lamp", "box", "white", (*TABLE.center[:2], 2.1), size=(0.05, 0.05, 0.1))
    args = ([high], [(0.0, 0.0, 0.0)], REST, CONFIG.approach_distance, CONFIG.lift_height, CONFIG.reach)
    assert other_stance(PLANNER, HOME, high, *args) is None


def test_grasps_are_looked_for_once_on_each_side(monkeypatch: pytest.MonkeyPatch) -> None:
    """From no stance is there one, and every one is looked at."""
    looked: list[Target] = []
    monkeypatch.setattr(PLANNER, "candidates", lambda target: looked.append(target) or [])  # type: ignore[func-returns-value]
    found, args = bottle(0.0, 0.0), (CONFIG.approach_distance, CONFIG.lift_height, 1.2)
    assert other_stance(PLANNER, HOME, found, [found], [(0.0, 0.0, 0.0)], REST, *args) is None
    offered = stances(HOME, found, [(0.0, 0.0, 0.0)], STAND_OFFS)[:MOST]
    assert 1 <= len(looked) <= 4 < len(offered)


@pytest.mark.parametrize(
    ("size", "spread", "code"),
    [
        ((0.12, 0.15, 0.2), 0.002, "TOO_WIDE"), ((0.079, 0.09, 0.2), 0.004, "UNREACHABLE"),
        ((0.12, 0.15, 0.2), 0.02, "UNREACHABLE"),
    ],
)  # fmt: skip
def test_too_wide_is_said_before_a_try_where_the_measures_are_certain(
    size: tuple[float, float, float], spread: float, code: str
) -> None:
    crate = Target("crate", "", (0.6, 0.0, 0.6 + size[2] / 2), 0.2, size, shape="box", spread=spread, measured=True)
    with pytest.raises(PlanError) as failed:
        plan_grab(PLANNER, crate, [[]], REST, 0.1, 0.1, 1.0, frozenset(), [])
    assert failed.value.code == code
    if code == "TOO_WIDE":
        assert "120 x 150 x 200 mm" in str(failed.value)


def test_the_status_tells_the_stance() -> None:
    scene = load_scene("apartment")
    bench = Bench(scene, next(o for o in scene.objects if o.kind == "can"), 0.6, 3, CONFIG)
    x, y, _ = bench.sim.physics.placements[0].position
    bench.stand((x - 1.3, y, 0.0))
    status = bench.run("grab", "far")
    assert (status.status, status.code) == ("failed", "UNREACHABLE")
    assert status.stance is not None and math.dist(status.stance[:2], (x, y)) < 0.8
    assert "within reach from" in status.detail
