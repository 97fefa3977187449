"""Words to an object: every way of telling several apart, and what is said when none or several are left."""

import math

import pytest

from common.floor_plan import Place, Receptacle, Room
from common.household import Household
from common.messages import WorldObject
from services.perception.grounding import Grounding, ground

SCENE = Household(
    name="small", low=(-5, -5), high=(5, 5), home=Place(name="home", x=0, y=0),
    rooms=(
        Room(name="hall", low=(-5, -5), high=(2.5, 5)),
        Room(name="study", low=(2.5, -5), high=(5, 5), aliases=("office",)),
    ),
    receptacles=(
        Receptacle(name="living table", kind="table", center=(1, 0, 1), size=(1, 1), aliases=("table",)),
        Receptacle(name="desk", kind="table", center=(3, 0, 1), size=(1, 1)),
    ),
)  # fmt: skip
HERE = (0.0, 0.0, 0.0)


def thing(
    label: str, x: float, y: float, on: str = "desk", size: float = 0.08, held: bool = False, confidence: float = 0.9
) -> WorldObject:
    colour, kind = label.split()
    return WorldObject(
        label=label, kind=kind, colour=colour, position=(x, y, 0.8), size=(size, 0.1, 0.1), on=on, held=held,
        id=f"{label} {x} {y}", confidence=confidence,
    )  # fmt: skip


# From the robot at the origin, facing +x: red left and near, white middle and farthest, blue right.
RED = thing("red mug", 1.0, 0.5, "living table", 0.07)
WHITE, BLUE = thing("white mug", 3.0, 0.0, size=0.09), thing("blue mug", 2.0, -0.6)
MUGS = [WHITE, BLUE, RED]


def meant(words: str, objects: list[WorldObject] = MUGS, base: tuple[float, float, float] = HERE) -> WorldObject | None:
    return ground(words, objects, SCENE, base, {}).found


@pytest.mark.parametrize(
    ("words", "which"),
    [
        ("left mug", RED), ("mug on the left", RED), ("mug left", RED), ("right mug", BLUE), ("mug at the right", BLUE),
        ("middle mug", WHITE), ("the mug in the middle", WHITE), ("nearest mug", RED), ("closest mug", RED),
        ("near mug", RED), ("far mug", WHITE), ("farthest mug", WHITE), ("big mug", WHITE), ("biggest mug", WHITE),
        ("large mug", WHITE), ("bigger mug", WHITE), ("small mug", RED), ("little mug", RED), ("smaller mug", RED),
        ("smallest mug", RED), ("mug on the living table", RED), ("mug from the table", RED),
        ("mug on top of the table", RED),
        ("mug in the study", WHITE), ("mug in the office", WHITE), ("left red mug", RED), ("right red mug", RED),
        ("big red mug", RED), ("nearest mug in the hall", RED), ("farthest mug in the hall", BLUE),
    ],
)  # fmt: skip
def test_side_distance_size_and_place_tell_them_apart(words: str, which: WorldObject) -> None:
    assert ground(words, MUGS, SCENE, HERE, {}) == Grounding(which, "", [])


def test_left_is_left_of_the_robot_and_near_is_near_to_it() -> None:
    behind = (4.0, 0.0, math.pi)
    assert meant("left mug", base=behind) == BLUE and meant("right mug", base=behind) == RED
    assert meant("nearest mug", base=behind) == WHITE and meant("farthest mug", base=behind) == RED
    aside = thing("green mug", 0.0, 1.2)
    assert meant("nearest mug", [RED, aside]) == RED and meant("farthest mug", [RED, aside]) == aside


def test_the_middle_one_of_four_is_right_of_the_middle() -> None:
    four = [thing("red mug", 1.0, y) for y in (0.4, -0.3, 0.1, -0.1)]
    assert meant("middle mug", four) == four[2]


@pytest.mark.parametrize("words", ["mug", "other mug", "mug on the desk"])
def test_several_are_named_in_order(words: str) -> None:
    names = ["blue mug", "white mug"] if "desk" in words else ["blue mug", "red mug", "white mug"]
    found = ground(words, MUGS, SCENE, HERE, {})
    assert (found.found, found.reason, found.candidates) == (None, f"several match: {', '.join(names)}", names)
    assert sorted(p.label for p in found.perhaps) == names, "which of them is meant can be asked"


def test_of_two_with_one_name_the_surer_is_meant() -> None:
    twins = [thing("red mug", x, 0.0, confidence=c) for x, c in ((1.0, 0.5), (2.0, 0.8), (3.0, 0.6))]
    assert meant("red mug", twins) == twins[1]


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ("", "no object was named"), ("the", "no object was named"), ("green mug", "no green mug is seen"),
        ("red mug on the desk", "no red mug is seen on the desk"),
        ("red mug in the office", "no red mug is seen on the study"),
        ("red can", "the red can is in the gripper"), ("can on the desk", "the can is in the gripper"),
        ("left sofa", "no sofa is seen"), ("big sofa", "no sofa is seen"),
    ],
)  # fmt: skip
def test_the_reason_is_told_when_none_is_left(words: str, reason: str) -> None:
    held = thing("red can", 0.5, 0.0, "", held=True)
    assert ground(words, [*MUGS, held], SCENE, HERE, {}) == Grounding(None, reason, [])


def test_what_is_held_is_not_one_of_several() -> None:
    held = thing("green mug", 0.5, 0.0, "", held=True)
    assert meant("mug", [RED, held]) == RED


def test_a_place_is_where_it_stands_or_the_room_it_is_in() -> None:
    lost = thing("red mug", 9.0, 9.0, "")
    assert meant("mug in the hall", [lost, BLUE]) == BLUE
    assert meant("mug in the study", [lost, BLUE]) is None
    assert meant("mug from the floor", [lost, BLUE]) == lost


def test_other_words_for_things_are_whole_words() -> None:
    found = ground("the Red Cup", MUGS, SCENE, HERE, {"cup": "mug", "beaker": "mug"})
    assert found.found == RED
    assert ground("red cupboard", MUGS, SCENE, HERE, {"cup": "mug"}).reason == "no red cupboard is seen"
    assert ground("red a.b", MUGS, SCENE, HERE, {"a.b": "mug"}).found == RED
    assert ground("red tea cup", MUGS, SCENE, HERE, {"Tea Cup": "mug"}).found == RED


def test_a_phrase_that_ends_with_no_place_is_all_about_the_thing() -> None:
    assert ground("mug near the moon", MUGS, SCENE, HERE, {}).reason == "no mug near moon is seen"
