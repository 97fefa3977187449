"""Words to objects, and objects over time."""

import math
from dataclasses import replace

import numpy as np
import pytest

from common.geometry import quat_yaw, yaw_quat
from common.household import load_household
from common.messages import WorldObject
from services.perception.detect import Detection
from services.perception.grounding import ground
from services.perception.tracking.association import lies_on_base
from services.perception.tracking.object_tracker import ObjectTracker
from services.perception.views.view import View

SCENE = load_household("apartment")
SYNONYMS = {"cup": "mug", "tin": "can"}


def known(label: str, x: float, y: float, on: str = "counter", held: bool = False) -> WorldObject:
    spec = SCENE.thing(label)
    assert spec is not None
    return WorldObject(
        label=label, kind=spec.kind, colour=spec.colour, position=(x, y, 0.8), orientation=yaw_quat(0.0),
        size=spec.size, on=on, held=held, id=label,
    )  # fmt: skip


WORLD = [
    known("red mug", 1.0, 0.5),
    known("blue mug", 1.0, -0.5),
    known("green can", 1.2, 0.0, "living table"),
    known("yellow bowl", 0.5, 0.2, "bookshelf"),
    known("blue bottle", 2.0, 0.0, "", held=True),
]


@pytest.mark.parametrize(
    ("words", "label"),
    [
        ("red mug", "red mug"),
        ("the red mug", "red mug"),
        ("red cup", "red mug"),
        ("blue one", "blue mug"),
        ("mug on the left", "red mug"),
        ("the left mug", "red mug"),
        ("the mug on the right", "blue mug"),
        ("nearest mug", "red mug"),
        ("bowl", "yellow bowl"),
        ("the bowl on the shelf", "yellow bowl"),
        ("tin", "green can"),
        ("mug on the table", ""),
        ("white mug", ""),
        ("sofa", ""),
        ("", ""),
    ],
)
def test_a_phrase_means_one_object_or_none(words: str, label: str) -> None:
    result = ground(words, WORLD, SCENE, (0.0, 0.0, 0.0), SYNONYMS)
    assert (result.found.label if result.found else "") == label
    assert bool(result.found) != bool(result.reason)


def test_several_matches_are_named_and_none_is_chosen() -> None:
    result = ground("mug", WORLD, SCENE, (0.0, 0.0, 0.0), SYNONYMS)
    assert result.found is None
    assert result.candidates == ["blue mug", "red mug"]


def test_left_and_right_are_the_robots() -> None:
    assert ground("left mug", WORLD, SCENE, (2.0, 0.0, math.pi), SYNONYMS).found is WORLD[1]


def test_what_the_hand_holds_is_not_offered() -> None:
    result = ground("blue bottle", WORLD, SCENE, (0.0, 0.0, 0.0), SYNONYMS)
    assert result.found is None
    assert "gripper" in result.reason


# --- memory


def detection(label: str, x: float, y: float, confidence: float = 0.9, distance: float = 1.0) -> Detection:
    spec = SCENE.thing(label)
    assert spec is not None
    return Detection(label, spec.kind, spec.colour, (x, y, 0.8), 0.0, spec.size, confidence, "counter", distance)


def empty_view(far: float = 3.0) -> View:
    """A camera at (0, 0, 1.3) that looks along x, slightly down, at nothing nearer than `far` metres."""
    return View(
        rgb=np.zeros((240, 320, 3), np.uint8),
        depth=np.full((240, 320), far, np.float32),
        focal=(200.0, 200.0),
        middle=(160.0, 120.0),
        position=np.array([0.0, 0.0, 1.3]),
        rotation=np.array([[0.0, -0.34, 0.94], [-1.0, 0.0, 0.0], [0.0, -0.94, -0.34]]),
    )


def test_looks_add_up_and_nearer_ones_count_more() -> None:
    tracker = ObjectTracker(SCENE, 3, 0.6)
    tracker.update(empty_view(), [detection("red mug", 1.00, 0.0, distance=3.0)], 1.0)
    tracker.update(empty_view(), [detection("red mug", 1.03, 0.0, distance=0.8)], 2.0)
    tracker.update(empty_view(), [detection("red mug", 1.00, 0.0, distance=3.0)], 3.0)
    (found,) = tracker.objects()
    assert abs(found.position[0] - 1.03) < 0.005
    assert found.seen_at == 3.0


def test_a_sliver_of_a_thing_neither_moves_nor_doubles_what_was_seen_whole() -> None:
    tracker = ObjectTracker(SCENE, 3, 0.6)
    tracker.update(empty_view(), [detection("yellow bowl", 4.0, 1.0, 0.97, distance=1.2)], 0.0)
    for t, aside in ((1.0, 0.04), (2.0, 0.13)):
        sliver = replace(detection("yellow bowl", 4.0 + aside, 1.0, 0.5, distance=0.7), whole=False, share=0.03)
        tracker.update(empty_view(), [sliver], t)
    bowl = next(o for o in tracker.objects() if o.label == "yellow bowl")
    assert math.dist(bowl.position[:2], (4.0, 1.0)) < 0.002


def test_one_wrong_name_does_not_rename() -> None:
    tracker = ObjectTracker(SCENE, 3, 0.6)
    for t in range(3):
        tracker.update(empty_view(), [detection("red mug", 1.0, 0.0)], float(t))
    tracker.update(empty_view(), [detection("red can", 1.0, 0.0, confidence=0.7)], 3.0)
    assert [o.label for o in tracker.objects()] == ["red mug"]


def test_a_doubtful_sighting_is_not_reported() -> None:
    tracker = ObjectTracker(SCENE, 3, 0.6)
    tracker.update(empty_view(), [detection("white mug", 1.0, 0.0, confidence=0.2, distance=3.0)], 0.0)
    assert tracker.objects() == []


def test_a_thing_is_gone_after_looks_through_its_place_only() -> None:
    tracker = ObjectTracker(SCENE, 3, 0.6)
    tracker.update(empty_view(), [detection("red mug", 1.2, 0.0)], 0.0)
    for t in range(5):
        tracker.update(empty_view(far=0.8), [], 1.0 + t)  # something stands in front
    assert len(tracker.objects()) == 1
    for t in range(3):
        tracker.update(empty_view(far=3.0), [], 10.0 + t)
    assert tracker.objects() == []


def test_a_moved_thing_is_in_its_new_place_only() -> None:
    tracker = ObjectTracker(SCENE, 3, 0.6)
    tracker.update(empty_view(), [detection("red mug", 1.2, 0.0)], 0.0)
    tracker.update(empty_view(far=0.5), [detection("red mug", 1.2, 0.8)], 5.0)
    (found,) = tracker.objects()
    assert found.position[1] == 0.8


@pytest.mark.parametrize(("beyond", "believed"), [(1.1, False), (3.0, True)])
def test_a_poorer_view_moves_a_thing_only_where_its_place_is_empty(beyond: float, believed: bool) -> None:
    tracker = ObjectTracker(SCENE, 3, 0.6)
    tracker.update(empty_view(), [detection("red mug", 1.2, 0.0, distance=0.9)], 0.0)
    tracker.update(empty_view(far=beyond), [detection("red mug", 1.1, 0.04, distance=2.0)], 5.0)
    (found,) = tracker.objects()
    assert (found.position[0] == 1.1) == believed and found.seen_at == 5.0


def test_a_held_thing_moves_with_the_hand_and_stays_where_it_is_let_go() -> None:
    tracker = ObjectTracker(SCENE, 3, 0.6)
    tracker.update(empty_view(), [detection("red mug", 1.2, 0.0)], 0.0)
    tracker.carry((1.2, 0.0, 0.82), True, 1.0)
    tracker.carry((0.4, 0.0, 0.9), True, 2.0)
    (held,) = tracker.objects()
    assert held.held and held.position == (0.4, 0.0, 0.9)
    tracker.carry((0.7, 0.1, 0.52), False, 3.0)
    (found,) = tracker.objects()
    assert not found.held and found.on == "delivery tray"


def test_what_falls_on_the_way_is_looked_for_where_the_hand_was() -> None:
    tracker = ObjectTracker(SCENE, 3, 0.6)
    tracker.update(empty_view(), [detection("red mug", 1.2, 0.0)], 0.0)
    tracker.carry((1.2, 0.0, 0.82), True, 1.0)
    tracker.carry((0.3, 0.0, 0.5), False, 2.0)
    assert [o.position[:2] for o in tracker.objects()] == [(0.3, 0.0)]


def test_what_falls_before_the_base_is_nowhere_until_it_is_seen() -> None:
    tracker = ObjectTracker(SCENE, 3, 0.6)
    tracker.update(empty_view(), [detection("red mug", 1.2, 0.0)], 0.0)
    tracker.carry((1.2, 0.0, 0.82), True, 1.0)
    assert tracker.carry((0.3, 0.0, 0.5), False, 2.0, working=True), "the change is told"
    assert tracker.objects() == []
    tracker.update(empty_view(), [detection("red mug", 0.6, 0.3)], 3.0)
    assert [o.position[:2] for o in tracker.objects()] == [(0.6, 0.3)]


@pytest.mark.parametrize(("x", "on", "carried"), [(3.2, "", True), (3.5, "", False), (3.2, "delivery tray", False)])
def test_what_seems_to_be_on_the_floor_where_the_base_stands_lies_on_it(x: float, on: str, carried: bool) -> None:
    assert lies_on_base(replace(detection("red mug", x, 1.0), on=on), (3.0, 1.0, 0.5)) is carried


def test_after_fingers_that_closed_on_nothing_any_look_says_better_where_a_thing_is() -> None:
    tracker = ObjectTracker(SCENE, 3, 0.6)
    tracker.update(empty_view(), [detection("red mug", 1.2, 0.0, distance=0.3)], 0.0)
    poorer = [detection("red mug", 1.14, 0.0, distance=1.5)]
    tracker.update(empty_view(far=1.1), poorer, 1.0)
    tracker.missed((1.2, 0.5, 0.82))
    tracker.update(empty_view(far=1.1), poorer, 2.0)
    assert [o.position[0] for o in tracker.objects()] == [1.2], "the hand was elsewhere"
    tracker.missed((1.2, 0.0, 0.82))
    tracker.update(empty_view(far=1.1), poorer, 3.0)
    assert [o.position[0] for o in tracker.objects()] == [1.14]


def test_a_closed_hand_far_from_everything_holds_nothing_known() -> None:
    tracker = ObjectTracker(SCENE, 3, 0.6)
    tracker.update(empty_view(), [detection("red mug", 1.2, 0.0)], 0.0)
    tracker.carry((0.0, 1.0, 0.9), True, 1.0)
    assert [o.held for o in tracker.objects()] == [False]


def test_a_handle_that_was_seen_stays_where_it_is_while_it_is_hidden() -> None:
    tracker = ObjectTracker(SCENE, 3, 0.6)
    view = empty_view()
    seen, hidden = detection("red mug", 1.0, 0.5), replace(detection("red mug", 1.0, 0.5), yaw=1.5, yaw_seen=False)

    def yaw(d: Detection) -> float:
        tracker.update(view, [d], 1.0)
        return quat_yaw(tracker.objects()[0].orientation)

    moved = replace(hidden, position=(1.09, 0.5, 0.8))
    assert yaw(hidden) == pytest.approx(1.5), "a guess is better than nothing"
    assert [yaw(d) for d in (replace(seen, yaw=-0.6), hidden, moved)] == pytest.approx([-0.6, -0.6, 1.5])
