"""After putting down the brain looks, and claims only what it saw."""

import math
from pathlib import Path
from typing import Any

import msgspec
import pytest

from common import messages as m
from common import topics
from common.bus.memory import MemoryIo
from common.household import load_household
from services.brain.config import BrainConfig
from services.brain.journal.pictures import KEPT, LARGEST, START, Pictures
from services.brain.steps.verify import ASIDE
from services.brain.world.placement import Rest, judge_absence, judge_placement, kind_meant, rested
from tests.unit.brain_bench import Bench
from tests.unit.test_brain_vla import FETCH, MANIP, POSE, QUERY, SPEECH, approach, planned, see

SCENE = load_household("apartment")
TRAY = (0.7, 0.0, 0.51)
Size = tuple[float, float, float]
LYING = math.pi / 2
SIDE = (math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0)


def pose(**fields: Any) -> m.ObjectPose:
    return m.ObjectPose(query_id="q", found=True, **{"label": "red mug", "position": TRAY, **fields})


@pytest.mark.parametrize(
    ("label", "target", "seen", "fault"),
    [
        ("red mug", "delivery tray", {}, ""),
        ("red mug", "tray", {"on": "delivery tray"}, ""),
        ("red mug", "delivery tray", {"tilt": LYING}, "TOPPLED"),
        ("red mug", "delivery tray", {"orientation": SIDE}, "TOPPLED"),
        ("red mug", "delivery tray", {"tilt": math.pi}, "TOPPLED"),
        ("red ball", "delivery tray", {"tilt": LYING}, ""),
        ("red mug", "delivery tray", {"position": (0.7, 0.0, 0.05)}, "MISPLACED"),
        ("red mug", "delivery tray", {"position": (1.3, 0.0, 0.05)}, "MISPLACED"),
        ("red mug", "delivery tray", {"on": "desk", "position": (-2.6, 3.0, 0.77)}, "MISPLACED"),
        ("red mug", "", {"position": (1.3, 0.0, 0.05)}, ""),
        ("red mug", "", {"position": (1.3, 0.0, 0.05), "tilt": LYING}, "TOPPLED"),
        ("red mug", "bin", {"position": (6.6, -2.3, 0.1), "tilt": LYING}, ""),
        ("red mug", "bin", {"position": (6.1, -2.3, 0.05)}, "MISPLACED"),
    ],
)
def test_what_is_seen_is_judged_by_place_and_stance(label: str, target: str, seen: dict[str, Any], fault: str) -> None:
    finding = judge_placement(pose(label=label, **seen), label, target, SCENE)
    assert finding.fault == fault
    assert label in finding.words and "tilt" in finding.measured


@pytest.mark.parametrize(
    ("asked", "label", "tilt", "closed", "fault"),
    [
        ("the yellow bottle", "yellow banana", LYING, False, "TOPPLED"),
        ("the yellow banana", "yellow banana", LYING, False, ""),
        ("orange mug", "orange can", 0.0, True, "TOPPLED"),
        ("orange can", "orange can", 0.0, True, ""),
        ("my beaker of whatever", "green bottle", LYING, False, "TOPPLED"),
    ],
)
def test_what_no_household_lists_is_judged_as_what_it_was_asked_for(
    asked: str, label: str, tilt: float, closed: bool, fault: str
) -> None:
    unlisted = msgspec.structs.replace(SCENE, things=())
    seen = pose(label=label, tilt=tilt)
    rest = Rest(kind_meant(asked, unlisted), lay=closed)
    assert judge_placement(seen, label, "delivery tray", unlisted, rest=rest, alike=closed).fault == fault


@pytest.mark.parametrize(
    ("asked", "tilt", "before", "top", "fault"),
    [
        ("black mug", LYING, "", "open", ""),
        ("black mug", LYING, "", "closed", "TOPPLED"),
        ("black mug", LYING, "open", "closed", "TOPPLED"),
        ("black mug", LYING, "", "", "UNTOLD"),
        ("black mug", LYING, "open", "", ""),
        ("black mug", 0.0, "", "", ""),
        ("black bottle", LYING, "", "", ""),
    ],
)
def test_a_vessel_that_lay_stands_when_it_is_seen_to_be_open_above(
    asked: str, tilt: float, before: m.End, top: m.End, fault: str
) -> None:
    unlisted = msgspec.structs.replace(SCENE, things=())
    rest = rested(pose(label=asked, tilt=tilt), asked, unlisted, None, "round", before)
    assert judge_placement(pose(label=asked), asked, "delivery tray", unlisted, rest=rest, top=top).fault == fault


@pytest.mark.parametrize(
    ("before", "high", "now", "fault"),
    [
        (LYING, 0.07, "irregular", "UNTOLD"),
        (LYING, 0.19, "irregular", ""),
        (LYING, 0.07, "round", ""),
        (0.0, 0.07, "irregular", ""),
    ],
)
def test_what_lay_and_has_no_shape_now_is_as_high_as_it_was_long(
    before: float, high: float, now: m.ShapeFamily, fault: str
) -> None:
    unlisted, asked = msgspec.structs.replace(SCENE, things=()), "black bottle"
    rest = rested(pose(label=asked, tilt=before, size=(0.2, 0.07, 0.07)), asked, unlisted, None, "long")
    seen = pose(label=asked, size=(0.2, 0.07, high))
    assert judge_placement(seen, asked, "delivery tray", unlisted, rest=rest, shape=now).fault == fault


@pytest.mark.parametrize(
    ("asked", "size", "fault"),
    [
        ("the green box", (0.19, 0.13, 0.05), "TOPPLED"),
        ("the green box", (0.13, 0.05, 0.19), ""),
        ("the green book", (0.19, 0.13, 0.05), ""),
    ],
)
def test_a_box_that_is_seen_as_a_book_has_to_stand(asked: str, size: tuple[float, float, float], fault: str) -> None:
    unlisted = msgspec.structs.replace(SCENE, things=())
    seen = pose(label="green book", size=size)
    rest = Rest(kind_meant(asked, unlisted))
    assert judge_placement(seen, "green book", "delivery tray", unlisted, rest=rest).fault == fault


@pytest.mark.parametrize(
    ("asked", "stood", "height", "fault"),
    [
        ("the red teapot", 0.14, 0.09, "TOPPLED"),
        ("the red teapot", 0.14, 0.13, ""),
        ("the red teapot", 0.0, 0.09, ""),
        ("the red book", 0.20, 0.03, ""),
    ],
)
def test_what_has_no_kind_is_not_lower_than_it_stood(asked: str, stood: float, height: float, fault: str) -> None:
    unlisted = msgspec.structs.replace(SCENE, things=())
    seen = pose(label="red toy", size=(0.16, 0.10, height))
    rest = Rest(kind_meant(asked, unlisted), stood=stood)
    assert judge_placement(seen, "red toy", "delivery tray", unlisted, rest=rest).fault == fault


@pytest.mark.parametrize(
    ("before", "now", "width", "fault"),
    [
        ("bowl", "irregular", 0.1, "TOPPLED"), ("bowl", "bowl", 0.1, ""), ("box", "irregular", 0.1, ""),
        ("round", "", 0.1, ""), ("bowl", "box", 0.09, ""), ("bowl", "box", 0.06, "TOPPLED"),
    ],
)  # fmt: skip
def test_what_was_turned_and_is_so_no_more_does_not_stand(before: Any, now: Any, width: float, fault: str) -> None:
    unlisted = msgspec.structs.replace(SCENE, things=())
    pot = pose(label="orange mug", size=(0.1, 0.1, 0.096))
    rest = rested(pot, "flower pot", unlisted, None, before)
    lies = pose(label="orange mug", size=(0.1, width, 0.105))
    assert judge_placement(lies, "orange mug", "delivery tray", unlisted, rest=rest, shape=now).fault == fault


def test_of_two_looks_that_differ_the_better_is_not_believed() -> None:
    unlisted = msgspec.structs.replace(SCENE, things=())
    pot = pose(label="orange mug", size=(0.1, 0.1, 0.096))
    rest = rested(pot, "flower pot", unlisted, None, "bowl")
    first = judge_placement(pot, "orange mug", "delivery tray", unlisted, rest=rest, shape="irregular")
    assert (first.fault, first.unlike) == ("TOPPLED", True)
    for before, fault in ((False, ""), (True, "TOPPLED")):
        found = judge_placement(pot, "orange mug", "delivery tray", unlisted, rest=rest, shape="bowl", unlike=before)
        assert found.fault == fault


STANDING, LYING_BOX, LYING_WEDGE = (0.07, 0.07, 0.22), (0.22, 0.07, 0.07), (0.114, 0.055, 0.058)


@pytest.mark.parametrize(
    ("asked", "sights", "now", "fault"),
    [
        # It fell, was stood up again, and no end of a carton is like the other.
        ("milk carton", [("white box", STANDING), ("white box", LYING_BOX)], ("white box", STANDING), "UNTOLD"),
        ("milk carton", [("white box", STANDING)], ("white box", STANDING), ""),
        ("white box", [("white box", LYING_BOX)], ("white box", STANDING), ""),
        # What was a box lies as one, whatever it looks like now.
        ("cheese", [("yellow box", (0.11, 0.06, 0.055))], ("yellow toy", LYING_WEDGE), "TOPPLED"),
        ("cheese", [("yellow toy", LYING_WEDGE)], ("yellow toy", LYING_WEDGE), ""),
    ],
)
def test_what_has_lain_is_judged_by_what_it_was(
    asked: str, sights: list[tuple[str, Size]], now: tuple[str, Size], fault: str
) -> None:
    unlisted, rest = msgspec.structs.replace(SCENE, things=()), None
    for label, size in sights:
        rest = rested(pose(label=label, size=size), asked, unlisted, rest)
    label, size = now
    seen = pose(label=label, size=size)
    finding = judge_placement(seen, label, "delivery tray", unlisted, rest=rest or Rest(), alike="box" in label)
    assert finding.fault == fault, finding


@pytest.mark.parametrize(("x", "fault"), [(0.4, ""), (1.2, "MISPLACED")])
def test_what_belongs_next_to_something_is_judged_by_its_distance(x: float, fault: str) -> None:
    anchor = m.ObjectRef(label="apple", position=(x, 0.0, 0.5))
    finding = judge_placement(pose(label="red mug"), "red mug", "delivery tray", SCENE, anchor)
    assert finding.fault == fault and "apple" in finding.words


def test_into_a_bin_nobody_sees() -> None:
    assert judge_absence("red mug", "bin", SCENE).fault == ""
    assert judge_absence("red mug", "delivery tray", SCENE).fault == "NOT_SEEN"


def with_perception(bench: Bench) -> None:
    """Its process is alive: it holds the token."""
    MemoryIo(bench.bus, "perception", (), (), household=SCENE)


def brought(alive: bool = True) -> Bench:
    """The mug has been released at home; the query after that is the second."""
    bench = planned(FETCH)
    if alive:
        with_perception(bench)
    see(bench, 1)
    approach(bench, 1)
    bench.did(bench.manip(1))
    bench.drove(bench.nav(1))
    bench.did(bench.manip(2))
    return bench


def approach_again(bench: Bench, count: int) -> None:
    goal = bench.next_goal(POSE, count)
    bench.send(topics.NAVIGATION_FEEDBACK, m.NavigationFeedback(goal_id=goal.id, status="arrived"))
    bench.step()


def look(bench: Bench, count: int, **seen: Any) -> None:
    """Result a query by what a picture shows that is taken now."""
    query = bench.next_goal(QUERY, count)
    bench.send(topics.OBJECT_POSE, m.ObjectPose(query_id=query.id, **{**SEEN, "seen_at": bench.now, **seen}))
    bench.step()


SEEN: dict[str, Any] = {"found": True, "label": "red mug", "position": TRAY, "on": "delivery tray"}


def ended(bench: Bench) -> m.MissionOutcome:
    bench.until(lambda: bench.state.last is not None)
    assert bench.state.last is not None
    return bench.state.last


def test_what_stands_where_it_belongs_is_delivered_and_the_look_is_evidence() -> None:
    bench = brought()
    query = bench.next_goal(QUERY, 2)
    assert (query.query, query.meant) == ("red mug", "object-1") and query.since > 0.0
    assert bench.state.state == "RELEASING" and bench.state.step == "check red mug"
    look(bench, 2)
    last = ended(bench)
    assert last.outcome == "delivered" and "the red mug is on the delivery tray, at (0.70, 0.00, 0.51)" in last.reason
    bench.until(lambda: "say Done." in bench.texts(SPEECH))


def test_a_fault_is_believed_when_a_second_picture_shows_it() -> None:
    bench = brought()
    look(bench, 2, tilt=LYING)
    assert bench.state.state == "RELEASING"
    look(bench, 3)
    assert ended(bench).outcome == "delivered"
    assert bench.texts(MANIP) == ["grab", "release"]


def test_what_lies_is_said_picked_up_and_put_right() -> None:
    bench = brought()
    for count in (2, 3, 4):
        look(bench, count, tilt=LYING)
    approach_again(bench, 2)
    grab = bench.manip(3)
    assert grab.object is not None and grab.object.tilt == LYING
    bench.did(grab)
    bench.drove(bench.nav(2))
    bench.did(bench.manip(4))
    show(bench, "open")
    look(bench, 5)
    assert ended(bench).outcome == "delivered"
    said = (
        "say I did not put down the red mug well: the red mug lies on its side on the delivery tray. I will try again."
    )
    assert said in bench.texts(SPEECH)


def test_what_two_pictures_show_lying_is_picked_up_though_a_third_shows_it_standing() -> None:
    bench = brought()
    for count, tilt in ((2, LYING), (3, LYING), (4, 0.0)):
        look(bench, count, tilt=tilt)
    approach_again(bench, 2)
    assert bench.manip(3).goal == "grab"


@pytest.mark.parametrize(("second", "outcome"), [("open", "delivered"), ("", "failed")])
def test_what_lay_and_does_not_show_how_it_stands_is_looked_at_from_aside(second: m.End, outcome: str) -> None:
    bench = brought()
    delivery = bench.brain.context.mission.delivery
    delivery.rests = {item: msgspec.structs.replace(rest, lay=True) for item, rest in delivery.rests.items()}
    show(bench, "")
    look(bench, 2)
    turned(bench)
    show(bench, second)
    look(bench, 3)
    last = ended(bench)
    assert last.outcome == outcome
    assert outcome == "delivered" or "I cannot tell whether the red mug on the delivery tray" in bench.texts(SPEECH)[-1]


def test_what_cannot_be_told_does_not_unsay_that_it_lies() -> None:
    bench = brought()
    delivery = bench.brain.context.mission.delivery
    delivery.rests = {item: msgspec.structs.replace(rest, lay=True) for item, rest in delivery.rests.items()}
    look(bench, 2, tilt=LYING)
    look(bench, 3)
    look(bench, 4, tilt=LYING)
    approach_again(bench, 2)
    assert bench.manip(3).goal == "grab"


def show(bench: Bench, top: m.End) -> None:
    """Perception tells what the upper end of the red mug is."""
    mug = m.WorldObject(label="red mug", kind="mug", colour="red", position=TRAY, id="object-1", top=top)
    bench.send(topics.WORLD_OBJECTS, m.WorldObjects(t=bench.now, objects=[mug]))
    bench.step()


def turned(bench: Bench, arrived: bool = True) -> m.NavGoal:
    """Result the turn that follows a look that did not show the object."""
    goal = bench.next_goal(POSE, 2)
    status, code = ("arrived", "") if arrived else ("failed", "UNREACHABLE")
    bench.send(topics.NAVIGATION_FEEDBACK, m.NavigationFeedback(goal_id=goal.id, status=status, code=code))
    bench.step()
    return goal


@pytest.mark.parametrize("arrived", [True, False])
def test_what_the_arm_may_hide_is_looked_for_from_aside(arrived: bool) -> None:
    bench = brought()
    look(bench, 2, found=False)
    x, y, theta = bench.brain.context.robot_pose
    goal = turned(bench, arrived)
    assert (goal.x, goal.y) == (x, y) and abs(goal.theta - theta) == pytest.approx(ASIDE)
    look(bench, 3)
    assert ended(bench).outcome == "delivered"
    assert bench.texts(MANIP) == ["grab", "release"]


def test_what_is_found_in_its_place_after_all_is_not_picked_up() -> None:
    bench = brought()
    look(bench, 2, found=False)
    turned(bench)
    look(bench, 3, found=False)
    look(bench, 4)
    assert ended(bench).outcome == "delivered"
    assert bench.texts(MANIP) == ["grab", "release"]


def test_what_never_gets_right_is_reported_and_never_claimed() -> None:
    bench = brought()
    count, drives, views, arms = 2, 1, 1, 2
    while bench.state.last is None:
        if bench.count(QUERY) >= count:
            look(bench, count, on="", position=(1.2, 0.3, 0.05))
            count += 1
        if bench.count(POSE) > views:
            views += 1
            approach_again(bench, views)
        if bench.count(topics.NAVIGATION_GOAL) > drives:
            drives += 1
            bench.drove(bench.nav(drives))
        if bench.count(MANIP) > arms:
            arms += 1
            bench.did(bench.manip(arms))
        bench.step()
    assert ended(bench).outcome == "failed" and "MISPLACED" in ended(bench).reason
    assert "COMPLETED" not in bench.states()
    assert bench.texts(MANIP) == ["grab", "release"] * (1 + BrainConfig().put_right_attempts)
    assert "on the floor" in bench.texts(SPEECH)[-1]


@pytest.mark.parametrize("answers", [False, True])
def test_a_plain_peer_that_does_not_look_costs_seconds_and_nothing_more_is_claimed(answers: bool) -> None:
    bench = brought(alive=False)
    asked = bench.next_goal(QUERY, 2)
    began = bench.now
    if answers:  # as it did before: where the mug once was
        bench.send(topics.OBJECT_POSE, m.ObjectPose(query_id=asked.id, found=True, label="red mug", position=TRAY))
    last = ended(bench)
    assert bench.now - began < BrainConfig().check_timeout + 3.0
    assert last.outcome == "delivered" and "red mug: not checked" in last.reason
    bench.until(lambda: bench.texts(SPEECH)[-1] == "say I put down the red mug, but I could not check where it is.")


def test_perception_that_lives_and_does_not_answer_is_an_error() -> None:
    bench = brought()
    last = ended(bench)
    assert last.outcome == "failed" and "UNCHECKED" in last.reason
    assert "COMPLETED" not in bench.states()
    assert bench.texts(SPEECH)[-1] == "say I put down the red mug, but I could not check where it is."


@pytest.mark.parametrize("alive", [False, True])
def test_the_fetch_pipeline_looks_where_perception_is_alive(alive: bool) -> None:
    bench = Bench(BrainConfig(pipeline="fetch"))
    if alive:
        with_perception(bench)
    bench.hear("bring me the red mug")
    bench.drove(bench.nav(1))
    bench.did(bench.manip(1))
    bench.drove(bench.nav(2))
    bench.did(bench.manip(2))
    if alive:
        for count in (1, 2):
            look(bench, count, found=False)
        bench.drove(bench.nav(3))
        bench.did(bench.manip(3))
        bench.drove(bench.nav(4))
        bench.did(bench.manip(4))
        look(bench, 3)
    bench.until(lambda: bench.state.state == "COMPLETED")
    assert bench.texts(MANIP) == ["grab", "release"] * (2 if alive else 1)
    assert bench.count(QUERY) == (3 if alive else 0)


def test_the_newest_pictures_are_kept_and_only_pictures(tmp_path: Path) -> None:
    told: list[str] = []
    pictures = Pictures(tmp_path / "pictures", told.append)
    names = [pictures.keep(f"m/{n}", START + bytes([n % 256])) for n in range(KEPT + 3)]
    assert pictures.load(names[0]) is None and pictures.load(names[-1]) == START + bytes([(KEPT + 2) % 256])
    assert len(list((tmp_path / "pictures").iterdir())) == KEPT
    assert pictures.keep("m", b"") == pictures.keep("m", b"MZ") == pictures.keep("m", START + bytes(LARGEST)) == ""
    assert pictures.load("../missions.db") is None and pictures.load("/etc/passwd") is None
    assert Pictures(None, told.append).keep("m", START) == "" and not told
    (tmp_path / "file").write_text("where the folder should be")
    assert Pictures(tmp_path / "file", told.append).keep("m", START) == "" and told
