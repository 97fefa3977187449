import itertools
import math

import msgspec
import numpy as np
import pytest

from common import messages as m
from common import topics
from common.approach import delivers_at_home, poses_for
from common.config import config_dir, load
from common.floor_plan import FloorPlan, Wall
from common.geometry import Point, Rectangle, quat_yaw
from common.household import told
from common.scene import load_scene
from services.navigation.config import NavigationConfig
from services.navigation.goals import UNLISTED, Goals
from services.navigation.motion.path_follower import PathFollower
from services.navigation.places import Places, PlacesFile
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner
from services.navigation.service import NavigationService
from services.sim.layout import place_objects
from tests.node import Node
from tests.unit.navigation_flat import Flat

WORLD = load_scene("apartment")
SCENE = told(WORLD)
CONFIG = NavigationConfig()
RADIUS = CONFIG.footprint_radius + CONFIG.clearance


@pytest.fixture(scope="module")
def planner() -> tuple[Costmap, PathPlanner]:
    costmap = Costmap(SCENE, CONFIG.resolution, CONFIG.obstacle_memory)
    return costmap, PathPlanner(costmap, RADIUS, CONFIG.inflation)


def test_home_and_the_example_spot_are_free(planner: tuple[Costmap, PathPlanner]) -> None:
    assert planner[1].free(0.0, 0.0) and planner[1].free(1.0, 1.0)


def test_paths_between_free_points_keep_their_clearance(planner: tuple[Costmap, PathPlanner]) -> None:
    costmap, paths = planner
    rng = np.random.default_rng(3)
    found = 0
    while found < 60:
        a, b = (tuple(rng.uniform(SCENE.low, SCENE.high).tolist()) for _ in range(2))
        if not (paths.free(*a) and paths.free(*b)):
            continue
        field = paths.field(*a)
        path = paths.path(field, a, b)
        if path is None:
            continue
        found += 1
        assert path[0] == pytest.approx(a) and path[-1] == pytest.approx(b)
        assert min(costmap.clearance(*p) for p in path) > CONFIG.footprint_radius - costmap.resolution
        assert max(math.dist(p, q) for p, q in itertools.pairwise(path)) < 0.06


def test_every_room_and_surface_can_be_reached_from_home(planner: tuple[Costmap, PathPlanner]) -> None:
    field = planner[1].field(0.0, 0.0)
    for place in SCENE.places:
        assert math.isfinite(planner[1].cost_to(field, (place.x, place.y))), place.name


def test_there_is_no_path_into_a_wall(planner: tuple[Costmap, PathPlanner]) -> None:
    field = planner[1].field(0.0, 0.0)
    assert planner[1].path(field, (0.0, 0.0), (2.5, 1.5)) is None


@pytest.mark.parametrize("seed", range(30))
def test_every_object_has_a_stand_that_is_free_reachable_and_close(
    seed: int, planner: tuple[Costmap, PathPlanner]
) -> None:
    field = planner[1].field(0.0, 0.0)
    for p in place_objects(WORLD, seed):
        x, y, _ = p.position
        stands = poses_for((x, y), SCENE.receptacle(p.on), CONFIG.stand_off, CONFIG.edge_distance)
        good = [
            s for _, s in stands
            if planner[1].free(s[0], s[1]) and math.isfinite(planner[1].cost_to(field, (s[0], s[1])))
        ]  # fmt: skip
        assert good, f"{p.spec.name} on {p.on}"
        assert min(math.hypot(s[0] - x, s[1] - y) for s in good) < 0.70
        for s in good:
            bearing = math.atan2(y - s[1], x - s[0])
            assert abs(math.remainder(bearing - s[2], 2 * math.pi)) < 0.01, "the robot faces the object"


def test_what_lies_behind_the_edge_of_a_sofa_is_approached_from_where_there_is_floor(
    planner: tuple[Costmap, PathPlanner],
) -> None:
    seat = next(f for f in SCENE.furniture if f.name == "sofa seat")
    x, y = seat.center[0] + seat.size[0] / 2 - 0.24, seat.center[1] + 0.4
    stands = poses_for((x, y), None, CONFIG.stand_off, CONFIG.edge_distance)
    free = [(penalty, s) for penalty, s in stands if planner[1].free(s[0], s[1])]
    assert free
    assert min(penalty for penalty, _ in stands) == 0.0 < min(free)[0], "nearer is better, where it is possible"


@pytest.mark.parametrize(
    ("home", "expected"), [((0.0, 0.0, 0.0), True), ((0.0, 0.0, 1.6), False), ((-0.3, 0.0, 0.0), False)]
)
def test_what_is_brought_is_put_down_from_home_where_its_surface_is_before_it(
    home: tuple[float, float, float], expected: bool
) -> None:
    x, y, theta = home
    scene = msgspec.structs.replace(SCENE, home=msgspec.structs.replace(SCENE.home, x=x, y=y, theta=theta))
    assert delivers_at_home(scene) is expected
    goals = Goals(scene, Places(scene, load("places", PlacesFile, config_dir(), {})), CONFIG)
    ((_, pose), *others) = goals.place(scene.delivery)
    assert (pose == home) is expected and bool(others) is not expected
    assert delivers_at_home(msgspec.structs.replace(scene, delivery=""))


def test_a_chair_before_the_only_side_that_is_listed_is_gone_round_to_another() -> None:
    table = next(r for r in SCENE.receptacles if r.name == "bedside table")
    assert table.approach == ((0, -1),)
    x, y = table.center[:2]
    flat = Flat([Rectangle(x, y - 0.6, 0.5, 0.5)])
    flat.ask("goto bedside table")
    assert flat.finish(120.0).status == "arrived"
    assert abs(flat.true[0] - x) > 0.5 and math.dist(flat.true[:2], (x, y)) < 0.8
    assert abs(math.remainder(math.atan2(y - flat.true[1], x - flat.true[0]) - flat.true[2], math.tau)) < 0.1


def test_other_sides_come_after_those_that_are_listed_and_not_through_a_wall() -> None:
    goals = Goals(SCENE, Places(SCENE, load("places", PlacesFile, config_dir(), {})), CONFIG)
    desk = next(r for r in SCENE.receptacles if r.name == "desk")
    listed = poses_for(desk.center[:2], desk, CONFIG.stand_off, CONFIG.edge_distance)
    choices = goals.place("desk")
    assert choices[: len(listed)] == listed
    others = choices[len(listed) :]
    assert others and min(penalty for penalty, _ in others) >= UNLISTED
    assert all(SCENE.room_at(*pose[:2]) is SCENE.room_at(*desk.center[:2]) for _, pose in others)


def test_the_lidar_marks_what_the_map_lacks_and_clears_it_again() -> None:
    costmap = Costmap(SCENE, 0.05, 4.0)
    angles = -math.pi + np.arange(360) * math.radians(1)
    ranges = np.full(360, 11.0)
    ranges[175:186] = 0.8
    costmap.obstacles.see((0.0, -0.9, -math.pi / 2), angles, ranges, 10.0, 1.0)
    assert not costmap.obstacles.empty and costmap.clearance(0.0, -1.7) < 0.1
    costmap.obstacles.see((0.0, -0.9, -math.pi / 2), angles, np.full(360, 11.0), 10.0, 1.1)
    assert costmap.obstacles.empty and costmap.clearance(0.0, -1.7) > 0.3


def test_the_follower_stops_before_what_the_lidar_sees() -> None:
    costmap = Costmap(SCENE, 0.05, 4.0)
    path = [(0.0, -0.05 * i) for i in range(30)]
    follower = PathFollower(path, (0.0, -1.45, -1.57), 0.5, CONFIG.corridor)
    pose = (0.0, 0.0, -math.pi / 2)
    free = follower.step(pose, costmap, CONFIG.footprint_radius, None)
    assert free.pose[1] < -0.4 and not free.blocked
    near = follower.step(pose, costmap, CONFIG.footprint_radius, np.array([[0.0, -0.36]]))
    assert near.blocked and abs(near.pose[1]) < 0.05
    beside = follower.step(pose, costmap, CONFIG.footprint_radius, np.array([[0.5, -0.3]]))
    assert not beside.blocked


def test_who_was_led_off_the_path_behind_a_wall_does_not_go_back_straight() -> None:
    wall = Wall(start=(1.0, -2.0), end=(1.0, 0.5))
    flat = FloorPlan(name="flat", low=(-3.0, -3.0), high=(3.0, 3.0), home=SCENE.home, walls=(wall,))
    costmap, path = Costmap(flat, 0.05, 4.0), [(1.5, -1.5 + 0.05 * i) for i in range(30)]
    on, off = ((x, -1.0, 0.0) for x in (1.45, 0.5))
    for pose, strayed in ((on, False), (off, True)):
        follower = PathFollower(path, (*path[-1], 0.0), 0.5, CONFIG.corridor)
        assert follower.step(pose, costmap, CONFIG.footprint_radius, None).strayed is strayed


class Pilot(Node):
    """The service, with a base that a test moves."""

    def __init__(self) -> None:
        super().__init__(NavigationService, CONFIG, SCENE, lockstep=False)
        self.pose = (0.0, 0.0, 0.0)

    def feed(self) -> None:
        x, y, theta = self.pose
        self.bus.send(topics.ODOMETRY, m.Odometry(t=self.now, x=x, y=y, theta=theta))

    def ask(self, text: str, goal_id: str = "a.1", attempt: int = 1) -> m.NavigationStatus:
        self.bus.send(topics.NAVIGATION_GOAL, m.NavigationGoal(goal=text, id=goal_id, attempt=attempt))
        self.step()
        return self.status()

    def approach(self, position: m.Vec3, goal_id: str = "a.1", attempt: int = 1, at: Point = (1.0, 1.0)) -> None:
        """Send a pose before the red mug."""
        mug = m.ObjectRef(label="red mug", position=position)
        self.bus.send(topics.NAV_GOAL, m.NavGoal(id=goal_id, attempt=attempt, x=at[0], y=at[1], object=mug))
        self.step()

    def status(self) -> m.NavigationStatus:
        return self.last(topics.NAVIGATION_STATUS)

    def feedback(self) -> m.NavigationFeedback:
        return self.last(topics.NAVIGATION_FEEDBACK)

    def target(self) -> m.BaseTarget:
        return self.sent(topics.BASE_TARGET)[-1]


@pytest.mark.parametrize(
    ("goal", "code"),
    [
        ("dance", "UNKNOWN_GOAL"),
        ("find", "UNKNOWN_GOAL"),
        ("goto", "UNKNOWN_GOAL"),
        ("goto the moon", "UNKNOWN_PLACE"),
    ],
)
def test_what_cannot_be_done_fails_with_a_code_and_a_reason(goal: str, code: str) -> None:
    status = Pilot().ask(goal)
    assert (status.status, status.code, status.goal_id, status.attempt) == ("failed", code, "a.1", 1)
    assert status.detail


def test_arrived_comes_only_from_the_base() -> None:
    node = Pilot()
    assert node.ask("find the red mug").status == "navigating"
    node.pose = (1.0, 1.0, 0.0)
    node.step(0.5)
    final = node.target()
    assert (final.x, final.y) == pytest.approx((1.0, 1.0)), "the spot of places.toml"
    assert node.status().status == "navigating"
    node.bus.send(topics.GOAL_REACHED, m.GoalReached(reached=True, target_id="somebody else's"))
    node.step()
    assert node.status().status == "navigating"
    node.bus.send(topics.GOAL_REACHED, m.GoalReached(reached=True, target_id=final.id))
    node.step()
    assert node.status().status == "arrived"


def sighted() -> tuple[Pilot, Point]:
    """A robot that knows where the red mug is."""
    node, mug = Pilot(), place_objects(WORLD, 0)[0]
    seen = m.WorldObject(
        label="red mug", kind="mug", colour="red", position=mug.position, size=mug.spec.size, on=mug.on
    )
    node.bus.send(topics.WORLD_OBJECTS, m.WorldObjects(t=0.0, objects=[seen]))
    return node, mug.position[:2]


def test_an_object_that_was_seen_counts_before_the_places_file() -> None:
    node, mug = sighted()
    node.ask("find red cup")
    path = node.last(topics.NAV_PATH)
    assert path.goal_id == "a.1"
    assert math.dist(path.points[-1], mug) < 1.0


@pytest.mark.parametrize("posed", [False, True], ids=["find", "nav_goal"])
def test_asked_again_before_the_same_thing_it_stands_somewhere_else(posed: bool) -> None:
    node, mug = sighted()

    def stand(text: str, goal_id: str, attempt: int = 1) -> Point:
        """Where the goal ends; the base goes there at once."""
        if posed and text == "find red mug":
            node.approach((*mug, 0.6), goal_id, attempt)
        else:
            node.ask(text, goal_id, attempt)
        end = node.last(topics.NAV_PATH).points[-1]
        node.pose = (*end, math.atan2(mug[1] - end[1], mug[0] - end[0]))
        node.step(0.5)
        node.bus.send(topics.GOAL_REACHED, m.GoalReached(reached=True, target_id=node.target().id))
        node.step()
        assert (node.feedback().goal_id, node.feedback().status) == (goal_id, "arrived")
        return node.pose[:2]

    first = stand("find red mug", "a.1")
    assert math.dist(stand("find red mug", "a.1", 2), first) < 0.03, "the same wish, said again"
    second = stand("find red mug", "a.2")
    third = stand("find red mug", "a.3")
    assert min(math.dist(second, first), math.dist(third, first), math.dist(third, second)) > 0.08
    assert all(math.dist(p, mug) < 0.8 for p in (second, third)), "still in reach"
    stand("goto kitchen", "a.4")
    assert math.dist(stand("find red mug", "a.5"), first) < 0.25, "what was tried is forgotten on the way"


def test_a_pose_before_an_object_leads_to_the_stance_that_find_takes() -> None:
    ends = []
    for posed in (False, True):
        node, mug = sighted()
        told = node.bus.tap(topics.NAVIGATION_STATUS)
        if posed:
            node.approach((mug[0] + 0.05, mug[1], 0.6))
            assert not told, "the answers come on navigation_feedback"
            assert (node.feedback().status, node.feedback().attempt) == ("navigating", 1)
        else:
            node.ask("find red mug")
        ends.append(node.last(topics.NAV_PATH).points[-1])
    assert ends[0] == ends[1]


def test_the_pose_itself_is_taken_where_nothing_better_is_free_or_known() -> None:
    node = Pilot()
    walled_in = m.ObjectRef(label="red mug", position=(9.0, 9.0, 0.5))
    odd = m.ObjectRef(label="red mug", position=(0.5, 0.5, 0.5), frame="base")
    for number, ref in enumerate((walled_in, odd, None), 1):
        node.bus.send(topics.NAV_GOAL, m.NavGoal(id=f"a.{number}", x=1.0, y=1.0, object=ref))
        node.step()
        end = node.last(topics.NAV_PATH)
        assert (end.goal_id, end.points[-1]) == (f"a.{number}", pytest.approx((1.0, 1.0), abs=0.2))


def test_a_pose_twice_runs_once_and_a_newer_one_replaces_it() -> None:
    node, mug = sighted()
    node.approach((*mug, 0.6))
    paths, told = node.bus.tap(topics.NAV_PATH), node.bus.tap(topics.NAVIGATION_FEEDBACK)
    node.approach((*mug, 0.6))
    assert not paths
    assert {(f["goal_id"], f["status"]) for f in map(msgspec.json.decode, told)} == {("a.1", "navigating")}
    node.approach((*mug, 0.6), "a.2")
    ended = [msgspec.json.decode(f, type=m.NavigationFeedback) for f in told]
    assert [(f.goal_id, f.status, f.code) for f in ended if f.code] == [("a.1", "failed", "PREEMPTED")]
    node.bus.put(topics.NAV_GOAL, b'{"x": 1.0, "y": 1.0}')
    node.step()
    assert node.feedback().goal_id.startswith("navigation"), "a goal without an id gets one"


def test_the_same_goal_twice_runs_once_and_is_answered() -> None:
    node = Pilot()
    node.ask("goto kitchen")
    tap = node.bus.tap(topics.NAVIGATION_STATUS)
    paths = node.bus.tap(topics.NAV_PATH)
    node.ask("goto kitchen")
    assert [msgspec.json.decode(p)["status"] for p in tap] == ["navigating"]
    assert not paths


def test_a_new_goal_replaces_the_old_one_and_stop_holds() -> None:
    node = Pilot()
    node.ask("goto kitchen", "a.1")
    assert node.ask("goto bedroom", "a.2").goal_id == "a.2"
    stopped = node.ask("stop", "a.3")
    assert (stopped.status, stopped.code) == ("idle", "STOPPED")
    count = node.count(topics.BASE_TARGET)
    node.step(0.5)
    assert node.count(topics.BASE_TARGET) == count


def test_silent_odometry_ends_the_goal() -> None:
    node = Pilot()
    node.ask("goto kitchen")
    node.step(1.0, fed=False)
    assert (node.status().status, node.status().code) == ("failed", "NO_ODOMETRY")


@pytest.mark.parametrize(
    "pose",
    [
        m.NavGoal(id="c", x=99.0, y=0.0),
        m.NavGoal(id="c", x=0.5, y=0.5, frame="moon"),
    ],
)
def test_a_bad_pose_is_refused(pose: m.NavGoal) -> None:
    node = Pilot()
    node.send(topics.NAV_GOAL, pose)
    node.step()
    feedback = node.last(topics.NAVIGATION_FEEDBACK)
    assert (feedback.status, feedback.code) == ("failed", "BAD_POSE")


def test_a_goal_inside_furniture_has_no_path() -> None:
    node = Pilot()
    node.bus.send(topics.NAV_GOAL, m.NavGoal(id="c", x=6.0, y=3.5))
    node.step(0.2)
    feedback = node.last(topics.NAVIGATION_FEEDBACK)
    assert (feedback.goal_id, feedback.status, feedback.code) == ("c", "failed", "NO_PATH")


def test_quaternion_of_the_survey_has_the_heading() -> None:
    assert quat_yaw((math.cos(0.3), 0.0, 0.0, math.sin(0.3))) == pytest.approx(0.6)
