"""Plans against the known world: what is possible passes, what is not is refused in words that can be spoken."""

import msgspec
import pytest

from common.floor_plan import Box, Place, Receptacle, Room
from common.household import Household
from common.messages import AROUND, KnownWorld, PlanStep
from common.plan_rules import MAX_STEPS, OPENING, is_destination, known_world, objection
from common.thing import Thing

COLOUR = (1.0, 0.0, 0.0, 1.0)


def spec(name: str, kind: str, width: float, *aliases: str) -> Thing:
    size = (width, width, 0.3)
    return msgspec.convert(
        {"name": name, "kind": kind, "colour": "red", "size": size, "rgba": COLOUR, "aliases": aliases},
        Thing,
    )


SCENE = Household(
    name="small", low=(-1, -1), high=(1, 1), home=Place(name="home", x=0, y=0, aliases=("dock",)),
    places=(Place(name="sofa", x=1, y=0, aliases=("couch",)), Place(name="hall", x=0, y=1)),
    rooms=(
        Room(name="hall", low=(0, 0), high=(1, 1)), Room(name="study", low=(-1, 0), high=(0, 1), aliases=("office",)),
    ),
    furniture=(Box(name="wine fridge", center=(0, 0, 1), size=(1, 1, 2), rgba=COLOUR),),
    receptacles=(
        Receptacle(name="desk", kind="table", center=(0, 0, 1), size=(1, 1), aliases=("bureau",)),
        Receptacle(name="bin", kind="bin", center=(0, 0, 0), size=(1, 1), depth=0.4),
    ),
    things=(
        spec("red mug", "mug", OPENING, "red cup"), spec("crate", "box", OPENING + 0.001),
        spec("red bowl", "bowl", 0.2),
    ),
)  # fmt: skip


def find(thing: str) -> PlanStep:
    return PlanStep(action="find", object=thing)


def grasp(thing: str) -> PlanStep:
    return PlanStep(action="grasp", object=thing)


def place(target: str) -> PlanStep:
    return PlanStep(action="place", target=target)


def beside(target: str, near: str) -> PlanStep:
    return PlanStep(action="place", target=target, near=near)


def rule(thing: str, target: str) -> PlanStep:
    return PlanStep(action="rule", object=thing, target=target)


def go(target: str = "", thing: str = "") -> PlanStep:
    return PlanStep(action="navigate", target=target, object=thing)


def say(text: str) -> PlanStep:
    return PlanStep(action="say", text=text)


RELEASE, RETURN, WAIT = PlanStep(action="release"), PlanStep(action="return"), PlanStep(action="wait")
MUG = (find("red mug"), grasp("red mug"))
CLOSE, OPEN = (PlanStep(action=action, target="gripper") for action in ("grasp", "release"))  # type: ignore[arg-type]
NOTHING = "step {}: there is nothing in the hand to release"


@pytest.mark.parametrize(
    ("steps", "held", "seen", "reason"),
    [
        ((*MUG, RETURN, RELEASE), "", (), ""),
        ((find("red cup"), grasp("red mug"), place("bureau")), "", (), ""),
        ((find("red mug"), grasp("red cup"), place("bin")), "", (), ""),
        ((find("red bowl"), grasp("red bowl")), "", (), ""),
        ((find("mug"), grasp("mug")), "", (), ""),
        ((find("thimble"), grasp("thimble")), "", ("thimble",), ""),
        ((*MUG, RELEASE, *MUG, place("desk"), *MUG), "", (), ""),
        ((RELEASE,), "apple", (), ""),
        ((place("desk"),), "apple", (), ""),
        ((go("dock"), go("couch"), go("office"), go("bureau"), go("red mug"), go(thing="mug")), "", (), ""),
        ((say("hello"), WAIT), "", (), ""),
        ((WAIT,) * MAX_STEPS, "", (), ""),
        ((), "", (), "the plan has no steps"),
        ((WAIT,) * (MAX_STEPS + 1), "", (), "the plan has 61 steps"),
        ((grasp("red mug"),), "", (), "step 1: the red mug must be found before it can be grasped"),
        ((find("mug"), grasp("red mug")), "", (), "step 2: the red mug must be found before it can be grasped"),
        ((find("red mug"), WAIT, grasp("crate")), "", (), "step 3: the crate must be found before it can be grasped"),
        ((find("crate"), grasp("crate")), "", (), "step 2: the crate does not fit into the gripper"),
        (MUG, "apple", (), "step 2: the hand already holds the apple"),
        ((*MUG, *MUG), "", (), "step 4: the hand already holds the red mug"),
        ((find("couch"),), "", (), "step 1: I know no couch that I could pick up"),
        ((grasp("couch"),), "", (), "step 1: I know no couch that I could pick up"),
        ((find("unicorn"), go(thing="unicorn"), grasp("unicorn")), "", (), ""),
        ((find(""),), "", (), "step 1: no object is named"),
        ((grasp(""),), "", (), "step 1: no object is named"),
        ((place("desk"),), "", (), "step 1: there is nothing in the hand to place"),
        ((place("moon"),), "apple", (), "step 1: there is no moon to put things on"),
        ((place(""),), "apple", (), "step 1: there is no place to put things on"),
        ((beside("desk", "red cup"),), "apple", (), ""),
        ((beside("desk", "thimble"),), "apple", ("thimble",), ""),
        ((beside("desk", "unicorn"),), "apple", (), ""),
        ((beside("desk", "couch"),), "apple", (), "step 1: I know no couch that I could pick up"),
        ((beside("desk", "couch"),), "apple", ("couch",), ""),
        ((PlanStep(action="teach", text=" "),), "", (), "step 1: no name was said"),
        ((PlanStep(action="forget"),), "", (), "step 1: no name was said"),
        ((PlanStep(action="teach", text="vitamin box"), PlanStep(action="forget", text="it")), "", (), ""),
        ((PlanStep(action="name", text=" "),), "", (), "step 1: no name was said"),
        ((PlanStep(action="name", text="my desk"),), "", (), ""),
        ((rule("mugs", "bureau"),), "", (), ""),
        ((rule(" ", "desk"),), "", (), "step 1: no thing was said that the rule is about"),
        ((rule("mugs", "moon"),), "", (), "step 1: there is no moon to put things on"),
        ((rule("mugs", ""),), "", (), "step 1: there is no place to put things on"),
        ((place("desk"), place("desk")), "apple", (), "step 2: there is nothing in the hand to place"),
        ((place("desk"), RELEASE), "apple", (), "step 2: there is nothing in the hand to release"),
        ((RELEASE, RELEASE), "apple", (), "step 2: there is nothing in the hand to release"),
        ((RELEASE,), "", (), "step 1: there is nothing in the hand to release"),
        ((go("ballroom"),), "", (), "step 1: I know no ballroom"),
        ((go("ballroom", "red mug"),), "", (), "step 1: I know no ballroom"),
        ((go(),), "", (), "step 1: I know no "),
        ((go(AROUND),), "", (), ""),
        ((find("fridge"),), "", (), "step 1: I know no fridge that I could pick up"),
        ((find("wine fridge"),), "", (), "step 1: I know no wine fridge that I could pick up"),
        ((find("fridges"),), "", (), ""),
        ((say(" "),), "", (), "step 1: there is nothing to say"),
        ((CLOSE, OPEN, *MUG), "", (), ""),
        ((CLOSE, find("red mug"), grasp("red mug"), RELEASE, OPEN, RELEASE), "", (), NOTHING.format(6)),
        ((CLOSE, RELEASE), "", (), NOTHING.format(2)),
        ((CLOSE,), "apple", (), "step 1: the hand holds the apple, which has to be put down"),
        ((OPEN,), "apple", (), "step 1: the hand holds the apple, which has to be put down"),
    ],
)
def test_the_first_step_that_cannot_be_done_is_named_with_the_reason(
    steps: tuple[PlanStep, ...], held: str, seen: tuple[str, ...], reason: str
) -> None:
    assert str(objection(steps, known_world(SCENE, seen, held), SCENE) or "") == reason


@pytest.mark.parametrize("steps", [(), (WAIT,) * (MAX_STEPS + 1)], ids=["empty", "long"])
def test_an_objection_to_the_whole_plan_has_number_0(steps: tuple[PlanStep, ...]) -> None:
    found = objection(steps, known_world(SCENE, (), ""), SCENE)
    assert found is not None and found.step == 0


def test_the_known_world_lists_each_name_once_in_the_order_of_the_scene() -> None:
    assert known_world(SCENE, ["red mug", "crate", "red mug"], "apple") == KnownWorld(
        objects=["red mug", "crate"],
        places=["home", "sofa", "hall", "study"],
        receptacles=["desk", "bin"],
        held="apple",
    )


@pytest.mark.parametrize("name", ["home", "dock", "sofa", "couch", "hall", "study", "office", "desk", "bureau", "bin"])
def test_places_rooms_and_receptacles_are_destinations(name: str) -> None:
    assert is_destination(name, SCENE) is True
    assert is_destination(f"no {name}", SCENE) is False


def test_a_room_alone_or_its_other_name_is_a_destination() -> None:
    rooms = msgspec.structs.replace(SCENE, places=(), receptacles=())
    assert is_destination("study", rooms) and is_destination("office", rooms)
