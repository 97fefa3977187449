"""Drawn homes: the same for a seed, all of it within the robot's reach, and such that files carry them."""

from functools import cache
from pathlib import Path

import msgspec
import pytest

from common.approach import EDGE_DISTANCE, FOOTPRINT, STAND_OFF, poses_for
from common.files.plan_file import to_toml
from common.floor_plan import Box
from common.scene import Scene, load_scene
from evaluation.homes.aged import LIGHT
from evaluation.homes.home import draw_home
from evaluation.homes.new import new
from evaluation.homes.rooms import NoHome
from evaluation.homes.suite import aged, homes
from evaluation.suites.blocks import flat
from evaluation.suites.unknown import too_high
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner
from services.sim.layout import place_objects

OBJECTS = flat().objects[:6]
HIGH_BLOCK = 41311
"""Of a new home in which a block stands higher than the arm takes blocks from."""
SMALL = 72101
"""Of an aged home of which the robot reaches nothing that is more than a step away from its start."""
DRAWN = range(12)
"""Seeds of the homes that every test looks at."""


@cache
def drawn(seed: int) -> Scene:
    return draw_home(seed, OBJECTS)


def test_a_seed_draws_the_same_home_again_and_another_seed_another() -> None:
    assert draw_home(3, OBJECTS) == drawn(3)
    assert len({(h.low, h.high) for h in map(drawn, DRAWN)}) == len(DRAWN)


@pytest.mark.parametrize("rooms", range(1, 7))
def test_a_home_has_as_many_rooms_as_asked_for(rooms: int) -> None:
    home = draw_home(40 + rooms, OBJECTS, rooms)
    named = [p.name for p in home.places if p.name != "corridor"]
    assert len(named) == rooms == len(set(named)) and "living room" in named
    # Of an irregular home two of them are one room.
    assert {r.name for r in home.rooms} <= {p.name for p in home.places} and len(home.rooms) >= len(home.places) - 1


def test_an_irregular_home_is_an_l_with_an_l_of_a_room_and_rugs_that_are_in_no_ones_way() -> None:
    home = draw_home(14, OBJECTS)
    outside = [(x, y) for x in (home.low[0] + 0.3, home.high[0] - 0.3) for y in (home.low[1] + 0.3, home.high[1] - 0.3)]
    first = next(r for r in home.rooms if r.name == "living room")
    free = [p for p in outside if all(r is first or not r.contains(*p) for r in home.rooms)]
    planner = PathPlanner(Costmap(home, 0.05, 1.0), FOOTPRINT + 0.02, 0.65)
    field = planner.field(0.0, 0.0)
    assert free and any(planner.cost_to(field, p) == float("inf") for p in free), "a corner is no part of it"
    parts = [p for p in home.places if home.room_at(p.x, p.y) == first]
    assert len(parts) == 2, "the living room is two in one"
    rugs = [b for b in home.furniture if "rug" in b.name]
    assert rugs and not any(r.outline in home.footprints for r in rugs)


@pytest.mark.parametrize("seed", DRAWN)
def test_navigation_reaches_every_room_and_every_surface(seed: int) -> None:
    home = drawn(seed)
    costmap = Costmap(home, 0.05, 1.0)
    planner = PathPlanner(costmap, FOOTPRINT + 0.02, 0.65)
    assert costmap.clearance(0.0, 0.0) > FOOTPRINT + 0.1, "the robot starts there"
    spots = [[(p.x, p.y)] for p in home.places]
    for r in home.receptacles:
        poses = poses_for((r.center[0], r.center[1]), r, STAND_OFF, EDGE_DISTANCE)
        spots.append([(pose[0], pose[1]) for _, pose in poses])
    for choices in spots:
        assert planner.possible((0.0, 0.0), choices), choices


@pytest.mark.parametrize("seed", DRAWN[:6])
def test_nothing_stands_in_anything_else(seed: int) -> None:
    home = drawn(seed)
    outlines = [r.outline for r in home.receptacles]
    outlines += [b.outline for b in home.standing if not b.name.startswith("chair") and not b.name.endswith("back")]
    for i, a in enumerate(outlines):
        for b in outlines[i + 1 :]:
            corners = [a.to_map(u * a.length / 2, v * a.width / 2) for u in (-1, 0, 1) for v in (-1, 0, 1)]
            assert not any(b.contains(*c, margin=-0.03) for c in corners), (a, b)


def test_a_home_is_read_again_from_its_file_and_its_things_find_a_place(tmp_path: Path) -> None:
    home = homes(5).scene
    assert home is not None
    path = tmp_path / "home.toml"
    path.write_text(to_toml(home))
    assert load_scene(str(path)) == home
    assert len(place_objects(home, 5)) == len(home.objects) >= 5


def test_too_many_rooms_for_a_home_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("evaluation.homes.home.DRAWS", 0)
    with pytest.raises(NoHome, match="no home of 3 rooms"):
        draw_home(0, OBJECTS, 3)


def test_nobody_walks_about_where_there_is_no_room_beside_the_robot() -> None:
    world = aged(SMALL).scene
    assert world is not None and not any(o.social for o in world.obstacles)


def test_what_people_carry_about_is_gone_from_an_aged_home_and_still_on_its_map() -> None:
    gone: set[str] = set()
    for seed in (3, 4, 5):
        case = aged(seed)
        assert case.scene is not None and case.household is not None
        here, known = ({b.name for b in plan.furniture} for plan in (case.scene, case.household))
        assert here <= known
        gone |= known - here
    assert gone and all(name.startswith(LIGHT) for name in gone)


@pytest.mark.parametrize("seed", range(4))
def test_an_aged_home_has_what_its_map_has_not_and_the_robot_still_gets_about(seed: int) -> None:
    case = aged(seed)
    assert case.scene is not None and case.household is not None and case.scene.obstacles
    standing = [o for o in case.scene.obstacles if not o.path]
    people = [o for o in case.scene.obstacles if o.path]
    assert people and all(p.social and len(p.path) > 1 for p in people)
    boxes = tuple(Box(name=o.name, center=(*o.position, 0.3), size=o.size, yaw=o.yaw) for o in standing)
    costmap = Costmap(msgspec.structs.replace(case.scene, furniture=case.scene.furniture + boxes), 0.05, 1.0)
    planner = PathPlanner(costmap, FOOTPRINT + 0.02, 0.65)
    assert all(planner.possible((0.0, 0.0), [(p.x, p.y)]) for p in case.scene.places)
    for person in people:
        assert min(costmap.clearance(*point) for point in (person.position, *person.path)) > 0.2


def test_what_stands_too_high_for_its_kind_is_to_be_reported_and_never_asked_for_in_a_new_home() -> None:
    reported = homes(41011)
    assert reported.thing == "white bowl" and reported.expect == "reported"
    assert reported.scene is not None and too_high(reported.scene, 41011) >= {"white bowl"}
    assert homes(41015).expect == "delivered", "a ball is taken from there"
    case = new(HIGH_BLOCK)
    assert case.scene is not None
    unreached = too_high(case.scene, case.seed)
    assert unreached and not unreached & {want.thing for want in case.wants}


def test_a_home_with_little_room_has_fewer_things() -> None:
    case = homes(41057)
    assert case.scene is not None and 3 <= len(case.scene.objects) < 10


def test_what_is_taken_to_a_room_may_stand_on_any_top_there() -> None:
    case = new(41305)
    assert case.scene is not None and case.lines[-1].text == "take the black can to the bathroom"
    (goals,) = [want.goals for want in case.wants if case.scene.delivery not in want.goals]
    assert {"washstand"} < {*goals} <= {"washstand", "washing machine", "bath", "laundry basket"}
