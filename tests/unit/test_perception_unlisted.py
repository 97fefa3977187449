"""Objects that nobody listed, over time: one track each, fused extents, labels that are unique and stay."""

import math
from dataclasses import replace

import numpy as np
import pytest

from common.geometry import quat_yaw
from common.household import load_household, mapped
from common.messages import WorldObject
from common.naming.names import match_object
from services.perception.detection import Detection
from services.perception.grounding import may_be_meant
from services.perception.tracking import object_tracker
from services.perception.tracking.object_tracker import ObjectTracker
from services.perception.views.view import View

SCENE = load_household("apartment")
NOTHING_LISTED = mapped(SCENE)


def sighting(
    x: float, y: float, kinds: dict[str, float], colours: dict[str, float], spread: float = 0.004
) -> Detection:
    return Detection(
        label="", kind=next(iter(kinds)), colour=next(iter(colours)), position=(x, y, 0.81), yaw=0.0,
        size=(0.07, 0.07, 0.1), confidence=0.9, on="counter", distance=1.2, known=False, shape="round", kinds=kinds,
        colours=colours, spread=spread, points=np.array([[x - 0.035, y, 0.8], [x, y, 0.86]]),
    )  # fmt: skip


def looking(x: float, y: float) -> View:
    """A view that shows nothing: no depth anywhere."""
    return View(
        np.zeros((48, 64, 3), np.uint8), np.zeros((48, 64), np.float32), (50.0, 50.0), (32.0, 24.0),
        np.array([x, y, 1.3]), np.eye(3),
    )  # fmt: skip


def seen(*views: list[Detection]) -> tuple[ObjectTracker, list[WorldObject]]:
    tracker = ObjectTracker(SCENE, 3, 0.6)
    for n, detections in enumerate(views):
        tracker.update(looking(0.0, 0.0), detections, float(n))
    return tracker, tracker.objects()


MUG, CAN = {"can": 0.55, "mug": 0.45}, {"can": 1.0}
RED, BLUE = {"red": 0.8, "white": 0.2}, {"blue": 1.0}


def test_what_looks_alike_gets_labels_of_its_own_that_stay() -> None:
    tracker, first = seen([sighting(4.0, -3.0, CAN, RED), sighting(4.4, -3.0, CAN, RED)])
    assert [o.label for o in first] == ["red can", "red can 2"]
    # A third view sees them in the other order, and one more between.
    third = [sighting(4.4, -3.0, CAN, RED), sighting(4.2, -3.0, CAN, RED), sighting(4.0, -3.0, CAN, RED)]
    for n in (3, 4):
        tracker.update(looking(0.0, 0.0), third, float(n))
    places = {o.label: o.position[0] for o in tracker.objects()}
    assert places == {"red can": pytest.approx(4.0), "red can 2": pytest.approx(4.4), "red can 3": pytest.approx(4.2)}


def test_of_two_that_take_up_one_space_the_one_that_is_told_of_stands_for_the_other() -> None:
    tracker, first = seen([sighting(4.0, -3.0, CAN, BLUE)], [sighting(4.0, -3.0, CAN, BLUE)])
    for n in (3, 4, 5):
        tracker.update(looking(0.0, 0.0), [sighting(4.035, -2.97, CAN, RED)], float(n))
    # From elsewhere the two are seen to be one.
    tracker.update(looking(0.0, 0.0), [replace(sighting(4.03, -2.98, CAN, RED), size=(0.12, 0.12, 0.1))], 6.0)
    (only,) = tracker.objects()
    assert only.id != first[0].id and tracker.told_as(first[0].id) == only.id == tracker.told_as(only.id)
    assert tracker.told_as("object-9") == "object-9"


@pytest.mark.parametrize(("high", "one"), [(0.008, True), (0.04, False)], ids=["its handle", "lies on it"])
def test_what_lies_flat_within_another_is_a_part_of_it(high: float, one: bool) -> None:
    def flat(x: float, size: tuple[float, float, float], colours: dict[str, float]) -> Detection:
        lies = sighting(x, -3.0, {"tool": 1.0}, colours)
        return replace(lies, size=size, position=(x, -3.0, 0.76 + size[2] / 2), shape="box")

    glass, handle = flat(4.0, (0.18, 0.07, 0.02), RED), flat(4.07, (0.05, 0.02, high), BLUE)
    tracker, objects = seen([glass], [handle, glass], [handle, glass])
    assert len(objects) == 2 - one
    assert (tracker.told_as("object-2") == "object-1") is one


def test_what_is_seen_where_another_was_lost_stands_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    tracker, first = seen([sighting(4.0, -3.0, CAN, BLUE)], [sighting(4.0, -3.0, CAN, BLUE)])
    monkeypatch.setattr(object_tracker, "should_show", lambda track, view: True)
    for n in (3, 4, 5):
        tracker.update(looking(0.0, 0.0), [], float(n))
    assert tracker.objects() == [] and tracker.told_as(first[0].id) == first[0].id
    tracker.update(looking(0.0, 0.0), [sighting(4.02, -3.0, CAN, RED)], 6.0)
    assert tracker.told_as(first[0].id) == tracker.objects()[0].id != first[0].id


def test_a_label_stays_until_another_kind_is_much_likelier() -> None:
    tracker, first = seen([sighting(4.0, -3.0, MUG, RED)])
    assert first[0].label == "red can"
    assert first[0].kinds == ["can", "mug"]
    tracker.update(looking(0.0, 0.0), [sighting(4.0, -3.0, {"mug": 0.6, "can": 0.4}, RED)], 1.0)
    assert tracker.objects()[0].label == "red can"
    for n in range(2, 8):
        tracker.update(looking(0.0, 0.0), [sighting(4.0, -3.0, {"mug": 1.0}, RED)], float(n))
    assert tracker.objects()[0].label == "red mug"


def test_neighbours_that_nearly_touch_stay_two_whatever_was_seen_of_one_of_them() -> None:
    both = [sighting(4.0, -3.0, CAN, RED), sighting(4.075, -3.0, CAN, BLUE)]
    tracker, _ = seen(both, both)
    tracker.update(looking(0.0, 0.0), [sighting(4.07, -3.0, CAN, BLUE)], 2.0)
    assert {o.label: round(o.position[0], 2) for o in tracker.objects()} == {"red can": 4.0, "blue can": 4.07}


def test_views_are_fused_and_the_surer_one_counts_more() -> None:
    rough = replace(sighting(4.0, -3.0, CAN, RED, spread=0.01), size=(0.09, 0.09, 0.1))
    fine = replace(sighting(4.0, -3.0, CAN, RED, spread=0.003), size=(0.07, 0.07, 0.1))
    _, [o] = seen([rough], [fine])
    assert o.size[0] == pytest.approx(0.0717, abs=0.001)
    assert o.spread < 0.003
    assert o.measured


def test_a_box_seen_from_the_side_keeps_its_axes() -> None:
    front = replace(sighting(4.0, -3.0, {"box": 1.0}, RED), shape="box", size=(0.11, 0.08, 0.1), yaw=0.1)
    # Its hidden depth came out longer than its width: the longer side is now across.
    side = replace(front, size=(0.1, 0.09, 0.1), yaw=0.1 + math.pi / 2)
    _, [o] = seen([front], [side])
    assert o.size[0] == pytest.approx(0.10, abs=0.002)
    assert o.size[1] == pytest.approx(0.09, abs=0.002)


def test_points_travel_relative_to_the_object() -> None:
    _, [o] = seen([sighting(4.0, -3.0, CAN, RED)])
    points = np.frombuffer(o.points, "<i2").reshape(-1, 3)
    assert sorted(points.tolist()) == [[-35, 0, -10], [0, 0, 50]]


def test_views_that_place_it_differently_show_one_surface() -> None:
    first, second = (sighting(x, -3.0, CAN, BLUE) for x in (4.0, 4.02))

    def across(*views: Detection) -> set[int]:
        _, [o] = seen(*([view] for view in views))
        return set(np.frombuffer(o.points, "<i2").reshape(-1, 3)[:, 0].tolist())

    assert across(first, second) == {-35, 0}
    part = replace(second, size=(0.03, 0.07, 0.1), whole=False)
    assert len(across(first, part)) > 2, "the middle of a part is not that of the whole"


def test_pieces_of_one_object_are_reported_once() -> None:
    part = replace(sighting(4.02, -3.0, CAN, BLUE), size=(0.03, 0.03, 0.05), confidence=0.3, whole=False)
    _, found = seen([sighting(4.0, -3.0, CAN, RED)], [part], [sighting(4.0, -3.0, CAN, RED)])
    assert len(found) == 1


def unlisted(label: str, kinds: list[str], colours: list[str]) -> WorldObject:
    colour, kind = label.split()[:2]
    return WorldObject(
        label=label, kind=kind, colour=colour, position=(1.0, 0.0, 0.8), kinds=kinds, colours=colours, id=label,
        measured=True,
    )  # fmt: skip


SEEN = [
    unlisted("red can", ["can", "mug", "jar"], ["red"]),
    unlisted("green can", ["can", "bottle"], ["green", "white"]),
    unlisted("orange ball", ["ball", "orange"], ["orange"]),
    unlisted("blue can", ["can"], ["blue"]),
]


@pytest.mark.parametrize(
    ("words", "labels"),
    [
        ("green bottle", ["green can"]),
        ("mug", ["red can"]),
        ("red mug", ["red can"]),
        ("white can", ["green can"]),
        ("something blue", ["blue can"]),
        ("orange", ["orange ball"]),
        ("red ball", []),
        ("orange can", []),
        ("yellow apple", []),
        ("can", ["red can", "green can", "blue can"]),
        ("blue can", ["blue can"]),
        ("black box", []),
        ("something", []),
        ("plate", []),
    ],
)
def test_words_mean_what_they_fit_best_by_its_looks(words: str, labels: list[str]) -> None:
    assert [o.label for o in match_object(words, SEEN, NOTHING_LISTED)] == labels


def test_what_was_seen_from_afar_may_be_what_is_asked_for_and_what_was_seen_near_is_not() -> None:
    far = replace(sighting(4.0, -3.0, CAN, RED), distance=2.4)
    tracker, found = seen([far, sighting(4.4, -3.0, CAN, RED)], [far, sighting(4.4, -3.0, CAN, RED)])
    assert may_be_meant("red bottle", found, tracker.doubtful(), NOTHING_LISTED, (0.0, 0.0, 0.0)) == ["red can"]
    assert may_be_meant("bottle", found, tracker.doubtful(), NOTHING_LISTED, (0.0, 0.0, 0.0)) == ["red can"]
    assert may_be_meant("green bottle", found, tracker.doubtful(), NOTHING_LISTED, (0.0, 0.0, 0.0)) == []
    # From nearer it is a can for certain, however often it was seen from afar.
    for n in range(2, 9):
        tracker.update(looking(0.0, 0.0), [far], float(n))
    tracker.update(looking(0.0, 0.0), [sighting(4.0, -3.0, CAN, RED)], 9.0)
    assert not tracker.doubtful()


def test_a_ball_is_meant_by_no_word_for_what_stands_on_a_foot() -> None:
    position = (0.0, 0.0, 0.5)
    ball = WorldObject(label="blue ball", kind="ball", colour="blue", position=position, kinds=["ball", "apple", "can"])
    can = WorldObject(label="blue can", kind="can", colour="blue", position=position, kinds=["can", "ball"])
    household = NOTHING_LISTED
    assert match_object("blue can", [ball], household) == []
    assert match_object("blue ball", [can], household) == []
    assert match_object("blue apple", [ball], household) == [ball]


def test_what_lay_with_an_opening_and_is_closed_above_stands_on_its_mouth() -> None:
    lies = replace(sighting(4.0, -3.0, MUG, RED), tilt=math.pi / 2, size=(0.1, 0.07, 0.07), end="open")
    stands = replace(sighting(4.0, -3.0, CAN, RED), end="closed")
    assert seen([lies], [lies], [stands])[1][0].tilt == pytest.approx(math.pi)
    assert seen([lies], [lies], [replace(stands, end="open")])[1][0].tilt == 0.0
    # A can that lay showed no opening: its lid is above.
    assert seen([replace(lies, end="closed")], [stands])[1][0].tilt == 0.0


def test_an_axis_whose_upper_end_is_not_seen_keeps_its_direction() -> None:
    lies = replace(sighting(4.0, -3.0, CAN, RED), tilt=math.pi / 2, yaw=0.3, size=(0.1, 0.07, 0.07))
    guess = replace(lies, yaw=0.3 - math.pi + 0.04, yaw_seen=False)
    tracker, _ = seen([lies], [guess])
    (found,) = tracker.objects()
    assert quat_yaw(found.orientation) == pytest.approx(0.34, abs=0.05)


@pytest.mark.parametrize(
    ("height", "working", "looks"), [(1.2, True, 3), (0.81, False, 3), (0.81, False, 0)],
    ids=["high up", "as it was lifted", "at once"],
)  # fmt: skip
def test_what_fell_from_the_hand_is_the_same_where_it_is_seen_again(height: float, working: bool, looks: int) -> None:
    tracker, [before] = seen([sighting(4.0, -3.0, CAN, RED)])
    for at in (0.81, height):
        tracker.carry((4.0, -3.0, at), True, 1.0)
    tracker.carry((4.0, -3.0, height), False, 2.0, working=working)
    down = View(
        np.zeros((480, 640, 3), np.uint8), np.full((480, 640), 2.0, np.float32), (550.0, 550.0), (320.0, 240.0),
        np.array([4.0, -3.0, 2.3]), np.diag([1.0, -1.0, -1.0]),
    )  # fmt: skip
    for n in range(looks):
        tracker.update(down, [], 30.0 + n)
    lies = replace(sighting(4.3, -2.4, CAN, RED), position=(4.3, -2.4, 0.035), on="", size=(0.1, 0.09, 0.09))
    others = [replace(lies, position=(5.2, -2.4, 0.035)), replace(lies, position=(4.38, -2.88, 0.5), on="tray")]
    tracker.update(down, [*others, lies], 40.0)
    assert {o.position[0]: o.id == before.id for o in tracker.objects()} == {4.3: True, 4.38: False, 5.2: False}
