"""Words to an object: every way of telling several apart, and what is said when none or several are left."""

import math
from typing import Any

import msgspec
import pytest

from common.floor_plan import Box, Place, Receptacle, Room
from common.household import Household
from common.messages import WorldObject
from common.naming.likeness import PLAIN, likeness, partly
from services.perception.grounding import Grounding, Phrase, as_called, ground, may_be_meant, parsed, possible

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


@pytest.mark.parametrize(
    "words",
    ["mug that's on the study floor", "mug which is lying on the floor of the office", "mug on the floor in the study"],
)
def test_the_floor_of_a_room_is_a_place(words: str) -> None:
    there, elsewhere = thing("grey mug", 3.5, 2.0, on=""), thing("grey mug", -2.0, 2.0, on="")
    assert parsed(words, SCENE, {}) == Phrase("mug", "study floor")
    assert meant(words, [elsewhere, WHITE, there]) == there
    assert meant(words, [elsewhere, WHITE]) is None


@pytest.mark.parametrize("words", ["mug on the sofa", "mug from the couch", "mug on the sofa seat"])
def test_a_piece_of_furniture_is_a_place(words: str) -> None:
    seat = Box(name="sofa seat", center=(-2.0, 0.0, 0.2), size=(0.9, 1.9, 0.4))
    before = Place(name="sofa", x=-1.0, y=0.0, aliases=("couch",))
    home = msgspec.structs.replace(SCENE, furniture=(seat,), places=(before,))
    there = thing("grey mug", -2.0, 0.0, on="sofa seat")
    assert parsed(words, home, {}) == Phrase("mug", "sofa seat")
    assert ground(words, [RED, there], home, HERE, {}).found == there


def test_other_words_for_things_are_whole_words() -> None:
    found = ground("the Red Cup", MUGS, SCENE, HERE, {"cup": "mug", "beaker": "mug"})
    assert found.found == RED
    assert ground("red cupboard", MUGS, SCENE, HERE, {"cup": "mug"}).reason == "no red cupboard is seen"
    assert ground("red a.b", MUGS, SCENE, HERE, {"a.b": "mug"}).found == RED
    assert ground("red tea cup", MUGS, SCENE, HERE, {"Tea Cup": "mug"}).found == RED


def test_a_phrase_that_ends_with_no_place_is_all_about_the_thing() -> None:
    assert ground("mug near the moon", MUGS, SCENE, HERE, {}).reason == "no mug near moon is seen"


# --- what perception measured: nobody told what it is
def seen(
    label: str, x: float, y: float, shares: dict[str, float], colours: dict[str, float], **more: Any
) -> WorldObject:
    """An object known by its looks alone; `shares` of kinds and `colours`, the likeliest first."""
    return WorldObject(
        label=label, kind=next(iter(shares)), colour=next(iter(colours)), position=(x, y, 0.8), id=f"{label} {x} {y}",
        kinds=list(shares), colours=list(colours), kind_shares=shares, colour_shares=colours, measured=True,
        **{"size": (0.08, 0.08, 0.1), "on": "desk", **more},
    )  # fmt: skip


MUG = {"mug": 0.8, "can": 0.2}
RED_MUG = seen("red mug", 3.0, 0.0, MUG, {"red": 1.0})


def test_the_name_of_one_fits_its_numbered_twin_as_well() -> None:
    twin = seen("red mug 2", 2.0, 0.0, MUG, {"red": 1.0})
    others = [seen("red mug 3", 2.0, 0.5, MUG, {"red": 1.0}, held=True), BLUE]
    found = ground("red mug", [RED_MUG, twin, *others], SCENE, HERE, {})
    assert found.candidates == ["red mug", "red mug 2"] and found.found is None
    assert ground("red mug 2", [RED_MUG, twin], SCENE, HERE, {}).found == twin
    assert ground("red mug", [RED_MUG, twin], SCENE, HERE, {}, least=0.0).found == RED_MUG, "the words are its name"


def test_what_does_not_plainly_fit_is_not_meant_and_that_is_told() -> None:
    doubt = seen("red can", 3.0, 0.0, {"can": 0.5, "mug": 0.5}, {"red": 1.0})
    found = ground("mug", [doubt], SCENE, HERE, {})
    assert found == Grounding(None, "the red can may be the mug")
    fit = likeness("mug", doubt, SCENE)
    assert 0.0 < fit < PLAIN
    assert ground("mug", [doubt], SCENE, HERE, {}, least=fit).found == doubt, "as much as is asked for is enough"
    assert ground("mug", [doubt], SCENE, HERE, {}, lambda noun, known: list(known), least=0.0).found == doubt
    # Nothing is known against what other means than looks found: its name, its print.
    assert ground("vitamins", [doubt], SCENE, HERE, {}, lambda noun, known: list(known)).found == doubt


def test_one_alone_needs_no_size_and_no_side() -> None:
    assert ground("other red mug", [RED_MUG], SCENE, HERE, {}).found == RED_MUG
    assert ground("left small red mug", [RED_MUG], SCENE, HERE, {}).found == RED_MUG


def test_size_is_volume() -> None:
    flat = thing("red mug", 1.0, 0.0)
    flat.size = (0.3, 0.3, 0.01)
    tall = thing("blue mug", 2.0, 0.0)
    tall.size = (0.05, 0.05, 0.3)
    cube = thing("white mug", 3.0, 0.0)
    cube.size = (0.1, 0.1, 0.1)
    assert meant("small mug", [flat, cube, tall]) == tall and meant("big mug", [tall, flat, cube]) == cube
    long = thing("green mug", 3.0, 0.0)
    long.size = (0.05, 0.4, 0.1)
    assert meant("big mug", [cube, long]) == long


def test_the_parts_of_a_phrase() -> None:
    assert parsed("the small red mug on the left", SCENE, {}) == Phrase("red mug", "", "small", "left")
    assert parsed("red mug", SCENE, {}) == Phrase("red mug", "", "", "")
    assert parsed("left", SCENE, {}).thing == "left", "a side of nothing is a word like others"


def test_what_may_be_meant_comes_likeliest_first_with_what_a_person_is_asked_by() -> None:
    can = seen("red can", 2.0, 1.0, {"can": 0.7, "mug": 0.3}, {"red": 1.0}, on="")
    blue = seen("blue mug", 1.0, 0.0, MUG, {"blue": 1.0})
    held = seen("red mug 4", 1.0, 0.0, MUG, {"red": 1.0}, held=True)
    rows = possible(parsed("red mug", SCENE, {}), [can, blue, held, RED_MUG], SCENE)
    assert [(r.id, r.label, r.position, r.on) for r in rows] == [
        (RED_MUG.id, "red mug", RED_MUG.position, "desk"), (can.id, "red can", can.position, ""),
    ]  # fmt: skip
    assert rows[0].likeness == 1.0 and rows[1].likeness == round(likeness("red mug", can, SCENE), 3) == 0.429
    assert [r.id for r in possible(parsed("red mug in the study", SCENE, {}), [can, RED_MUG], SCENE)] == [RED_MUG.id]


def test_as_little_as_counts_is_enough_to_be_asked_about() -> None:
    """A mug of which so much is another colour that it fits by just as much as is needed."""
    near = seen("orange mug", 1.0, 0.0, {"mug": 1.0}, {"orange": 1.0})
    assert possible(parsed("red mug", SCENE, {}), [near], SCENE)[0].likeness == 0.15
    far = seen("orange can", 1.0, 0.0, {"can": 1.0}, {"orange": 1.0})
    assert possible(parsed("red mug", SCENE, {}), [far], SCENE) == [], "colour and kind would have to be mistaken"


def test_words_that_say_nothing_seen_are_asked_about() -> None:
    striped = parsed("striped mug", SCENE, {})
    assert [r.likeness for r in possible(striped, [RED_MUG], SCENE)] == [partly("striped mug", RED_MUG, SCENE)]


def test_what_is_in_doubt_may_be_meant_where_its_colour_can_be() -> None:
    ids = {RED_MUG.id, BLUE.id, WHITE.id}
    near = seen("orange can", 1.0, 0.0, {"can": 1.0}, {"orange": 0.9, "white": 0.1})
    held = seen("red can", 0.5, 0.0, {"can": 1.0}, {"red": 1.0}, held=True)
    known = [RED_MUG, near, held, BLUE]
    doubtful = {near.id, held.id, *ids}
    assert may_be_meant("the red box", known, doubtful, SCENE, HERE) == ["orange can", "red mug"], "nearest first"
    assert may_be_meant("red box", known, ids, SCENE, HERE) == ["red mug"], "only what is in doubt"
    assert may_be_meant("white box", known, doubtful, SCENE, HERE) == ["orange can"], "a second colour counts"
    assert may_be_meant("red and white box", known, doubtful, SCENE, HERE) == ["orange can"], "all that are named"
    assert may_be_meant("box", known, doubtful, SCENE, HERE) == ["orange can", "blue mug", "red mug"]
    odd = WorldObject(label="thing", kind="", colour="", position=(0.0, 0.0, 5.0), id="odd")
    assert may_be_meant("red box", [odd], {"odd"}, SCENE, HERE) == [], "what has no colour is not red"
    assert may_be_meant("box", [RED_MUG, odd], {"odd", *ids}, SCENE, HERE) == ["thing", "red mug"], "on the floor plan"


def test_the_words_of_the_household_for_a_colour_count() -> None:
    words = msgspec.structs.replace(SCENE.words, colours={**SCENE.words.colours, "red": ("crimson",)})
    told = msgspec.structs.replace(SCENE, words=words)
    assert may_be_meant("crimson box", [RED_MUG, BLUE], {RED_MUG.id, BLUE.id}, told, HERE) == ["red mug"]


def test_a_thing_called_by_its_label_alone_may_be_nothing_else() -> None:
    called = as_called(RED_MUG)
    assert (called.kinds, called.colours, called.kind_shares, called.colour_shares) == ([], [], {}, {})
    assert (called.id, called.label, called.measured) == (RED_MUG.id, "red mug", True)
    assert as_called(RED_MUG) is not RED_MUG and RED_MUG.kinds == ["mug", "can"]
