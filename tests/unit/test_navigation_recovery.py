import itertools
import math

import msgspec
import numpy as np
import pytest

from common import messages as m
from common import topics
from common.bus.memory import MemoryIo
from common.floor_plan import Box, FloorPlan, Place, Room, Wall
from common.geometry import Rectangle
from common.household import Household, load_household, mapped
from common.robot.joints import ARM
from common.viewpoints import viewpoints_of
from services.navigation.config import NavigationConfig
from services.navigation.localisation.distance_field import rectangles
from services.navigation.motion.arm_load import PRESSING, ArmLoad
from services.navigation.motion.collision_avoidance import avoid
from services.navigation.motion.contacts import STOPPED
from services.navigation.motion.obstacle_tracker import Obstacle, ObstacleTracker, clusters
from services.navigation.motion.progress import (
    HELD_UP,
    LATER,
    MEETINGS,
    PASSING,
    STANDOFF,
    BlockedTimer,
    Progress,
    Standoff,
    anybody_near,
    waiting_for,
)
from services.navigation.motion.retreat import passing_place
from services.navigation.motion.route import Route
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner
from services.navigation.planning.seen_cells import SETTLED
from tests.unit.navigation_flat import ANGLES, SCENE, Flat, cast

KITCHEN_DOOR = (2.5, -0.75, 0.4, 0.9, 0.0)
STUDY_DOOR = (-0.45, 2.0, 0.9, 0.4, 0.0)
STUDY_DOOR_SHUT = Rectangle(*STUDY_DOOR)
CHASSIS = 0.30


def doings(flat: Flat) -> list[str]:
    found = [msgspec.json.decode(f, type=m.NavigationFeedback).code for f in flat.feedbacks]
    return [code for n, code in enumerate(found) if code and code not in found[:n]]


def test_a_box_in_the_door_is_driven_around_by_the_other_doors() -> None:
    flat = Flat([KITCHEN_DOOR])
    flat.ask("goto kitchen")
    assert flat.finish(120.0).status == "arrived"
    assert math.dist(flat.true[:2], (3.6, -1.2)) < 0.05
    assert flat.feedback().recoveries >= 1 and "DETOUR" in doings(flat)
    assert flat.closest > CHASSIS


def test_a_pane_of_glass_is_met_and_gone_round() -> None:
    flat = Flat()
    flat.glass.append(Rectangle(*KITCHEN_DOOR))
    flat.ask("goto kitchen")
    pushed = longest = 0.0
    while flat.status().status == "navigating" and flat.now < 180.0:
        before = flat.true
        flat.step()
        told = flat.feedback().code
        pushed = pushed + 0.05 if flat.true == before and told == "" else 0.0
        longest = max(longest, pushed)
    assert flat.status().status == "arrived" and "HELD_UP" in doings(flat)
    assert longest < STOPPED + 0.15, "a base that stops in full motion is not pushed on"
    told = [msgspec.json.decode(f, type=m.NavigationFeedback).met for f in flat.feedbacks]
    places = {(round(x, 3), round(y, 3)) for x, y in filter(None, told)}
    assert 1 <= len(places) <= 2
    assert all(Rectangle(*KITCHEN_DOOR).distance(x, y) < 0.1 for x, y in places)
    flat.ask("return_to_start", "a.2")
    assert flat.finish(120.0).status == "arrived" and not flat.feedback().met, "remembered"


@pytest.mark.parametrize(("torque", "met"), [(3.0, False), (PRESSING + 1.0, True)])
def test_what_the_arm_presses_on_is_backed_off_at_once(torque: float, met: bool) -> None:
    flat, usual = Flat(), np.array([0.0, 5.0, -20.0, 3.0, 8.0, 0.0, 1.0])
    flat.ask("goto kitchen")
    edge = lowest = 1.0
    while flat.status().status == "navigating" and flat.now < 60.0:
        pressed = flat.true[0] > edge and not flat.feedback().met
        efforts = usual + np.eye(len(ARM))[2] * torque * pressed
        still, effort = [0.3] * 7, efforts.tolist()
        told = m.JointStates(t=flat.now, name=list(ARM), position=still, velocity=still, effort=effort)
        flat.bus.send(topics.JOINT_STATES, told)
        flat.step()
        if "HELD_UP" in doings(flat):
            lowest = min(lowest, flat.true[0])
        elif met:
            assert flat.true[0] < edge + 0.1, "it drives on"
    assert flat.status().status == "arrived", "around it"
    assert ("HELD_UP" in doings(flat)) == met and (lowest < edge - 0.1) == met


def test_an_arm_that_was_moved_or_carries_more_than_before_presses_on_nothing() -> None:
    load, torques = ArmLoad(), np.zeros(7)

    def presses(joint: float, torque: float) -> bool:
        position, efforts = [joint] * 7, (torques + torque).tolist()
        return load.presses(m.JointStates(t=0.0, name=list(ARM), position=position, velocity=[0.0] * 7, effort=efforts))

    assert not load.presses(None) and not presses(0.0, 0.0)
    assert not presses(0.5, 2 * PRESSING), "moved by its motors"
    assert not presses(0.5, 2 * PRESSING) and presses(0.5, 0.5 * PRESSING)
    assert not all(presses(0.5, 0.5 * PRESSING) for _ in range(1000)), "for good, as a bag that was hung on it"


def test_silent_sensors_are_no_pane_of_glass() -> None:
    flat = Flat()
    flat.ask("goto kitchen")
    for _ in range(40):
        flat.step()
    flat.mute = True
    for _ in range(8):
        flat.step()
    flat.mute = False
    assert flat.finish(60.0).status == "arrived" and "HELD_UP" not in doings(flat)


@pytest.mark.parametrize(("height", "held", "room"), [(0.06, False, 0.3), (0.80, False, 0.0), (0.06, True, 0.0)])
def test_a_thing_on_the_floor_is_gone_round_and_not_pushed(height: float, held: bool, room: float) -> None:
    """It lies below the lidar; what stands on a table or is carried is in nobody's way."""
    flat = Flat()
    ball = m.WorldObject(label="ball", kind="ball", colour="red", position=(1.5, -0.9, height), size=(0.1, 0.1, 0.12))
    flat.bus.send(topics.WORLD_OBJECTS, m.WorldObjects(t=0.0, objects=[msgspec.structs.replace(ball, held=held)]))
    flat.ask("goto kitchen")
    closest = math.inf
    while flat.status().status == "navigating" and flat.now < 60.0:
        flat.step()
        closest = min(closest, math.dist(flat.true[:2], ball.position[:2]))
    assert flat.status().status == "arrived"
    assert closest > room + 0.05 if room else closest < 0.3


def test_with_every_way_shut_it_waits_backs_off_tries_twice_and_says_so() -> None:
    flat = Flat([KITCHEN_DOOR, STUDY_DOOR])
    flat.ask("goto kitchen")
    status = flat.finish(180.0)
    assert (status.status, status.code) == ("failed", "BLOCKED")
    assert "after 2 retries" in status.detail
    assert flat.now > SETTLED, "until then it may be somebody who stands there"
    assert {"WAITING", "BACKING_OFF"} <= set(doings(flat))
    assert flat.feedback().recoveries >= 2 and flat.feedback().code == "BLOCKED"
    here = flat.true
    for _ in range(40):
        flat.step()
    assert math.dist(here[:2], flat.true[:2]) < 0.01, "it stands"
    assert flat.closest > CHASSIS


def test_it_does_not_back_off_into_what_has_come_up_behind_it() -> None:
    flat = Flat([KITCHEN_DOOR, STUDY_DOOR])
    flat.ask("goto kitchen")
    while "BACKING_OFF" not in doings(flat):
        flat.step()
    before = flat.true
    for _ in range(8):
        flat.step()
    x, y, _ = flat.true
    way = math.atan2(y - before[1], x - before[0])
    assert math.dist((x, y), before[:2]) > 0.02
    flat.boxes.append((x + 0.55 * math.cos(way), y + 0.55 * math.sin(way), 0.2, 0.2, way))
    for _ in range(60):
        flat.step()
    assert flat.closest > CHASSIS - 0.02


def test_waiting_for_somebody_who_passes_costs_no_retry() -> None:
    here = (0.0, 0.0)

    def blocked(people: list[Obstacle], seconds: float, patience: float = PASSING) -> float:
        timer, by_people = BlockedTimer(patience), anybody_near(here, people)
        return max(timer.blocked(by_people, 100.0 + 0.05 * n) for n in range(round(seconds / 0.05) + 1))

    wait, passer = NavigationConfig().blocked_wait, person(1.0, 0.0, 0.0, 0.5)
    assert blocked([], 5.0) == pytest.approx(5.0)
    assert blocked([person(9.0, 0.0, 0.0, 0.5)], 5.0) == pytest.approx(5.0), "far away"
    assert blocked([passer], 18.0) < wait < blocked([passer], 18.0, patience=10.0)
    assert blocked([passer], PASSING + 10.0) > wait, "somebody who stays is in the way"


def walks_in(flat: Flat, since: float) -> list[Rectangle]:
    """Somebody who comes to stand in the kitchen's door, in which a box leaves room for nobody else."""
    x = max(2.5, 4.2 - 0.5 * (flat.now - since))
    return [STUDY_DOOR_SHUT, Rectangle(2.5, -0.45, 0.3, 0.25), Rectangle(x, -0.85, 0.3, 0.3)]


@pytest.mark.slow
def test_who_stands_beside_a_box_in_the_only_door_is_no_thing_that_blocks_it() -> None:
    flat = Flat([STUDY_DOOR_SHUT])
    flat.ask("goto kitchen")
    began = flat.now
    while flat.status().status == "navigating" and flat.now - began < 300.0:
        flat.boxes = walks_in(flat, began)
        flat.step()
    assert flat.status().code == "PERSON_IN_WAY" and flat.now - began > PASSING
    assert "PERSON_IN_WAY" in doings(flat) and flat.closest > CHASSIS


def test_who_stood_in_the_only_door_before_the_robot_came_is_waited_for() -> None:
    flat = Flat([KITCHEN_DOOR, STUDY_DOOR])
    flat.ask("goto kitchen")
    while flat.now < 50.0 and flat.status().status == "navigating":
        flat.step()
    flat.boxes.clear()
    assert flat.finish(60.0).status == "arrived"


def test_what_a_person_leaves_is_forgotten_and_what_stood_there_before_is_not() -> None:
    made, here = costmap(), (0.0, -1.0, 0.0)
    box, body = Rectangle(1.5, -1.3, 0.3, 0.3), Rectangle(1.5, -0.8, 0.3, 0.3)
    flat = rectangles(SCENE, 0.2)
    for tick in range(100):
        boxes = [box, body] if tick > 50 else [box]
        people = [(1.5, -0.8, 0.45)] if tick > 60 else []
        made.obstacles.see(here, ANGLES, cast(here, [*flat, *boxes]), 10.0, 0.1 * tick, people)
    free = made.distance_to_things()
    assert made.clearance(1.36, -0.8) < 0.1 < free[made.cell(1.36, -0.8)]
    assert free[made.cell(1.36, -1.3)] < 0.1 and made.clearance(1.36, -1.3) < 0.1
    away = (-1.0, 3.0, 0.0)
    for tick in range(100, 200):
        made.obstacles.see(away, ANGLES, cast(away, flat), 10.0, 0.1 * tick)
    assert made.clearance(1.36, -1.3) < 0.1, "a box stands where it stood"
    assert made.clearance(1.36, -0.8) > 0.1, "people walk on"


def test_a_way_that_opens_while_it_waits_is_taken() -> None:
    flat = Flat([KITCHEN_DOOR, STUDY_DOOR])
    flat.ask("goto kitchen")
    while "WAITING" not in doings(flat):
        flat.step()
    flat.boxes.clear()
    assert flat.finish(60.0).status == "arrived"


def test_no_room_for_a_goal_that_the_map_itself_shuts_off() -> None:
    flat = Flat()
    flat.bus.send(topics.NAV_GOAL, m.NavGoal(id="c", x=6.0, y=3.5))
    flat.step()
    flat.step()
    assert flat.feedback().code == "NO_PATH"


def test_feedback_counts_down_to_the_goal() -> None:
    flat = Flat()
    flat.ask("goto kitchen")
    flat.finish(60.0)
    rows = [msgspec.json.decode(f, type=m.NavigationFeedback) for f in flat.feedbacks]
    left = [r.distance_remaining for r in rows if r.status == "navigating" and r.eta > 0]
    assert len(left) > 5 and left[0] > 3.0 and left[-1] < 0.6
    assert all(b < a + 0.3 for a, b in itertools.pairwise(left))


# --- people
def person(x: float, y: float, vx: float, vy: float) -> Obstacle:
    return Obstacle(x, y, 0.2, 0.0, vx, vy, sightings=9)


def costmap() -> Costmap:
    return Costmap(SCENE, 0.05, 30.0)


def test_nobody_in_the_way_changes_nothing() -> None:
    here, target = (0.0, -1.2), (0.5, -1.2)
    assert avoid(here, target, [], costmap(), 0.37) is None
    assert avoid(here, target, [person(0.0, 1.2, 0.0, 0.6)], costmap(), 0.37) is None
    assert avoid(here, target, [person(-1.5, -1.2, -0.6, 0.0)], costmap(), 0.37) is None


def test_it_waits_for_one_who_crosses() -> None:
    here, target = (0.0, -1.2), (0.5, -1.2)
    spot = avoid(here, target, [person(0.85, -0.2, 0.0, -0.7)], costmap(), 0.37)
    assert spot is not None and spot[0] < 0.1


def test_it_steps_aside_from_one_who_comes_straight_on_and_not_into_furniture() -> None:
    here, target, room = (0.0, -1.0), (0.5, -1.0), costmap()
    for angle in np.linspace(-math.pi, math.pi, 12):
        walker = person(
            1.6 * math.cos(angle), -1.0 + 1.6 * math.sin(angle), -0.8 * math.cos(angle), -0.8 * math.sin(angle)
        )
        spot = avoid(here, target, [walker], room, 0.37)
        assert spot is not None
        assert math.dist(here, spot) > 0.2
        assert room.line_clearance(here, spot) > 0.3


def test_who_stands_their_ground_stops_and_does_not_step_aside() -> None:
    coming, going = person(1.6, -1.0, -0.8, 0.0), person(2.6, -1.0, 0.8, 0.0)
    assert avoid((0.0, -1.0), (0.5, -1.0), [coming], costmap(), 0.37, stands=True) == (0.0, -1.0)
    assert avoid((0.0, -1.0), (0.5, -1.0), [going], costmap(), 0.37, stands=True) is None


def test_the_speed_of_a_walker_is_found_and_a_box_stays_a_box() -> None:
    movers = ObstacleTracker()
    arc = np.linspace(-0.6, 0.6, 9)
    for k in range(20):
        walker = np.stack([2.0 - 0.2 * np.cos(arc), -1.0 + 0.06 * k + 0.2 * np.sin(arc)], 1)
        box = np.stack([np.full(9, -1.5), np.linspace(-0.2, 0.2, 9)], 1)
        movers.update(np.concatenate([walker, box]), (0.0, 0.0), 0.1 * k)
    moving = movers.people()
    assert len(moving) == 1
    assert (moving[0].vx, moving[0].vy) == pytest.approx((0.0, 0.6), abs=0.1)
    movers.update(np.empty((0, 2)), (0.0, 0.0), 5.0)
    assert movers.people() == []


def test_who_walked_and_stands_is_still_a_person() -> None:
    movers = ObstacleTracker()
    arc = np.linspace(-0.6, 0.6, 9)
    for k in range(40):
        y = 0.06 * min(k, 20)
        movers.update(np.stack([2.0 - 0.2 * np.cos(arc), y + 0.2 * np.sin(arc)], 1), (0.0, 0.0), 0.1 * k)
    (one,) = movers.people()
    assert not one.moves and one.walked
    assert waiting_for((1.0, 1.0), [one]) == "PERSON_IN_WAY"
    assert waiting_for((-1.0, 1.0), [one]) == waiting_for((1.0, 1.0), []) == "WAITING"
    assert waiting_for((-1.0, 1.0), [one], by_people=True) == "PERSON_IN_WAY"


def test_a_person_who_was_hidden_for_a_moment_is_still_a_person_and_only_one_of_them() -> None:
    arc = np.linspace(-0.6, 0.6, 9)

    def body(x: float, y: float) -> np.ndarray:
        return np.stack([x - 0.2 * np.cos(arc), y + 0.2 * np.sin(arc)], 1)

    def seen_after(hidden: int) -> list[Obstacle]:
        movers = ObstacleTracker()
        for k in range(21):
            movers.update(body(2.0, 0.06 * k), (0.0, 0.0), 0.1 * k)
        for k in range(21, 21 + hidden):
            movers.update(np.empty((0, 2)), (0.0, 0.0), 0.1 * k)
        for k in range(21 + hidden, 26 + hidden):
            movers.update(np.concatenate([body(2.0, 1.6), body(2.2, 2.2)]), (0.0, 0.0), 0.1 * k)
        return movers.people()

    assert len(seen_after(15)) == 1
    assert seen_after(60) == []


def test_clusters_split_at_gaps_and_leave_out_walls() -> None:
    wall = np.stack([np.linspace(-2, 2, 60), np.full(60, 3.0)], 1)
    one = np.stack([np.linspace(1.0, 1.2, 5), np.full(5, 1.0)], 1)
    two = np.stack([np.linspace(1.6, 1.8, 5), np.full(5, 1.0)], 1)
    assert len(clusters(np.concatenate([one, two, wall]), (0.0, 0.0))) == 2


# --- the search
class Eyes:
    """A perception that reports an object once it is in view and the robot has stood for a second."""

    def __init__(self, flat: Flat, label: str, position: tuple[float, float, float] | None) -> None:
        self._flat, self._label, self._position = flat, label, position
        self._views = viewpoints_of(flat.io.household, None)
        self._still, self._last = 0, flat.true
        self.looked = np.zeros(len(self._views.points), bool)
        MemoryIo(flat.bus, "perception", (), (topics.WORLD_OBJECTS,), household=flat.io.household)

    def step(self) -> None:
        flat = self._flat
        self._still = self._still + 1 if math.dist(self._last[:2], flat.true[:2]) < 0.005 else 0
        self._last = flat.true
        if self._still < 20:
            return
        visible = self._views.visible(flat.true)
        self.looked |= visible
        if self._position is None:
            return
        near = np.hypot(*(self._views.points[:, :2] - self._position[:2]).T).argmin()
        if visible[near]:
            kind = self._label.split()[-1]
            thing = m.WorldObject(
                label=self._label, kind=kind, colour="", position=self._position, on="", id=self._label
            )
            flat.bus.send(topics.WORLD_OBJECTS, m.WorldObjects(t=flat.now, objects=[thing], source="perception"))


def search(flat: Flat, eyes: Eyes, seconds: float) -> m.NavigationStatus:
    until = flat.now + seconds
    while flat.now < until and flat.status().status == "navigating":
        flat.step()
        eyes.step()
    return flat.status()


def test_an_object_that_nobody_knows_of_is_looked_for_and_stood_before() -> None:
    flat = Flat()
    mug = (-2.45, 3.1, 0.77)
    eyes = Eyes(flat, "red mug", mug)
    flat.ask("find red mug")
    assert search(flat, eyes, 250.0).status == "arrived"
    assert 0.4 < math.dist(flat.true[:2], mug[:2]) < 0.75
    bearing = math.atan2(mug[1] - flat.true[1], mug[0] - flat.true[0])
    assert abs(math.remainder(bearing - flat.true[2], math.tau)) < 0.1, "it faces the mug"


def test_what_turns_out_to_be_something_else_on_the_way_is_searched_on() -> None:
    flat = Flat()
    mug = (-2.45, 3.1, 0.77)
    eyes = Eyes(flat, "red mug", mug)
    taken = m.WorldObject(label="red mug", kind="mug", colour="", position=(1.14, 4.2, 0.64), on="", id="red mug")
    flat.bus.send(topics.WORLD_OBJECTS, m.WorldObjects(t=flat.now, objects=[taken], source="perception"))
    flat.ask("find red mug")
    assert search(flat, Eyes(flat, "red mug", None), 3.0).status == "navigating"
    flat.bus.send(topics.WORLD_OBJECTS, m.WorldObjects(t=flat.now, objects=[], source="perception"))
    assert search(flat, eyes, 250.0).status == "arrived"
    assert math.dist(flat.true[:2], mug[:2]) < 0.9


def test_a_search_without_result_ends_after_every_surface_was_looked_at() -> None:
    flat = Flat(household=load_household("minimal"))
    eyes = Eyes(flat, "red mug", None)
    flat.ask("find red mug")
    status = search(flat, eyes, 160.0)
    assert (status.status, status.code) == ("failed", "NOT_FOUND")
    share = int(status.detail.split(" show ")[1].split("%")[0])
    assert share >= 90


def test_a_search_has_a_time_limit() -> None:
    flat = Flat(find_timeout=12.0)
    eyes = Eyes(flat, "red mug", None)
    flat.ask("find red mug")
    status = search(flat, eyes, 60.0)
    assert (status.status, status.code) == ("failed", "TIMEOUT")
    assert 11.0 < flat.now < 15.0


def test_the_second_search_starts_where_the_first_has_not_looked() -> None:
    flat = Flat(find_timeout=14.0)
    eyes = Eyes(flat, "red mug", None)
    flat.ask("find red mug")
    search(flat, eyes, 30.0)
    looked, eyes.looked = eyes.looked, np.zeros_like(eyes.looked)
    assert 0.05 < looked.mean() < 0.7
    flat.ask("find blue mug", "a.2")
    search(flat, eyes, 12.0)
    again = eyes.looked
    assert again.any() and (again & looked).sum() < 0.5 * again.sum()


def test_without_eyes_it_goes_to_the_item_s_spot_or_the_default_one() -> None:
    for item, spot in (("red mug", (1.0, 1.0)), ("banana", NavigationConfig().find_spot[:2])):
        flat = Flat()
        flat.ask(f"find {item}")
        assert flat.finish(60.0).status == "arrived"
        assert math.dist(flat.true[:2], spot) < 0.05


def test_who_waits_for_the_robot_is_given_room_after_a_while_and_again_less_often() -> None:
    standoff, one = Standoff(), person(1.0, 0.0, 0.0, 0.0)
    given = [t for t in np.arange(0.0, 30.0, 0.05) if standoff.with_whom((0.0, 0.0), [one], float(t))]
    assert given[0] == pytest.approx(STANDOFF, abs=0.1)
    assert np.diff(given) == pytest.approx([*[STANDOFF] * (MEETINGS - 1), LATER, LATER], abs=0.1)


def test_a_passing_place_is_off_the_way_of_the_person() -> None:
    room = costmap()
    planner = PathPlanner(room, 0.39, 0.65)
    here, somebody = (0.0, -1.0, 0.0), (1.2, -1.0)
    path = passing_place(here, somebody, room, planner)
    assert path is not None
    end = path[-1]
    assert math.dist(end, somebody) > math.dist(here[:2], somebody) + 0.3
    assert room.clearance(*end) > 0.39 and abs(end[1] - somebody[1]) > 0.4


def test_people_put_off_a_time_limit_but_not_for_ever() -> None:
    progress = Progress(NavigationConfig(), 0.0)
    progress.set_limit(10.0, 0.0)
    for t in np.arange(0.0, 200.0, 0.05):
        progress.extend(float(t))
    assert progress.deadline == pytest.approx(10.0 + HELD_UP, abs=0.2)


def test_steps_aside_never_end_in_furniture() -> None:
    room = costmap()
    here = (0.0, -3.5 + 0.06 + 0.40)
    for _ in range(40):
        walker = person(here[0] + 0.2, here[1] + 1.0, 0.0, -0.8)
        spot = avoid(here, (here[0] + 0.5, here[1]), [walker], room, 0.37)
        here = spot or here
    assert room.clearance(*here) > 0.36


@pytest.mark.parametrize(("stays", "limit"), [(8.0, 24.0), pytest.param(1000.0, 50.0, marks=pytest.mark.slow)])
def test_who_stands_in_a_door_is_waited_for_as_long_as_another_way_takes_longer(stays: float, limit: float) -> None:
    flat = Flat()
    flat.ask("goto kitchen")
    began, east = flat.now, 0.0
    while flat.status().status == "navigating" and flat.now - began < 2 * limit:
        t = flat.now - began
        x = max(2.4, 4.2 - 0.5 * t)
        flat.boxes = [Rectangle(x, -0.75, 0.3, 0.3)] if t < 3.6 + stays else []
        flat.step()
        if abs(flat.true[0] - 2.5) < 0.1:
            east = flat.true[1]
    assert flat.status().status == "arrived" and flat.now - began < limit
    assert (east < 0.0) == (stays < 10.0), "by the door once it is free in time, else by the others"
    assert flat.closest > CHASSIS


def test_a_way_round_is_not_given_up_until_the_first_one_is_seen_to_be_free() -> None:
    config, costmap = NavigationConfig(), Costmap(SCENE, 0.05, 30.0)
    planner = PathPlanner(costmap, config.footprint_radius + config.clearance, config.inflation)
    kitchen = [(0.0, (3.6, -1.2, 0.0))]
    before, around = (0.5, -0.6, 0.0), (-0.45, 2.9, 1.57)
    route = Route(config, costmap, planner, kitchen)
    assert route.plan(before, 0.0) == "new"
    flat = rectangles(SCENE, 0.2)
    costmap.obstacles.see(before, ANGLES, cast(before, [*flat, Rectangle(*KITCHEN_DOOR)]), 10.0, 1.0)
    assert route.plan(before, 1.0) == "detour"
    costmap.obstacles.forget()
    assert route.plan(around, 40.0) == "kept", "it may stand there yet, though that is long ago"
    assert route.plan(before, 41.0) == "new", "it does not"


def test_a_room_with_a_table_in_its_middle_is_gone_to_beside_it() -> None:
    x, y = (1.0, 2.9)
    table = Box(name="table", center=(x, y, 0.4), size=(0.6, 0.5, 0.8))
    room = Room(name="nook", low=(x - 1.2, y - 1.0), high=(x + 1.2, y + 1.0))
    home = msgspec.structs.replace(SCENE, rooms=(*SCENE.rooms, room), furniture=(*SCENE.furniture, table))
    flat = Flat(household=home)
    flat.ask("goto nook")
    assert flat.finish(120.0).status == "arrived"
    assert room.low[0] < flat.true[0] < room.high[0] and room.low[1] < flat.true[1] < room.high[1]


def test_a_box_that_the_robot_drives_past_does_not_walk() -> None:
    box = Rectangle(1.2, 0.6, 0.53, 0.25, 0.0)
    flat = Flat(boxes=[box])
    flat.step(4.0)
    for x in np.concatenate([np.arange(0.0, 2.0, 0.025), np.arange(2.0, 0.0, -0.025)]).tolist():
        flat.true = flat.wheels = (x, 0.0, 0.0)
        flat.step(0.05)
        assert not [o for o in flat.service.state.tracker.people() if box.distance(o.x, o.y) < 0.15]


def test_who_stood_there_when_the_robot_came_is_seen_to_walk_on() -> None:
    flat = Flat(boxes=[Rectangle(1.2, 0.0, 0.25, 0.25, 0.0)])
    flat.step(6.0)
    for k in range(25):
        flat.boxes = [Rectangle(1.2, -0.04 * k, 0.25, 0.25, 0.0)]
        flat.step(0.05)
    (one,) = [o for o in flat.service.state.tracker.people() if o.moves]
    assert one.vy == pytest.approx(-0.8, abs=0.3)


def hallway() -> Household:
    """Two rooms joined by a corridor of 1.1 m, 5 m long, in which nobody gets past the robot."""
    ways = [((-2, -2), (9, -2)), ((9, -2), (9, 2)), ((9, 2), (-2, 2)), ((-2, 2), (-2, -2))]
    for x in (1.5, 6.5):
        ways += [((x, -2), (x, -0.55)), ((x, 0.55), (x, 2))]
    ways += [((1.5, -0.55), (6.5, -0.55)), ((1.5, 0.55), (6.5, 0.55))]
    walls = tuple(Wall(start=a, end=b) for a, b in ways)
    home = Place(name="home", x=0.0, y=0.0, theta=0.0)
    return mapped(FloorPlan(name="hallway", low=(-2.0, -2.0), high=(9.0, 2.0), home=home, walls=walls))


def test_who_walks_to_and_fro_in_the_only_way_is_followed_as_they_turn_round() -> None:
    """They turn at both ends of their way, and when they have stood before the robot for 5 s."""
    flat, x, way, since, least = Flat(household=hallway()), 6.0, -1.0, 0.0, math.inf
    flat.bus.send(topics.NAV_GOAL, m.NavGoal(id="a.1", x=8.0, y=0.0, theta=0.0))
    while flat.now < 150.0 and flat.true[0] < 6.6:
        apart, y = x - flat.true[0], 1.2 if x > 7.0 else 0.0
        least = min(least, math.hypot(apart, y - flat.true[1]))
        if way * apart > 0.0 or abs(apart) > 0.7:
            x, since = x + 0.035 * way, flat.now
        if not 2.0 < x < 7.2 or flat.now - since > 5.0:
            x, way, since = min(max(x, 2.0), 7.2), -way, flat.now
        flat.boxes = [Rectangle(x, y, 0.3, 0.3, 0.0)]
        flat.step(0.05)
    assert flat.true[0] > 6.6
    assert least > 0.45
